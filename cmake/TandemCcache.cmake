# Compiles through ccache if it is installed, so that clones share their compiled files. Paths below the checkout count
# as relative, and precompiled headers are compared by content.
option(TANDEM_CCACHE "Compile through ccache where it is installed" ${PROJECT_IS_TOP_LEVEL})
find_program(TANDEM_CCACHE_PROGRAM ccache)
mark_as_advanced(TANDEM_CCACHE_PROGRAM)
if(NOT TANDEM_CCACHE OR NOT TANDEM_CCACHE_PROGRAM OR CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_C_COMPILER_LAUNCHER)
  return()
endif()
set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
  "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}" CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
  "${TANDEM_CCACHE_PROGRAM}")
set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
# GCC: the preprocessed text names the precompiled header instead of repeating it; ccache needs this.
add_compile_options("$<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>")
# Clang: leaves the time of day out of precompiled headers.
add_compile_options("$<$<COMPILE_LANG_AND_ID:CXX,Clang>:SHELL:-Xclang -fno-pch-timestamp>")
