find_package(Lcm REQUIRED)

# Generates a header for each .lcm file and an interface library with all of them.
function(tactus_lcm_types target)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME_WE)
    set(header ${out}/tactus/${name}.hpp)
    add_custom_command(OUTPUT ${header}
      COMMAND ${LCM_GEN} -x --cpp-std c++11 --cpp-hpath ${out} ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      COMMAND ${CMAKE_COMMAND} -DHEADER=${header} -P ${PROJECT_SOURCE_DIR}/cmake/GuardDecoder.cmake
      DEPENDS ${file} ${PROJECT_SOURCE_DIR}/cmake/GuardDecoder.cmake VERBATIM
      COMMENT "lcm-gen ${name}")
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(${target}_headers DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_headers)
  # SYSTEM: no compiler warnings for generated code.
  target_include_directories(${target} SYSTEM INTERFACE $<BUILD_INTERFACE:${out}>)
  target_link_libraries(${target} INTERFACE Lcm::lcm)
endfunction()
