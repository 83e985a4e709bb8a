# Uses a compiler cache and a fast linker if installed. Neither changes the result.
option(TACTUS_CACHE "Use ccache where it is installed" ON)
option(TACTUS_FAST_LINKER "Use mold where it is installed" ON)

# Paths in the source folder count as relative, so clones share cached objects.
find_program(TACTUS_CCACHE ccache)
if(TACTUS_CACHE AND TACTUS_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=true
    CCACHE_SLOPPINESS=pch_defines,time_macros ${TACTUS_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
endif()

find_program(TACTUS_MOLD mold)
if(TACTUS_FAST_LINKER AND TACTUS_MOLD AND NOT TACTUS_SANITIZE AND NOT TACTUS_FUZZ)
  add_link_options(-fuse-ld=mold)
endif()
