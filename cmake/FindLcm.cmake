# Finds LCM by its CMake configuration (1.4 and later), otherwise by its files. LCM 1.3.1 of Debian has no configuration, and
# its .pc file requires glib, which the public headers of LCM do not need.
#
#   Lcm::lcm      the library          LCM_GEN   the generator
find_package(lcm CONFIG QUIET)
if(TARGET lcm::lcm)
  if(NOT TARGET Lcm::lcm)
    add_library(Lcm::lcm INTERFACE IMPORTED)
    target_link_libraries(Lcm::lcm INTERFACE lcm::lcm)
  endif()
  get_target_property(LCM_GEN lcm::lcm-gen LOCATION)
else()
  find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp)
  find_library(LCM_LIBRARY lcm)
  find_program(LCM_GEN lcm-gen)
  if(LCM_INCLUDE_DIR AND LCM_LIBRARY AND NOT TARGET Lcm::lcm)
    add_library(Lcm::lcm UNKNOWN IMPORTED)
    set_target_properties(Lcm::lcm PROPERTIES
      IMPORTED_LOCATION ${LCM_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
  endif()
endif()
include(FindPackageHandleStandardArgs)
if(TARGET Lcm::lcm)
  set(Lcm_TARGET Lcm::lcm)
endif()
find_package_handle_standard_args(Lcm REQUIRED_VARS Lcm_TARGET LCM_GEN)
