# Compile options of every target: warnings are errors in our own code only. Floating point is strict, so that equal
# inputs give equal bits in Debug and Release. Symbols are hidden.

include(TandemUnity)

add_library(tandem_compile_options INTERFACE)
target_compile_features(tandem_compile_options INTERFACE cxx_std_20)
# Private headers of another folder are included by their path from the checkout. They name their neighbours relative to
# their own src/. tests/house/include_rule.py defines who may include what.
target_include_directories(tandem_compile_options INTERFACE "${PROJECT_SOURCE_DIR}")
foreach(folder coordination bullet_bridge falcon plugin)
  target_include_directories(tandem_compile_options INTERFACE "${PROJECT_SOURCE_DIR}/${folder}/src")
endforeach()
target_compile_options(tandem_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Werror -ffp-contract=off -fno-math-errno)
# GCC 12's optimiser gives false warnings for std::string and std::vector (GCC bugs 105651, 105329, 105562). Clang,
# which CI also builds with, does not. They stay visible but do not stop a build.
target_compile_options(tandem_compile_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:
  -Wno-restrict -Wno-error=array-bounds -Wno-error=maybe-uninitialized -Wno-error=stringop-overflow>)
# In a batch of sources, a name of one source may shadow a name of another without harm. GCC also takes each source for
# a header when it warns of types of one source. Targets without batches have all warnings.
target_compile_options(tandem_compile_options INTERFACE $<$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>:
  -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>>)
# Clang's -Wconversion includes the sign of indices, GCC's does not.
target_compile_options(tandem_compile_options INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>)
# Links what sanitizers make of a program in a fifth of the time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  find_program(TANDEM_LLD ld.lld)
  mark_as_advanced(TANDEM_LLD)
  if(TANDEM_LLD)
    target_link_options(tandem_compile_options INTERFACE -fuse-ld=lld)
  endif()
