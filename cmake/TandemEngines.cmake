# Other physics engines, for comparison in `tandem bench accuracy`. All are optional. TANDEM_ENGINES lists those found
# (MuJoCo, ODE, Simbody), TANDEM_ENGINE_LIBRARIES the libraries to link.
find_package(PkgConfig REQUIRED)
set(TANDEM_ENGINES "")
set(TANDEM_ENGINE_LIBRARIES "")
if(NOT TANDEM_COMPARE_ENGINES)
  return()
endif()

# tandem_add_engine(NAME TARGET PACKAGE): adds an engine if its target exists.
macro(tandem_add_engine name target package)
  if(TARGET ${target})
    message(STATUS "tandem bench compares with ${name}")
    list(APPEND TANDEM_ENGINES ${name})
    list(APPEND TANDEM_ENGINE_LIBRARIES ${target})
  else()
    message(STATUS "tandem bench does without ${name}: not found (Debian: ${package})")
  endif()
endmacro()

include(TandemMujoco)
tandem_add_engine(MuJoCo tandem_mujoco libmujoco-dev)

pkg_check_modules(ODE QUIET IMPORTED_TARGET GLOBAL ode)
tandem_add_engine(ODE PkgConfig::ODE libode-dev)

pkg_check_modules(SIMBODY QUIET IMPORTED_TARGET GLOBAL simbody)
if(TARGET PkgConfig::SIMBODY)
  # Simbody's pkg-config file asks for C++11.
  set_property(TARGET PkgConfig::SIMBODY PROPERTY INTERFACE_COMPILE_OPTIONS "")
endif()
tandem_add_engine(Simbody PkgConfig::SIMBODY libsimbody-dev)
