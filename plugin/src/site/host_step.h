#pragma once

#include <memory>

#include "coordination/src/island/island.h"
#include "site/site_body.h"

namespace tandem {

struct Peer;
struct SharedObject;
struct SiteParts;

/// Who moves the bodies: what a tick of the site and a step of the host do for it. One for each
/// way: the island, with hand-off to Bullet; Bullet by impulses; Bullet by contact and constraints
/// of its own.
class HostStep {
 public:
  virtual ~HostStep() = default;

  /// @name Set-up; may throw.
  /// @{
  /// Throws std::invalid_argument for a copy of an object that would be unstable.
  virtual void checkObject(double mass) const { static_cast<void>(mass); }
  /// Contact of a new object, or of a new proxy, with what is there already.
  virtual void addObject(SharedObject& object) = 0;
  virtual void addProxy(Peer& peer, const Vec3& start_W) = 0;
  /// The counterpart of a coupler of the island.
  virtual void addCoupler(SharedObject& object, CouplerIndex index,
                          const CouplerSettings& coupler) = 0;
  /// After each of these, with all bodies listed.
  virtual void finishSetUp() = 0;
  /// From now on a thread of its own ticks.
  virtual void beginLive() {}
  /// True if all is in the host's world that should be; raises kBodyMissing if not.
  [[nodiscard]] virtual bool areBodiesPresent() noexcept = 0;
  /// @}

  /// @name In the tick; real-time safe.
  /// @{
  /// Contact force on the hand, in W [N].
  [[nodiscard]] virtual Vec3 computeContactForce() noexcept = 0;
  /// Moves over ticks that were left out before `now`, for `most` [s] at the most.
  virtual void makeUp(double now, double most) noexcept = 0;
  /// The period from `now` to `end`: motion, and what arrives and is due in it.
  virtual void advance(double now, double end) noexcept = 0;
  /// True if a proxy overlaps nothing, which is known up to `unknown` [m].
  [[nodiscard]] virtual bool isPlaceFree(const Peer& peer, double unknown) const noexcept = 0;
  /// A proxy has become a ghost, or has ended being one.
  virtual void showProxy(Peer& peer) noexcept = 0;
  /// @}

  /// @name In the host's step of `dt` [s], for the thread that steps the world.
  /// @{
  virtual void before(double dt) noexcept = 0;
  virtual void after(double dt) noexcept = 0;
  /// Neighbours go back to the host.
  virtual void leaveNeighbours() {}
  /// What stands in the host's world besides the bodies goes.
  virtual void leaveWorld() {}
  /// @}
};

/// The strategy that the settings ask for. `parts` must outlive it.
[[nodiscard]] std::unique_ptr<HostStep> makeHostStep(SiteParts& parts);

}  // namespace tandem
