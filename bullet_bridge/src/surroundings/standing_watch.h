#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

class HapticBody;

/// Checks within a few nanoseconds whether the surroundings of bodies at rest are unchanged. While
/// they are and nothing moves, no search is needed.
///
/// A change is: a static object nearby left the host's world, moved, got another shape, scaling,
/// surface or filter, or lost its contact response. Objects added to or removed from the world
/// count too, as do bodies at other indices in its list. A static object that arrives from afar is
/// not noticed; Bullet's sleeping bodies do not notice it either. For the thread that steps the
/// host's world.
class StandingWatch {
 public:
  /// `host` must outlive this object.
  explicit StandingWatch(btDiscreteDynamicsWorld& host);
  ~StandingWatch();

  /// Stores the static objects within `margin` [m] of these bodies and of the hand. May allocate.
  void remember(const std::vector<HapticBody*>& bodies, const Vec3& hand_W, double margin);

  /// True if the surroundings are unchanged since remember(). Real-time safe.
  [[nodiscard]] bool isUnchanged() const noexcept;
  /// True if the world's gravity is unchanged since remember().
  [[nodiscard]] bool isGravityUnchanged() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
