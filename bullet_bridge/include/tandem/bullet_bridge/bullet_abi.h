#pragma once

#include <cstddef>
#include <string>

#include <LinearMath/btScalar.h>

#include "tandem/coordination/types.h"

// Scalar width of the linked library, set by its CMake target and its pkg-config file.
#ifdef TANDEM_BULLET_SCALAR_BYTES
#if TANDEM_BULLET_SCALAR_BYTES == 4
static_assert(
    sizeof(btScalar) == 4,
    "This code is compiled for 8-byte (double) btScalar, but tandem::plugin, which it links, is "
    "for "
    "4-byte (float): link tandem::plugin_float64 instead, or leave BT_USE_DOUBLE_PRECISION out");
#elif TANDEM_BULLET_SCALAR_BYTES == 8
static_assert(
    sizeof(btScalar) == 8,
    "This code is compiled for 4-byte (float) btScalar, but tandem::plugin_float64, which it "
    "links, "
    "is for 8-byte (double): link tandem::plugin instead, or define BT_USE_DOUBLE_PRECISION");
#else
#error "TANDEM_BULLET_SCALAR_BYTES is 4 (tandem::plugin) or 8 (tandem::plugin_float64)"
#endif
#endif

#pragma GCC visibility push(default)
namespace tandem {

/// The Bullet build that a piece of code was compiled for.
struct BulletAbi {
  std::size_t scalar_bytes = 0;  ///< 4: float, 8: double (BT_USE_DOUBLE_PRECISION)
  int version = 0;               ///< BT_BULLET_VERSION, e.g. 324
};

/// The Bullet build of the code that includes this header. `static`: each side compiles its own.
[[nodiscard]] static inline BulletAbi bulletAbiOfThisCode() {
  return {sizeof(btScalar), BT_BULLET_VERSION};
}

/// The host's Bullet differs from the one that this library was compiled for.
class WrongBulletError final : public Error {
 public:
  using Error::Error;
};

/// Width of btScalar in the Bullet that this library is bound to [bytes], from the size of one of
/// its symbols. 0 if unknown (Bullet linked statically into a program that exports nothing).
[[nodiscard]] std::size_t loadedBulletScalarBytes() noexcept;

/// File of a loaded library that brings a Bullet of another width than `scalar_bytes`; empty if
/// there is none. For set-up: searches all loaded libraries and allocates.
[[nodiscard]] std::string findOtherBulletWidth(std::size_t scalar_bytes);

/// Refuses a host compiled for another Bullet than this library, or a process with another width of
/// Bullet. Both would link and load silently and give wrong results. Two widths harm each other
/// even if each is loaded with RTLD_LOCAL. The linker merges constants such as that of
/// btTransform::getIdentity() for the whole process.
///
/// Headers call this with bulletAbiOfThisCode(), so that `host` is the host compiler's view. Throws
/// WrongBulletError with both widths (or versions) and the library to link instead.
void checkBulletAbi(const BulletAbi& host);

}  // namespace tandem
#pragma GCC visibility pop
