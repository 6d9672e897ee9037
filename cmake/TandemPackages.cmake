# Makes Debian packages from a build with shared libraries: `cpack` or scripts/deb.sh. dpkg-shlibdeps reads each
# library's dependencies from the library itself.
set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(PROJECT_VERSION_MAJOR GREATER 0)
  set(soversion ${PROJECT_VERSION_MAJOR})
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL runtime dev tools)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/drop_runpath.cmake")
set(CPACK_PACKAGE_NAME tandem)
set(CPACK_PACKAGE_CONTACT "The Tandem authors <tandem@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(same "${PROJECT_VERSION}")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libtandem${soversion})
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "networked haptic cooperation in Bullet worlds - libraries
 Distant users push the same Bullet object, and each other, with haptic
 devices. These are the shared libraries, for Bullet in single and in double
 precision.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "tandem-tools (= ${same})")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libtandem-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "libtandem${soversion} (= ${same}), libbullet-dev (>= 3.24), libeigen3-dev (>= 3.4), pkg-config")
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_DESCRIPTION "networked haptic cooperation in Bullet worlds - development files
 Headers, the CMake package tandem and the pkg-config files tandem,
 tandem-float64, tandem-coordination and tandem-devices.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME tandem-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "libtandem${soversion} (= ${same})")
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "python3-matplotlib")
set(CPACK_DEBIAN_TOOLS_DESCRIPTION "networked haptic cooperation in Bullet worlds - program
 The program tandem, which runs experiments with two users, live or in virtual
 time, plots and measures them; for Bullet in single precision it is
 tandem-float. With it a plugin for PyBullet, a library that brings Tandem
 into unmodified programs by LD_PRELOAD, and the rule that gives the user at
 the machine access to haptic devices on USB and HID.")

# dpkg-shlibdeps looks for our libraries here, as they are not installed yet.
foreach(folder coordination falcon bullet_bridge plugin)
  list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/${folder}")
endforeach()

# Debian wants the licence in each package, as the file copyright.
foreach(component RUNTIME DEV TOOLS)
  string(TOLOWER ${component} folder)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" RENAME copyright COMPONENT ${folder} EXCLUDE_FROM_ALL
    DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${component}_PACKAGE_NAME}")
endforeach()
include(CPack)
