# Debian's Bullet as two imported targets, Bullet::float and Bullet::float64. Its own CMake config
# gives variables only, and both widths share one header folder, so the width travels as a definition.
find_package(PkgConfig REQUIRED)

function(tandem_import_bullet target module)
  pkg_check_modules(${module} REQUIRED IMPORTED_TARGET ${module})
  set(libraries "")
  foreach(library BulletSoftBody BulletDynamics BulletCollision LinearMath)
    if(target STREQUAL "Bullet::float64")
      string(APPEND library "-float64")
    endif()
    find_library(TANDEM_${library} ${library} HINTS ${${module}_LIBRARY_DIRS} REQUIRED)
    mark_as_advanced(TANDEM_${library})
    list(APPEND libraries "${TANDEM_${library}}")
  endforeach()
  add_library(${target} INTERFACE IMPORTED)
  target_include_directories(${target} SYSTEM INTERFACE ${${module}_INCLUDE_DIRS})
  target_compile_options(${target} INTERFACE ${${module}_CFLAGS_OTHER})
  target_link_libraries(${target} INTERFACE ${libraries})
endfunction()

tandem_import_bullet(Bullet::float bullet)
tandem_import_bullet(Bullet::float64 bullet-float64)
