# Defines the files of cmake --install: libraries and headers, the package's CMake config, pkg-config files, the
# program, documents. All paths are relative, so an installed tree may be moved as a whole. Components, like Debian's
# packages: runtime (shared libraries), dev (to compile with), tools (the program).
include(GNUInstallDirs)
set(TANDEM_CONFIG_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/tandem")

# tandem_install_library(NAME): installs the library and its headers. Its target for find_package() has its own file.
function(tandem_install_library name)
  install(TARGETS tandem_${name} EXPORT tandem_${name}
    LIBRARY COMPONENT runtime NAMELINK_COMPONENT dev
    ARCHIVE COMPONENT dev
    FILE_SET HEADERS COMPONENT dev)
  install(EXPORT tandem_${name} FILE tandem-${name}.cmake NAMESPACE tandem::
    DESTINATION "${TANDEM_CONFIG_DIR}" COMPONENT dev)
endfunction()

# tandem_install_program(NAME [OPTIONAL]): installs a program that finds our shared libraries beside it. With OPTIONAL the
# build may leave it out.
function(tandem_install_program name)
  file(RELATIVE_PATH libraries
    "/${CMAKE_INSTALL_BINDIR}" "/${CMAKE_INSTALL_LIBDIR}")
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
  install(TARGETS ${name} RUNTIME COMPONENT tools ${ARGN})
endfunction()

# tandem_install_adaptor(NAME): installs a library that is loaded by its path, where the linker does not look.
function(tandem_install_adaptor name)
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/..")
  install(TARGETS ${name} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/tandem" COMPONENT tools)
endfunction()

# tandem_install_package(): installs the files that find the libraries, once all of these are known.
function(tandem_install_package)
  include(CMakePackageConfigHelpers)
  set(tandem_links_statically ON)
  if(BUILD_SHARED_LIBS)
    set(tandem_links_statically OFF)
  endif()
  set(config "${PROJECT_BINARY_DIR}/tandemConfig.cmake")
  set(version "${PROJECT_BINARY_DIR}/tandemConfigVersion.cmake")
  configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/tandemConfig.cmake.in" "${config}"
    INSTALL_DESTINATION "${TANDEM_CONFIG_DIR}" NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file("${version}" COMPATIBILITY SameMinorVersion)
  install(FILES "${config}" "${version}" "${PROJECT_SOURCE_DIR}/cmake/TandemBullet.cmake"
    DESTINATION "${TANDEM_CONFIG_DIR}" COMPONENT dev)
  tandem_install_pkgconfig()
  foreach(file README.md CHANGELOG.md LICENSE)
    install(FILES "${PROJECT_SOURCE_DIR}/${file}" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT dev)
  endforeach()
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT dev)
endfunction()

# One file for each way to link: a width of Bullet with its dependencies, the devices, the part without Bullet.
function(tandem_install_pkgconfig)
  set(folder "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
  file(RELATIVE_PATH to_prefix "/${folder}" "/")
  string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
  set(static_libs "")
  set(static_requires_plugin "")
  set(static_requires_devices "")
  if(NOT BUILD_SHARED_LIBS)
    set(static_libs "-lstdc++ -lm -ldl -pthread")
    set(static_requires_plugin "libsodium >= 1.0.18")
    set(static_requires_devices "libftdi1 >= 1.5, hidapi-hidraw")
  endif()
  set(modules tandem-coordination tandem-float64)
  if(TANDEM_FLOAT)
    list(APPEND modules tandem)
  endif()
  if(TANDEM_WITH_DEVICES)
    list(APPEND modules tandem-devices)
  endif()
  foreach(module ${modules})
    set(file "${PROJECT_BINARY_DIR}/${module}.pc")
    configure_file("${PROJECT_SOURCE_DIR}/cmake/pkgconfig/${module}.pc.in" "${file}" @ONLY)
    install(FILES "${file}" DESTINATION "${folder}" COMPONENT dev)
  endforeach()
endfunction()
