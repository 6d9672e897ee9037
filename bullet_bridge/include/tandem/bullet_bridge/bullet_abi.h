#pragma once

#include <cstddef>

#include <LinearMath/btScalar.h>

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

/// Width of btScalar in the Bullet that this process has loaded [bytes], read from the size of one
/// of its symbols; 0 if that cannot be told (Bullet linked statically into a program that exports
/// nothing).
[[nodiscard]] std::size_t loadedBulletScalarBytes() noexcept;

/// Refuses a host that was compiled for another Bullet than this library, or a process in which
/// another width of Bullet is loaded: both link and load without a word and give wrong results.
///
/// Called with bulletAbiOfThisCode() from headers, so that `host` is what the host's compiler saw.
/// Throws tandem::Error naming both widths (or versions) and the library to link instead.
void checkBulletAbi(const BulletAbi& host);

}  // namespace tandem
#pragma GCC visibility pop
