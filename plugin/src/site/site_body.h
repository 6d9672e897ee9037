#pragma once

#include <vector>

#include "bullet_bridge/src/bodies/filter_of.h"
#include "bullet_bridge/src/bodies/haptic_body.h"
#include "coordination/src/island/island.h"
#include "coordination/src/island/wrench.h"
#include "site/foresight.h"

namespace tandem {

/// Momentum that an island body received at a time that the host has not reached yet.
struct LateMomentum {
  double time = 0.0;  ///< of the island [s]
  Momentum momentum;
};

/// Forces and impulses of the host on a body of the island. Kept by HostForces.
struct HostLoad {
  Vec3 f_gravity_W = Vec3::Zero();                        ///< weight, always applied
  Vec3 f_host_W = Vec3::Zero(), t_host_W = Vec3::Zero();  ///< host force applied now
  Wrench told;                                            ///< the host's, in its latest step
  Momentum owed;                                          ///< of the host's forces, not yet given
  std::vector<LateMomentum> late;                         ///< not yet in Bullet's state; reserved
  Foresight foresight;                                    ///< of Bullet's contacts and joints
  PressForce press;                                       ///< of strangers onto supports

  /// Allocates.
  void makeRoom() {
    late.reserve(kMostLate);
    foresight.makeRoom();
  }
  /// Without room it is added to the latest entry.
  void note(const LateMomentum& momentum) noexcept;
  /// True if no force of the host acts, and none is owed or foreseen.
  [[nodiscard]] bool isSettled() const noexcept {
    return f_host_W == Vec3::Zero() && t_host_W == Vec3::Zero() && told.f_W == Vec3::Zero() &&
           told.t_W == Vec3::Zero() && owed.isZero() && foresight.isNone() && press.isNone();
  }

 private:
  static constexpr std::size_t kMostLate = 64;
};

/// A body's hand-off in the present host step. Kept by HandOffStep.
struct HandOver {
  // Read by the host's thread on the way in.
  bool is_told = false;  ///< `change` and `f_gravity_W` are new
  HostChange change;
  Vec3 f_gravity_W = Vec3::Zero();
  bool is_stopped = false;  ///< the host has put it to sleep, at `end` from now on
  // Given to the island.
  Momentum gift;      ///< momentum at once
  RigidState before;  ///< the body without it
  // Answered by the island.
  RigidState end;             ///< at the end of the step
  Foresight::Given foreseen;  ///< in the step, for Bullet's contacts and joints
  bool is_ghost = false;      ///< collides with nothing
  bool is_put = false;        ///< a peer's reset puts it to `put` at the end of the step
  RigidState put;
  bool may_park = false;    ///< the host's forces are settled
  bool moves_not = false;   ///< its motion was none beside what the host's force gave, a step ago
  bool turns_not = false;   ///< the same for its turning and torque
  double mass_share = 1.0;  ///< part of the body's mass that is ours from now on
  // Read by the host's thread on the way out.
  bool stands = false;          ///< it is where it was a step ago
  bool was_parked = false;      ///< parked when Bullet's step ended
  bool was_near_awake = false;  ///< parked, but Bullet woke it: an awake body is near
  Momentum reaction;            ///< impulse of Bullet's solver
  Momentum hit;                 ///< part of it that was not foreseen
  bool is_supported = false;    ///< part of it is from supports that the island has, too
  Momentum lasting_support;     ///< what they gave in the step before, too
  HostChange shift;             ///< pose that it led to
  int steps_stood = 0;          ///< host steps without motion or impact

  /// Nothing is taken back from a body that leaves after this step.
  void forgetReaction() noexcept {
    reaction = hit = lasting_support = {};
    is_supported = false;
    shift = {};
    was_parked = true;
  }
};

/// Reads mass, inertia, factors and state of a body that the island takes.
inline void readBody(const HapticBody& bullet, IslandBody& own) noexcept {
  own.mass = bullet.mass();
  own.inertia_B = bullet.inertia();
  own.linear_factor = bullet.linearFactor();
  own.angular_factor = bullet.angularFactor();
  own.filter = filterOf(bullet.body());
  own.start = bullet.state();
}

/// A body of the host whose motion the island decides.
struct SiteBody {
  HostBody* bullet = nullptr;  ///< null while not held, and after the host's world
  BodyIndex index = 0;
  bool is_held = false;     ///< the island moves it; may change for neighbours
  bool is_leaving = false;  ///< about to be given back; for the host's thread
  RigidState seen;          ///< Bullet's state for the haptic thread, which must not read Bullet
  HostLoad load;
  HandOver step;

  /// The host has moved all of its world by `offset_W` [m].
  void shiftOrigin(const Vec3& offset_W) noexcept {
    seen.p_W += offset_W;
    step.end.p_W += offset_W;
    step.put.p_W += offset_W;
    if (bullet) bullet->shiftOrigin(offset_W);
  }
  /// Empties it for another body. It must not be held, which a haptic thread may be reading.
  void becomeEmpty() {
    bullet = nullptr;
    is_leaving = false;
    seen = {};
    load = {};
    load.makeRoom();
    step = {};
  }
};

inline void HostLoad::note(const LateMomentum& momentum) noexcept {
  if (late.size() < late.capacity()) return late.push_back(momentum);
  if (late.empty()) return;
  late.back().time = momentum.time;
  late.back().momentum.linear_W += momentum.momentum.linear_W;
  late.back().momentum.angular_W += momentum.momentum.angular_W;
}

}  // namespace tandem
