# Precompiles the headers that nearly every file of a target includes, because parsing them takes a large part of a full build.
# Each file still includes the headers that it uses; a build without precompiled headers checks this
# (-DTACTUS_PRECOMPILE=OFF, as in the sanitizer presets). With precompiled headers GCC 12 reports false out-of-bounds string
# operations (GCC bug 105651), so these warnings are off here. The release preset precompiles nothing and has them on.
option(TACTUS_PRECOMPILE "Read common headers once for each target" ON)

#   tactus_precompile(TARGET [<HEADER>...])
function(tactus_precompile target)
  if(TACTUS_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE
      <Eigen/Geometry> <algorithm> <chrono> <functional> <map> <memory> <optional> <string> <vector> ${ARGN})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-restrict -Wno-array-bounds
        -Wno-stringop-overflow -Wno-stringop-overread -fpch-preprocess)
    endif()
  endif()
endfunction()
