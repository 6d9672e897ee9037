# libsodium by its pkg-config file, as the imported target Sodium::sodium.
find_package(PkgConfig REQUIRED)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET GLOBAL libsodium>=1.0.18)
add_library(Sodium::sodium ALIAS PkgConfig::SODIUM)
