# Debian packages of the installation (cpack -G DEB; scripts/package builds them): tactus, tactus-studies, tactus-dev, tactus-doc.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tactus)
set(CPACK_PACKAGE_VENDOR "The Tactus developers")
# The address of the laboratory that builds the packages.
set(TACTUS_MAINTAINER "The Tactus developers <tactus@packages.invalid>" CACHE STRING "Maintainer of the Debian packages: NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT ${TACTUS_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "multimodal haptics: one scene to feel, hear, see and sense the warmth of")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})
set(CPACK_COMPONENTS_ALL runtime studies dev doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(version ${PROJECT_VERSION})
# Of the source, so that equal sources give equal packages.
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%aD OUTPUT_VARIABLE commit_date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit_date)
  set(commit_date "Thu, 1 Jan 1970 00:00:00 +0000")
endif()

# tactus_package(COMPONENT NAME SUMMARY DESCRIPTION [ARCHITECTURE a] [SECTION s] [DEPENDS packages] [RECOMMENDS packages] [SHLIBDEPS] [PYTHON])
# SHLIBDEPS: the packages of its shared libraries are added by dpkg-shlibdeps. PYTHON: compiles its modules once at installation, and removes
# the results with the package.
macro(tactus_package component name summary description)
  cmake_parse_arguments(ARG "SHLIBDEPS;PYTHON" "ARCHITECTURE;SECTION" "DEPENDS;RECOMMENDS" ${ARGN})
  string(TOUPPER ${component} upper)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${description}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  list(JOIN ARG_DEPENDS ", " depends)
  list(JOIN ARG_RECOMMENDS ", " recommends)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "${recommends}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ${ARG_SHLIBDEPS})
  if(ARG_ARCHITECTURE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE ${ARG_ARCHITECTURE})
  endif()
  if(ARG_SECTION)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${ARG_SECTION})
  endif()
  set(control ${CMAKE_BINARY_DIR}/packaging/${name})
  if(ARG_PYTHON)
    file(WRITE ${control}/postinst "#!/bin/sh\nset -e\nif [ \"$1\" = configure ] && command -v py3compile >/dev/null; then py3compile -p ${name}; fi\n")
    file(WRITE ${control}/prerm "#!/bin/sh\nset -e\nif command -v py3clean >/dev/null; then py3clean -p ${name}; fi\n")
    set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA ${control}/postinst ${control}/prerm)
  endif()
  # The files that every Debian package has. The changelog has the format of Debian (Debian policy 4.4); CHANGELOG.md is in tactus-doc.
  file(WRITE ${control}/changelog "${name} (${version}) unstable; urgency=medium\n\n  * The changes are in CHANGELOG.md of the package tactus-doc.\n\n -- ${TACTUS_MAINTAINER}  ${commit_date}\n")
  execute_process(COMMAND gzip -9nc ${control}/changelog OUTPUT_FILE ${control}/changelog.gz)
  install(FILES ${control}/changelog.gz DESTINATION share/doc/${name} COMPONENT ${component})
  install(FILES LICENSE DESTINATION share/doc/${name} RENAME copyright COMPONENT ${component})
endmacro()

file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/packaging)
tactus_package(runtime tactus "multimodal haptics: touch, sound, vision and warmth of one scene"
"Tactus renders one simulated scene for touch, sound, vision and warmth. Each
modality has its own process and its own rate. Any modality can be delayed,
thinned, frozen or stopped; the others do not change. All traffic is logged,
and every renderer can replay any log.
.
This package holds the nodes, the tools and the command tactus."
  SHLIBDEPS PYTHON
  DEPENDS python3 python3-lxml ffmpeg runit iproute2 libcap2-bin procps libegl1 libgl1 libegl-mesa0 libgl1-mesa-dri
  RECOMMENDS python3-numpy python3-scipy python3-matplotlib python3-websockets openssh-client fonts-noto-core
)
tactus_package(studies tactus-studies "multimodal haptics: studies of degraded senses"
"Studies with Tactus: how far can one modality degrade before the interaction
breaks down? This package holds the commands that check, run, sweep and
analyse a study, the trial runner, the simulated participants and the shipped
studies."
  SHLIBDEPS PYTHON DEPENDS "tactus (= ${version})" python3-numpy python3-scipy python3-matplotlib python3-lxml python3-statsmodels python3-pil)
tactus_package(dev tactus-dev "multimodal haptics: headers, libraries and CMake package"
"Headers, static libraries, message types and the CMake package Tactus, to build
a modality, a driver of a device, a collision detector or a behaviour model
outside the source tree of Tactus. The examples show one of each."
  SECTION libdevel
  DEPENDS "tactus (= ${version})" cmake pkg-config python3 liblcm-dev liblcm-bin libeigen3-dev libcli11-dev nlohmann-json3-dev libtinyxml2-dev libboost-context-dev
          libseccomp-dev libode-dev libccd-dev libassimp-dev)
tactus_package(doc tactus-doc "multimodal haptics: documentation"
"The documentation of Tactus: getting started, scene format, settings, messages,
studies, safety and security, as Markdown, and as a site where it was built."
  ARCHITECTURE all SECTION doc)
include(CPack)
