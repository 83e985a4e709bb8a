# The tests of lcmtypes once more, with the address and undefined behaviour sanitizers: messages are decoded at this border, from any
# bytes. The presets asan and tsan do the same for all folders (scripts/test --preset asan).
if(TACTUS_SANITIZE OR TACTUS_FUZZ)
  return()
endif()
get_target_property(lcmtypes_sources tactus_lcmtypes SOURCES)
get_target_property(lcmtypes_folder tactus_lcmtypes SOURCE_DIR)
set(sanitized_sources test_main.cpp run_tests.cpp)
foreach(source IN LISTS lcmtypes_sources)
  get_filename_component(source ${source} ABSOLUTE BASE_DIR ${lcmtypes_folder})
  list(APPEND sanitized_sources ${source})
endforeach()
file(GLOB tested CONFIGURE_DEPENDS lcmtypes/*_test.cpp)
add_executable(lcmtypes_sanitized_test ${sanitized_sources} ${tested})
# A generated source of another folder: its rule is not known here.
set_source_files_properties(${CMAKE_BINARY_DIR}/lcmtypes/generated/fields.gen.cpp PROPERTIES GENERATED ON)
add_dependencies(lcmtypes_sanitized_test tactus_lcmtypes)
target_compile_definitions(lcmtypes_sanitized_test PRIVATE TACTUS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_include_directories(lcmtypes_sanitized_test PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(lcmtypes_sanitized_test PRIVATE tactus_catch2 PNG::PNG tactus_sync)
set(sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all)
target_compile_options(lcmtypes_sanitized_test PRIVATE ${sanitizers} -fno-omit-frame-pointer -O0 -g1 -Wno-maybe-uninitialized -Wno-restrict)
target_link_options(lcmtypes_sanitized_test PRIVATE ${sanitizers} -fuse-ld=bfd)
tactus_unity(lcmtypes_sanitized_test JOINED)
# One test for all cases, because the start of a program with sanitizers takes long. Libraries without sanitizers fill containers of the tests.
add_test(NAME "lcmtypes: all tests pass with the address and undefined behaviour sanitizers" COMMAND lcmtypes_sanitized_test)
set_tests_properties("lcmtypes: all tests pass with the address and undefined behaviour sanitizers" PROPERTIES LABELS simulation COST 100 TIMEOUT 600
  ENVIRONMENT ASAN_OPTIONS=detect_container_overflow=0)
