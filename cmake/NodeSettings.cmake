# Every option and constant of a node is one row of its settings.csv: name, unit, default, min, max, meaning, source.
# It is the source of the Settings struct of the node, the check of scenes (sim_node) and the table in docs/settings.md.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# Generates ${node}/settings.gen.h for the calling node folder. Installed with the CMake package Tactus, for node folders of other projects.
function(tactus_node_settings target)
  get_filename_component(node ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set(out ${CMAKE_BINARY_DIR}/generated/${node})
  set(tool ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/generate_settings.py)
  add_custom_command(OUTPUT ${out}/settings.gen.h
    COMMAND ${Python3_EXECUTABLE} ${tool} header ${CMAKE_CURRENT_SOURCE_DIR}/settings.csv ${out}/settings.gen.h
    DEPENDS settings.csv ${tool} VERBATIM COMMENT "settings of ${node}")
  add_custom_target(${target}_settings DEPENDS ${out}/settings.gen.h)
  add_dependencies(${target} ${target}_settings)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/generated>)
  else()
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/generated>)
  endif()
endfunction()
