#pragma once

#include <memory>

#include "coordination/src/island/island.h"
#include "site/site_body.h"

namespace tandem {

struct Peer;
struct SharedObject;
struct SiteParts;

/// Strategy for moving the bodies: its part of a site's tick and of a host step. There are three:
/// the island with hand-off to Bullet; Bullet with impulses; Bullet with its own contact and
/// constraints.
class HostStep {
 public:
  virtual ~HostStep() = default;

  /// @name Set-up; may throw.
  /// @{
  /// Throws std::invalid_argument if a copy of an object of this mass [kg] would be unstable.
  virtual void checkObject(double mass) const { static_cast<void>(mass); }
  /// Sets up contact of a new object, or a new proxy, with everything added before.
  virtual void addObject(SharedObject& object) = 0;
  virtual void addProxy(Peer& peer, const Vec3& start_W) = 0;
  /// Adds the counterpart of a coupler of the island.
  virtual void addCoupler(SharedObject& object, CouplerIndex index,
                          const CouplerSettings& coupler) = 0;
  /// Called after each of these, when all bodies are listed.
  virtual void finishSetUp() = 0;
  /// A haptic thread ticks from now on.
  virtual void beginLive() {}
  /// True if the site can go on with the bodies that are in the host's world; stops it if not.
  [[nodiscard]] virtual bool areBodiesPresent() noexcept = 0;
  /// @}

  /// @name In the tick; real-time safe.
  /// @{
  /// Contact force on the hand, in W [N].
  [[nodiscard]] virtual const Vec3& computeContactForce() noexcept = 0;
  /// Moves over ticks left out before `now`, for at most `most` [s].
  virtual void makeUp(double now, double most) noexcept = 0;
  /// Advances the period from `now` to `end`: motion, packets and events.
  virtual void advance(double now, double end) noexcept = 0;
  /// True if a proxy overlaps nothing. `unknown` [m] is how far it has moved since the last search
  /// around it.
  [[nodiscard]] virtual bool isPlaceFree(const Peer& peer, double unknown) const noexcept = 0;
  /// Shows in Bullet that a proxy became a ghost or stopped being one.
  virtual void showProxy(Peer& peer) noexcept = 0;
  /// @}

  /// @name In the host's step of `dt` [s], for the thread that steps the world.
  /// @{
  virtual void before(double dt) noexcept = 0;
  virtual void after(double dt) noexcept = 0;
  /// Gives all neighbours back to the host.
  virtual void leaveNeighbours() {}
  /// Removes everything else that the site put into the host's world.
  virtual void leaveWorld() {}
  /// @}
};

/// Makes the strategy for the settings. `parts` must outlive it.
[[nodiscard]] std::unique_ptr<HostStep> makeHostStep(SiteParts& parts);

}  // namespace tandem
