# Precompiles the headers that nearly every file includes, because parsing them takes a large part of a full build: once for libraries and
# programs, and once more, with Catch2, for tests. Each file still includes the headers that it uses; the preset release,
# which compiles each file by itself without them, checks this. With precompiled headers GCC 12 reports false out-of-bounds string operations (GCC bug 105651), so
# these warnings are off here.
option(TACTUS_PRECOMPILE "Read common headers once" ON)
set(TACTUS_PRECOMPILED_HEADERS <Eigen/Geometry> <algorithm> <chrono> <functional> <map> <memory> <optional> <string> <vector>)

#   tactus_precompile(TARGET [TESTS])
# TESTS: the target is a test that includes Catch2. It is compiled with -O1, which takes 4/5 of the time of -O2.
function(tactus_precompile target)
  set(owner tactus_precompiled)
  if("TESTS" IN_LIST ARGN)
    set(owner tactus_precompiled_tests)
    target_compile_options(${target} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O1>)
  endif()
  if(TACTUS_PRECOMPILE)
    if(NOT TARGET ${owner})
      tactus_precompiled_headers(${owner} ${ARGN})
    endif()
    target_precompile_headers(${target} REUSE_FROM ${owner})
    tactus_precompile_options(${target})
  endif()
endfunction()

# GCC accepts a precompiled header only for the options that it was compiled with.
function(tactus_precompiled_headers owner)
  add_library(${owner} OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
  target_link_libraries(${owner} PRIVATE Eigen3::Eigen Threads::Threads)
  set(headers ${TACTUS_PRECOMPILED_HEADERS})
  if("TESTS" IN_LIST ARGN)
    target_link_libraries(${owner} PRIVATE tactus_catch2)
    target_compile_options(${owner} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O1>)
    list(APPEND headers <catch2/catch.hpp>)
  endif()
  target_precompile_headers(${owner} PRIVATE ${headers})
  tactus_precompile_options(${owner})
endfunction()

function(tactus_precompile_options target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-array-bounds
      -Wno-stringop-overflow -Wno-stringop-overread -fpch-preprocess)
  endif()
endfunction()
