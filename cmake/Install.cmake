# The files of `cmake --install`, in four components: runtime (nodes, tools, the command tactus), studies, dev (headers, libraries,
# the CMake package), doc. An installation holds no path of the build and can be moved as a whole: programs find each other in their
# own folder, and scripts find everything else by installed.json.
include(GNUInstallDirs)
# As for every Debian package; the umask of the user who builds has no effect.
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(TACTUS_PROGRAMS_DIR lib/tactus)     # programs that tactus starts; none is on the path
set(TACTUS_DATA_DIR share/tactus)       # scenes, rooms and tables, in the folders of their nodes
set(TACTUS_SCRIPTS_DIR ${TACTUS_DATA_DIR}/scripts)
set(TACTUS_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Tactus)
set(TACTUS_INCLUDE_DIR include/tactus)  # holds the source folders, and tactus/NAME_t.hpp of each message

set(runtime_programs sim_node haptic_node audio_node visual_node thermal_node recorder sync_node summarise watch export_csv export_events
  export_log degrade playout set simulation spy upgrade_log replay live_server message_types probe_pairs relay save_pictures
  check_sounds convert_geometry read_geometry read_pictures read_sounds draw_text thermal_device virtual_time simulated_player)
set(studies_programs trial_runner play_games experiment_trials observer_players)
foreach(component runtime studies)
  foreach(program IN LISTS ${component}_programs)
    if(TARGET ${program})
      install(TARGETS ${program} RUNTIME DESTINATION ${TACTUS_PROGRAMS_DIR} COMPONENT ${component})
    endif()
  endforeach()
endforeach()
if(TARGET asound_module_pcm_vcard)
  install(TARGETS asound_module_pcm_vcard LIBRARY DESTINATION ${TACTUS_PROGRAMS_DIR} COMPONENT runtime)
  install(DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/sounds DESTINATION ${TACTUS_PROGRAMS_DIR} COMPONENT runtime)
endif()

# tactus_install_matching(COMPONENT DESTINATION PATTERN FOLDER...): the matching files of source folders, in the same folders. Unlike
# install(DIRECTORY), it makes no empty folders.
function(tactus_install_matching component destination pattern)
  foreach(folder IN LISTS ARGN)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${folder}/${pattern})
    list(FILTER files EXCLUDE REGEX "/(node_modules|dist)/")
    foreach(file IN LISTS files)
      get_filename_component(place ${file} DIRECTORY)
      install(FILES ${file} DESTINATION ${destination}/${place} COMPONENT ${component})
    endforeach()
  endforeach()
endfunction()

# Data.
foreach(node IN LISTS TACTUS_NODES)
  install(FILES ${node}/settings.csv DESTINATION ${TACTUS_DATA_DIR}/${node} COMPONENT runtime)
endforeach()
install(DIRECTORY sim_node/scenes DESTINATION ${TACTUS_DATA_DIR}/sim_node COMPONENT runtime PATTERN "*.py" EXCLUDE PATTERN "README.md" EXCLUDE)
install(DIRECTORY visual_node/rooms DESTINATION ${TACTUS_DATA_DIR}/visual_node COMPONENT runtime PATTERN "*.md" EXCLUDE)
install(FILES sync/presentation/thresholds.csv DESTINATION ${TACTUS_DATA_DIR}/sync/presentation COMPONENT runtime)

# The command tactus, its Python package, and the packages of studies.
set(study_packages study psychophysics analysis sweep replication information)
install(PROGRAMS scripts/tactus scripts/setup DESTINATION ${TACTUS_SCRIPTS_DIR} COMPONENT runtime)
install(FILES scripts/prologue.sh scripts/removed_variables.txt scripts/packages.txt DESTINATION ${TACTUS_SCRIPTS_DIR} COMPONENT runtime)
set(left_out PATTERN "__pycache__" EXCLUDE PATTERN "README.md" EXCLUDE PATTERN "virtual_time_check" EXCLUDE)
foreach(package IN LISTS study_packages)
  list(APPEND left_out_of_runtime PATTERN "tactus/${package}" EXCLUDE)
  install(DIRECTORY scripts/python/tactus/${package} DESTINATION ${TACTUS_SCRIPTS_DIR}/python/tactus COMPONENT studies ${left_out})
endforeach()
install(DIRECTORY scripts/python/tactus DESTINATION ${TACTUS_SCRIPTS_DIR}/python COMPONENT runtime ${left_out} ${left_out_of_runtime}
  PATTERN "inside" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
install(DIRECTORY scripts/studies DESTINATION ${TACTUS_SCRIPTS_DIR} COMPONENT studies PATTERN "*.md" EXCLUDE)
# The live page, where scripts/live/bundle has made it.
install(DIRECTORY scripts/live/page/dist DESTINATION ${TACTUS_SCRIPTS_DIR}/live/page COMPONENT runtime OPTIONAL)
install(CODE "
  set(place \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
  file(MAKE_DIRECTORY \"\${place}/${CMAKE_INSTALL_BINDIR}\")
  file(RELATIVE_PATH target \"/prefix/${CMAKE_INSTALL_BINDIR}\" \"/prefix/${TACTUS_SCRIPTS_DIR}/tactus\")
  file(CREATE_LINK \"\${target}\" \"\${place}/${CMAKE_INSTALL_BINDIR}/tactus\" SYMBOLIC)" COMPONENT runtime)
file(RELATIVE_PATH to_programs /prefix/${TACTUS_SCRIPTS_DIR} /prefix/${TACTUS_PROGRAMS_DIR})
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} rev-parse HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(WRITE ${CMAKE_BINARY_DIR}/installed.json
  "{\"version\": \"${PROJECT_VERSION}\", \"commit\": \"${commit}\", \"programs\": \"${to_programs}\", \"data\": \"..\"}\n")
install(FILES ${CMAKE_BINARY_DIR}/installed.json DESTINATION ${TACTUS_SCRIPTS_DIR} COMPONENT runtime)

# Man pages and completions, made from the help of each command.
set(pages ${CMAKE_BINARY_DIR}/commands)
file(GLOB_RECURSE command_sources CONFIGURE_DEPENDS scripts/python/tactus/*.py scripts/python/tactus/*.txt)
add_custom_command(OUTPUT ${pages}/tactus.bash
  COMMAND ${Python3_EXECUTABLE} -I ${PROJECT_SOURCE_DIR}/cmake/generate_command_pages.py ${pages} --version ${PROJECT_VERSION}
  DEPENDS cmake/generate_command_pages.py scripts/setup scripts/tactus ${command_sources} VERBATIM COMMENT "man pages and completions")
add_custom_target(command_pages ALL DEPENDS ${pages}/tactus.bash)
install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT runtime)
install(FILES ${pages}/tactus.bash DESTINATION share/bash-completion/completions RENAME tactus COMPONENT runtime)
install(FILES ${pages}/_tactus DESTINATION share/zsh/vendor-completions COMPONENT runtime)
install(FILES ${pages}/tactus.fish DESTINATION share/fish/vendor_completions.d COMPONENT runtime)

# Documentation, with the READMEs of the folders that it refers to, and the site where it was built.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md DESTINATION share/doc/tactus-doc COMPONENT doc)
install(DIRECTORY docs DESTINATION share/doc/tactus-doc COMPONENT doc)
tactus_install_matching(doc share/doc/tactus-doc "*.md" lcmtypes sync ${TACTUS_NODES} scripts examples)
install(DIRECTORY ${CMAKE_BINARY_DIR}/site/ DESTINATION share/doc/tactus-doc/html COMPONENT doc OPTIONAL)

include(InstallDevelopment)