endif()
if(TANDEM_SANITIZE)
  target_compile_options(tandem_compile_options INTERFACE
    -fsanitize=${TANDEM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(tandem_compile_options INTERFACE -fsanitize=${TANDEM_SANITIZE})
endif()

# For libraries. The island's inner loops gain a tenth by -O3; demos and tests would only compile longer.
set(TANDEM_LIBRARY_OPTIONS "" CACHE STRING "More compile options of the libraries, such as -O3")
add_library(tandem_library_options INTERFACE)
target_link_libraries(tandem_library_options INTERFACE tandem_compile_options)
target_compile_options(tandem_library_options INTERFACE ${TANDEM_LIBRARY_OPTIONS})

# For solvers that tests compare with: link it after tandem_compile_options. They use none of the library's code, and
# take minutes under a sanitizer.
add_library(tandem_reference_options INTERFACE)
if(TANDEM_SANITIZE)
  target_compile_options(tandem_reference_options INTERFACE -fno-sanitize=all -O2)
endif()

# For tests: link it after tandem_compile_options. UBSan watches the libraries and programs, not the tests' own code:
# with its checks a batch of tests compiles twice as long.
add_library(tandem_test_options INTERFACE)
if(TANDEM_SANITIZE)
  target_compile_options(tandem_test_options INTERFACE $<$<CONFIG:Debug>:-fno-sanitize=undefined>)
endif()
# Expectations name their file. Without the checkout's folder in it, clones share compiled tests by ccache.
target_compile_options(tandem_test_options INTERFACE "-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=")

# tandem_precompile(TARGET headers...): compiles headers once that nearly every source of a target reads. Our headers
# must still include all they need: tests/house compiles each alone. tandem_precompile(TARGET LIKE other): uses those of
# another target with the same options. Both compile the target's sources in batches.
option(TANDEM_PRECOMPILE "Precompile common headers, for faster full builds" ON)
function(tandem_precompile target)
  tandem_unity(${target})
  if(NOT TANDEM_PRECOMPILE)
    return()
  endif()
  if(ARGV1 STREQUAL "LIKE")
    get_target_property(headers ${ARGV2} PRECOMPILE_HEADERS)
    if(NOT headers)  # the other's sources are compiled alone
      return()
    endif()
    target_precompile_headers(${target} REUSE_FROM ${ARGV2})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# tandem_add_library(NAME FOLDER folder [WIDTH float|float64] SOURCES ... PUBLIC libs... PRIVATE libs...)
# Adds a library with public headers in <folder>/include and private sources in <folder>/src. It is static or, with
# BUILD_SHARED_LIBS, shared. WIDTH is the scalar width of its Bullet.
function(tandem_add_library name)
  cmake_parse_arguments(arg "" "FOLDER;WIDTH" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(folder "${PROJECT_SOURCE_DIR}/${arg_FOLDER}")
  file(GLOB headers CONFIGURE_DEPENDS
    "${folder}/include/tandem/*.h" "${folder}/include/tandem/${arg_FOLDER}/*.h")
  add_library(tandem_${name} ${arg_SOURCES})
  add_library(tandem::${name} ALIAS tandem_${name})
  target_sources(tandem_${name} PUBLIC FILE_SET HEADERS BASE_DIRS "${folder}/include" FILES ${headers})
  target_include_directories(tandem_${name} PRIVATE "${folder}/src")
  target_compile_features(tandem_${name} PUBLIC cxx_std_17)
  target_link_libraries(tandem_${name} PUBLIC ${arg_PUBLIC}
    PRIVATE $<BUILD_INTERFACE:tandem_library_options> ${arg_PRIVATE})
  set_target_properties(tandem_${name} PROPERTIES
    CXX_STANDARD 20 CXX_EXTENSIONS OFF CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON EXPORT_NAME ${name} DEFINE_SYMBOL "")
  if(arg_WIDTH)
    tandem_mark_width(tandem_${name} ${arg_WIDTH})
  endif()
  if(BUILD_SHARED_LIBS)
    tandem_set_abi(tandem_${name} "${arg_WIDTH}")
  endif()
  if(NOT TANDEM_LIBRARIES_ALONE)
    set(headers LIKE tandem_coordination)
    if(name STREQUAL "coordination")
      set(headers <Eigen/Core> <Eigen/Geometry>)
    endif()
    tandem_precompile(tandem_${name} ${headers})
  endif()
  # The linker takes the first copy of an inline function for the whole program. Only that of a library is optimised.
  if(TANDEM_SANITIZE AND CMAKE_BUILD_TYPE STREQUAL "Debug")
    target_link_options(tandem_${name} INTERFACE
      "LINKER:--whole-archive,$<TARGET_FILE:tandem_${name}>,--no-whole-archive")
  endif()
  if(TANDEM_INSTALL)
    tandem_install_library(${name})
  endif()
endfunction()

# A target that links a library for one width of Bullet gets that width. CMake refuses to link both; its message
# contains the property's name.
function(tandem_mark_width target width)
  set(scalar_bytes_float 4)
  set(scalar_bytes_float64 8)
  target_compile_definitions(${target} PUBLIC TANDEM_BULLET_SCALAR_BYTES=${scalar_bytes_${width}})
  set_target_properties(${target} PROPERTIES
    INTERFACE_TANDEM_EITHER_FLOAT_OR_FLOAT64 ${width}
    COMPATIBLE_INTERFACE_STRING TANDEM_EITHER_FLOAT_OR_FLOAT64)
endfunction()

# Sets the name and the exported symbols of a shared library. Before 1.0 each minor version may break binaries compiled
# for the one before, so it is part of the name that programs look for at run time.
function(tandem_set_abi target width)
  set(soversion ${PROJECT_VERSION_MAJOR})
  if(PROJECT_VERSION_MAJOR EQUAL 0)
    set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  endif()
  string(TOUPPER "${width}" width)
  string(JOIN "_" version_node TANDEM ${width} ${soversion})
  set(map "${PROJECT_BINARY_DIR}/${target}.map")
  configure_file("${PROJECT_SOURCE_DIR}/cmake/tandem.map.in" "${map}" @ONLY)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${soversion} LINK_DEPENDS "${map}" INSTALL_RPATH "$ORIGIN")
  target_link_options(${target} PRIVATE "LINKER:--version-script=${map}")
  if(NOT TANDEM_SANITIZE)  # the sanitizers' own functions come with the program
    target_link_options(${target} PRIVATE LINKER:--no-undefined)
  endif()
endfunction()

# tandem_add_program(NAME SOURCES ... LIBRARIES ...): adds an executable.
function(tandem_add_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} tandem_compile_options)
  set_target_properties(${name} PROPERTIES CXX_STANDARD 20 CXX_EXTENSIONS OFF)
endfunction()
