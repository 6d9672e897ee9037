#pragma once

#include <cstddef>

namespace tandem::preload {

/// Functions of btDiscreteDynamicsWorld as they are behind ours, with `this` as the first argument.
using Construct = void (*)(void*, void*, void*, void*, void*);
using Destroy = void (*)(void*);
using StepFloat = int (*)(void*, float, int, float);
using StepDouble = int (*)(void*, double, int, double);
using Remove = void (*)(void*, void*);

/// One Bullet of the process: what the host would have called without us.
struct HostBullet {
  Construct construct_complete = nullptr, construct_base = nullptr;
  Destroy destroy_complete = nullptr, destroy_base = nullptr, destroy_deleting = nullptr;
  StepFloat step_float = nullptr;    ///< null in a Bullet of doubles
  StepDouble step_double = nullptr;  ///< null in one of floats
  Remove remove_body = nullptr, remove_object = nullptr;
  const void* first_virtual = nullptr;  ///< what a world's first word points at
  const char* file = "";                ///< it came from
  const char* soname = "";              ///< empty: it has none
  std::size_t scalar_bytes = 0;         ///< width of its btScalar; 0: cannot be told
};

/// The Bullet that a constructor called from `caller` belongs to, by the order in which symbols are
/// looked up: all of the process, then the caller's own dependencies, as Bullet may have come
/// with a plugin that shows nothing to others. It stays loaded from then on. Ends the process if
/// there is none, as nothing else can be done in a constructor that does not exist.
[[nodiscard]] const HostBullet& findHostBullet(const void* caller) noexcept;

/// Keeps in mind that a world is of this Bullet, until it ends. Thread safe.
void rememberWorld(const void* world, const HostBullet& bullet) noexcept;
void forgetWorld(const void* world) noexcept;

/// The Bullet of a world. Thread safe; one comparison while the process has one Bullet.
[[nodiscard]] const HostBullet& bulletOf(const void* world, const void* caller) noexcept;

}  // namespace tandem::preload
