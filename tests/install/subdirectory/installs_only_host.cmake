# Installs the current build folder, and fails if it installs more than the host.
execute_process(COMMAND "${CMAKE_COMMAND}" --install . --prefix prefix OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE installed RELATIVE "${CMAKE_CURRENT_BINARY_DIR}/prefix" prefix/*)
if(NOT installed STREQUAL "bin/host")
  message(FATAL_ERROR "installed: ${installed}")
endif()
