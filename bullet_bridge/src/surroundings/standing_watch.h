#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

class HapticBody;

/// Tells for a few nanoseconds whether what stands around bodies at rest is still as it was, so
/// that nothing need be searched for while nothing moves.
///
/// What counts as a change: one of the static objects near them has left the host's world, moved,
/// got another shape or lost its contact response; anything was added to the world or taken out;
/// the bodies' places in the world's list changed. A static object that comes from afar is not
/// noticed, as Bullet's own sleeping bodies do not. For the thread that steps the host's world.
class StandingWatch {
 public:
  /// `host` must outlive this object.
  explicit StandingWatch(btDiscreteDynamicsWorld& host);
  ~StandingWatch();

  /// Takes the static objects within `margin` [m] of these bodies and of the hand as they stand
  /// now. May allocate.
  void remember(const std::vector<HapticBody*>& bodies, const Vec3& hand_W, double margin);

  /// Real-time safe.
  [[nodiscard]] bool isUnchanged() const noexcept;
  /// The same of the world's gravity.
  [[nodiscard]] bool isGravityUnchanged() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
