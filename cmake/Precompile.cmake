# Reads the headers that nearly every file of a target includes once for the target: parsing them takes a large part of the time
# of a build from nothing. Every file still includes what it uses; a build without precompiled headers checks that
# (-DTACTUS_PRECOMPILE=OFF, as in the presets with sanitizers). With precompiled headers GCC 12 warns of string operations
# that leave their bounds where there are none (its bug 105651), so those warnings are off here. The release preset
# precompiles nothing and has them on.
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
