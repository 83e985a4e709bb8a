# A node folder: every .cpp but main.cpp is its library, main.cpp its thin executable.
#
#   tactus_node(LIBRARIES external libraries of the library)
function(tactus_node)
  cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
  get_filename_component(node ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  list(FILTER sources EXCLUDE REGEX "main\\.cpp$")
  add_library(tactus_${node} STATIC ${sources})
  target_link_libraries(tactus_${node} PUBLIC tactus_sync ${ARG_LIBRARIES} PRIVATE CLI11::CLI11)
  tactus_node_settings(tactus_${node})
  add_executable(${node} main.cpp)
  target_link_libraries(${node} PRIVATE tactus_${node})
endfunction()
