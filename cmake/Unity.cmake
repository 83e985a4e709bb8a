# Compiles the files of one folder in groups of at most six, as one translation unit each (presets dev, asan, tsan and clang). Headers and templates that a group
# shares are then compiled once. The preset release compiles each file by itself, which shows missing includes.
option(TACTUS_UNITY "Compile the files of a folder in groups" OFF)
set(TACTUS_UNITY_FILES 6 CACHE STRING "Files of a group")

#   tactus_unity(TARGET [FOLDER] [JOINED])
# FOLDER: the folder of the target's sources, relative to the current one. JOINED: small groups are joined to groups of at most twelve files, also of
# several folders; for tests, in which shared headers take most of the time. A file with compile options of its own stays alone, and so does
# one with the property SKIP_UNITY_BUILD_INCLUSION: it takes several seconds by itself and shares little with its neighbours.
function(tactus_unity target)
  if(NOT TACTUS_UNITY)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "JOINED" "" "")
  set(root ${CMAKE_CURRENT_SOURCE_DIR}/${arg_UNPARSED_ARGUMENTS})
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  set(lines "")
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE)
    get_filename_component(folder ${path} DIRECTORY)
    file(RELATIVE_PATH folder ${root} ${folder})
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    math(EXPR group "0${files_in_${folder}} / ${TACTUS_UNITY_FILES}")
    math(EXPR files_in_${folder} "0${files_in_${folder}} + 1")
    # Named by the folder, so that a new file changes the groups of its folder only.
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
    if(EXISTS ${path})  # not one that the build generates
      string(APPEND lines "${folder}_${group};${path}\n")
    endif()
  endforeach()
  if(arg_JOINED)
    tactus_join_groups("${lines}")
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# Joins the groups of the lines "group;file". A local name that is new in two files of a group is an error of the compiler until CMake runs again.
function(tactus_join_groups lines)
  set(script ${PROJECT_SOURCE_DIR}/tests/scripts/group_files.py)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${script})
  set(file ${CMAKE_CURRENT_BINARY_DIR}/groups.txt)
  file(WRITE ${file} "${lines}")
  execute_process(COMMAND ${Python3_EXECUTABLE} ${script} INPUT_FILE ${file} OUTPUT_VARIABLE joined
    COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE ";" "|" joined "${joined}")
  string(REGEX MATCHALL "[^\n]+" joined "${joined}")
  foreach(line IN LISTS joined)
    string(REGEX MATCH "^([^|]*)[|](.*)$" line "${line}")
    set_source_files_properties("${CMAKE_MATCH_2}" PROPERTIES UNITY_GROUP ${CMAKE_MATCH_1})
  endforeach()
endfunction()
