#pragma once

#include <cstddef>
#include <string>

#include <LinearMath/btScalar.h>

#include "tandem/coordination/types.h"

// The width that the linked library was compiled for, as its CMake target and its pkg-config file
// say it.
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

/// Which Bullet a piece of code was compiled for.
struct BulletAbi {
  std::size_t scalar_bytes = 0;  ///< 4: float, 8: double (BT_USE_DOUBLE_PRECISION)
  int version = 0;               ///< BT_BULLET_VERSION, e.g. 324
};

/// The Bullet of the code that includes this header. `static`: each side compiles its own.
[[nodiscard]] static inline BulletAbi bulletAbiOfThisCode() {
  return {sizeof(btScalar), BT_BULLET_VERSION};
}

/// The host's Bullet is not the one that this library was compiled for.
class WrongBulletError final : public Error {
 public:
  using Error::Error;
};

/// Width of btScalar in the Bullet that this library is bound to [bytes], read from the size of one
/// of its symbols; 0 if that cannot be told (Bullet linked statically into a program that exports
/// nothing).
[[nodiscard]] std::size_t loadedBulletScalarBytes() noexcept;

/// A library of this process that brings a Bullet of another width than `scalar_bytes`, however it
/// came in; empty if there is none. For set-up: looks through all that is loaded, allocates.
[[nodiscard]] std::string findOtherBulletWidth(std::size_t scalar_bytes);

/// Refuses a host that was compiled for another Bullet than this library, or a process in which
/// another width of Bullet is loaded: both link and load without a word and give wrong results. Two
/// widths harm each other even where each was loaded for itself (RTLD_LOCAL): the linker makes
/// constants such as btTransform::getIdentity()'s one for the whole process.
///
/// Called with bulletAbiOfThisCode() from headers, so that `host` is what the host's compiler saw.
/// Throws WrongBulletError naming both widths (or versions) and the library to link instead.
void checkBulletAbi(const BulletAbi& host);

}  // namespace tandem
#pragma GCC visibility pop
