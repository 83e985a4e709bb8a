# Compiles the files of one folder in groups of at most six, as one translation unit each (presets dev and asan). Headers and templates that a group
# shares are then compiled once. The presets release and tsan compile each file by itself, which shows missing includes.
option(TACTUS_UNITY "Compile the files of a folder in groups" OFF)
set(TACTUS_UNITY_FILES 6 CACHE STRING "Files of a group")

#   tactus_unity(TARGET [FOLDER])
# FOLDER: the folder of the target's sources, relative to the current one. A file with compile options of its own stays alone, and so does
# one with the property SKIP_UNITY_BUILD_INCLUSION: it takes several seconds by itself and shares little with its neighbours.
function(tactus_unity target)
  if(NOT TACTUS_UNITY)
    return()
  endif()
  set(root ${CMAKE_CURRENT_SOURCE_DIR})
  if(ARGC GREATER 1)
    set(root ${root}/${ARGV1})
  endif()
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE)
    get_filename_component(folder ${path} DIRECTORY)
    file(RELATIVE_PATH folder ${root} ${folder})
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    math(EXPR group "0${files_in_${folder}} / ${TACTUS_UNITY_FILES}")
    math(EXPR files_in_${folder} "0${files_in_${folder}} + 1")
    # Named by the folder, so that a new file changes the groups of its folder only.
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
