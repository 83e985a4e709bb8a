# The component dev: headers, static libraries, message types, and the CMake package Tactus with the targets
#
#   Tactus::lcmtypes   messages, their checks and channels     a driver of a device
#   Tactus::sync       nodes, clocks, degradation, playout     a modality
#   Tactus::sim_node   the simulation                          a collision detector, a behaviour model
set_target_properties(tactus_messages PROPERTIES EXPORT_NAME messages)
set_target_properties(tactus_lcmtypes PROPERTIES EXPORT_NAME lcmtypes)
set_target_properties(tactus_sync PROPERTIES EXPORT_NAME sync)
target_compile_features(tactus_messages INTERFACE cxx_std_20)
install(TARGETS tactus_messages tactus_lcmtypes tactus_sync EXPORT Tactus ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
  INCLUDES DESTINATION ${TACTUS_INCLUDE_DIR})
install(EXPORT Tactus NAMESPACE Tactus:: DESTINATION ${TACTUS_CMAKE_DIR} FILE TactusTargets.cmake COMPONENT dev)
set(header_folders lcmtypes sync)
if(TARGET tactus_sim_node)
  set_target_properties(tactus_sim_node PROPERTIES EXPORT_NAME sim_node)
  install(TARGETS tactus_sim_node EXPORT TactusSimNode ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev INCLUDES DESTINATION ${TACTUS_INCLUDE_DIR})
  install(EXPORT TactusSimNode NAMESPACE Tactus:: DESTINATION ${TACTUS_CMAKE_DIR} FILE TactusSimNodeTargets.cmake COMPONENT dev)
  list(APPEND header_folders sim_node)
  install(FILES ${CMAKE_BINARY_DIR}/generated/sim_node/settings.gen.h DESTINATION ${TACTUS_INCLUDE_DIR}/sim_node COMPONENT dev)
endif()
tactus_install_matching(dev ${TACTUS_INCLUDE_DIR} "*.h" ${header_folders})
install(DIRECTORY ${CMAKE_BINARY_DIR}/lcmtypes/generated/tactus DESTINATION ${TACTUS_INCLUDE_DIR} COMPONENT dev FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY lcmtypes/types DESTINATION ${TACTUS_DATA_DIR}/lcmtypes COMPONENT dev)
install(DIRECTORY examples DESTINATION share/doc/tactus-dev COMPONENT dev PATTERN "__pycache__" EXCLUDE)

# The debug information of libraries names folders of the build. The strip of `cmake --install --strip` leaves libraries for linking as they are.
if(CMAKE_STRIP)
  install(CODE "
    file(GLOB libraries \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libtactus_*.a\")
    execute_process(COMMAND ${CMAKE_STRIP} --strip-debug --enable-deterministic-archives \${libraries} COMMAND_ERROR_IS_FATAL ANY)" COMPONENT dev)
endif()

include(CMakePackageConfigHelpers)
configure_package_config_file(cmake/TactusConfig.cmake.in ${CMAKE_BINARY_DIR}/TactusConfig.cmake INSTALL_DESTINATION ${TACTUS_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/TactusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/TactusConfig.cmake ${CMAKE_BINARY_DIR}/TactusConfigVersion.cmake cmake/FindLcm.cmake cmake/NodeSettings.cmake
  cmake/generate_settings.py DESTINATION ${TACTUS_CMAKE_DIR} COMPONENT dev)
