#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tandem/coordination/link.h"

#include "bullet_bridge/src/bodies/driven_body.h"
#include "coordination/src/same_state.h"
#include "site/site_body.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

namespace tandem {

/// A body of the host of which every peer has a copy. The copies of an object are tied together,
/// each with its part of the mass. Those of a tool are not: the user's hand holds each of them.
struct SharedObject {
  btRigidBody* rigid = nullptr;        ///< the host's body; null after unshare()
  std::unique_ptr<HapticBody> bullet;  ///< `body` points to it
  IslandBody settings;                 ///< island body, as it was held last
  SiteBody body;
  ObjectId id = 0;
  std::optional<PeerId> tool_of;  ///< the user of a tool; empty: an object of all
  double mass_share = 1.0;        ///< part of the body's mass that this copy has
  double damping = 0.0;           ///< of this copy [N s/m]
  double bounding_radius = 0.0;
  ObjectEpoch epoch;        ///< of our copy; for the thread that ticks
  ObjectEpoch said;         ///< what peers are told: `epoch`, once our copy has followed
  bool awaits_put = false;  ///< the next host step puts it where peer `leader` has it
  bool joins = false;       ///< it goes there with the leader's next state
  int leader = 0;           ///< peer that began `epoch`, or told us

  // While the island does not hold it: ObjectWatch.
  bool is_there = true;  ///< it is in the host's world; for the host's thread
  bool is_sent = true;   ///< peers get its state; for the thread that ticks
  bool is_new = false;   ///< held again, but not in the island yet
  Momentum owed;         ///< momentum it still gets when it goes back
  RigidState seen;       ///< Bullet's state; at rest if its velocity does not move it
  RigidState led;        ///< the same with the velocity that Bullet says
  bool was_put = false;  ///< the last way of a kinematic body was a jump

  /// The host has moved all of its world by `offset_W` [m].
  void shiftOrigin(const Vec3& offset_W) noexcept {
    body.shiftOrigin(offset_W);
    settings.start.p_W += offset_W;
    seen.p_W += offset_W;
    led.p_W += offset_W;
  }
  /// Takes Bullet's state, once or more in a step. A jump of a kinematic body has a velocity in
  /// Bullet, and is no motion. Nor is that of a body that `stands`: Bullet does not move it.
  void lookAtLed(const RigidState& now, bool is_kinematic, bool stands) noexcept {
    if (!isSame(led, now)) was_put = is_kinematic && isPut(led, now, was_put);
    seen = led = now;
    if (was_put || stands) seen.v_W = seen.w_W = Vec3::Zero();
  }

  /// Takes the host's body as it is now. It must be dynamic and in the world.
  void hold(btDiscreteDynamicsWorld& world, const Shape& shape) {
    bullet = std::make_unique<HapticBody>(world, *rigid, mass_share);
    body.bullet = bullet.get();
    body.step.mass_share = mass_share;
    bounding_radius = computeBoundingRadius(shape);
    settings.shape = shape;
    settings.damping = damping;
    settings.is_rigid = true;
    readBody(*bullet, settings);
  }
};

}  // namespace tandem
