# Writes a C++ file that holds the text of every shader by file name.
set(text "#include \"visual_node/gl/shader_text.h\"\nnamespace tactus::visual {\nstd::string_view shader_text(std::string_view file) {\n")
foreach(shader IN LISTS SHADERS)
  get_filename_component(name ${shader} NAME)
  file(READ ${shader} source)
  string(APPEND text "  if (file == \"${name}\") return R\"GLSL(${source})GLSL\";\n")
endforeach()
string(APPEND text "  return {};\n}\n}  // namespace tactus::visual\n")
file(WRITE ${OUT} "${text}")
