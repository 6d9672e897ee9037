#pragma once

#include <cstddef>

namespace tandem::preload {

/// Original functions of btDiscreteDynamicsWorld, with `this` as the first argument.
using Construct = void (*)(void*, void*, void*, void*, void*);
using Destroy = void (*)(void*);
using StepFloat = int (*)(void*, float, int, float);
using StepDouble = int (*)(void*, double, int, double);
using Remove = void (*)(void*, void*);

/// One Bullet of the process, with the functions that the host would call without us.
struct HostBullet {
  Construct construct_complete = nullptr, construct_base = nullptr;
  Destroy destroy_complete = nullptr, destroy_base = nullptr, destroy_deleting = nullptr;
  StepFloat step_float = nullptr;    ///< null in a Bullet of doubles
  StepDouble step_double = nullptr;  ///< null in a Bullet of floats
  Remove remove_body = nullptr, remove_object = nullptr;
  const void* first_virtual = nullptr;  ///< virtual table that a world's first word points at
  const char* file = "";                ///< file of the library
  const char* soname = "";              ///< empty: none
  std::size_t scalar_bytes = 0;         ///< width of its btScalar; 0: unknown
};

/// Finds the Bullet of a constructor called from `caller`. Follows the lookup order of symbols: the
/// whole process, then the caller's own dependencies. A plugin may have loaded Bullet privately.
/// The Bullet stays loaded from then on. Aborts the process if there is none, because the
/// constructor to call does not exist.
[[nodiscard]] const HostBullet& findHostBullet(const void* caller) noexcept;

/// Stores the Bullet of a world until the world ends. Thread safe.
void rememberWorld(const void* world, const HostBullet& bullet) noexcept;
void forgetWorld(const void* world) noexcept;

/// Bullet of a world. Thread safe; one comparison while the process has one Bullet.
[[nodiscard]] const HostBullet& bulletOf(const void* world, const void* caller) noexcept;

}  // namespace tandem::preload
