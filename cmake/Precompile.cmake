# Reads the headers that nearly every test includes once for a target: parsing them takes most of the time of a build from
# nothing. Every file still includes what it uses, which a build without it checks: -DTACTUS_PRECOMPILE=OFF, as the presets with
# sanitizers have it. Of headers that were read so GCC 12 says now and then that a string to which letters are added leaves its
# bounds (its bug 105651): such a file does without (SKIP_PRECOMPILE_HEADERS), and so do the libraries.
option(TACTUS_PRECOMPILE "Read common headers once for each test program" ON)

#   tactus_precompile(TARGET [<HEADER>...])
function(tactus_precompile target)
  if(TACTUS_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <Eigen/Geometry> <algorithm> <chrono> <functional> <map> <memory> <optional> <string> <vector> ${ARGN})
  endif()
endfunction()
