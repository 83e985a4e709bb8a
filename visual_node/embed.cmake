# Writes a C++ file with a function that returns the text of an embedded file by its name.
set(text "#include \"${HEADER}\"\nnamespace tactus::visual {\nstd::string_view ${FUNCTION}(std::string_view file) {\n")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} source)
  string(APPEND text "  if (file == \"${name}\") return R\"TEXT(${source})TEXT\";\n")
endforeach()
string(APPEND text "  return {};\n}\n}  // namespace tactus::visual\n")
file(WRITE ${OUT} "${text}")
