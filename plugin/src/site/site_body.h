#pragma once

#include <vector>

#include "bullet_bridge/src/bodies/haptic_body.h"
#include "coordination/src/island/island.h"

namespace tandem {

/// Linear and angular momentum about a centre of mass, in W [N s, N m s].
struct Momentum {
  Vec3 linear_W = Vec3::Zero(), angular_W = Vec3::Zero();

  [[nodiscard]] bool isZero() const noexcept {
    return linear_W == Vec3::Zero() && angular_W == Vec3::Zero();
  }
};

/// Momentum that an island body got at a time that the host has not come to yet.
struct LateMomentum {
  double time = 0.0;  ///< of the island [s]
  Momentum momentum;
};

/// What the host does to a body of the island by forces and impulses. Kept by HostForces.
struct HostLoad {
  Vec3 f_gravity_W = Vec3::Zero();                        ///< weight, always on the island body
  Vec3 f_host_W = Vec3::Zero(), t_host_W = Vec3::Zero();  ///< the host's own, on it now
  Momentum owed;                   ///< of the host's forces, still to be given
  std::vector<LateMomentum> late;  ///< what Bullet's state does not have yet; room is reserved

  /// Allocates.
  void makeRoom() { late.reserve(kMostLate); }
  /// Without room the latest two count as one.
  void note(const LateMomentum& momentum) noexcept;
  /// True if no force of the host acts and none is owed.
  [[nodiscard]] bool isSettled() const noexcept {
    return f_host_W == Vec3::Zero() && t_host_W == Vec3::Zero() && owed.isZero();
  }

 private:
  static constexpr std::size_t kMostLate = 64;
};

/// A body in the present step of the host, where the island hands it off. Kept by HandOffStep.
struct HandOver {
  // Seen by the host's thread on the way in.
  bool is_told = false;  ///< `change` and `f_gravity_W` are news
  HostChange change;
  Vec3 f_gravity_W = Vec3::Zero();
  // Answered by the island.
  RigidState end;         ///< at the end of the step
  bool is_ghost = false;  ///< meets nothing then
  bool may_park = false;  ///< the host's forces are settled
  // Seen by the host's thread on the way out.
  bool stands = false;          ///< where it was a step ago
  bool was_parked = false;      ///< when Bullet's step ended
  bool was_near_awake = false;  ///< parked, but Bullet woke it: something awake is near
  Momentum hit;                 ///< by Bullet's solver
  int steps_stood = 0;          ///< in which nothing moved or hit it
};

/// A btRigidBody whose motion the island decides.
struct SiteBody {
  HapticBody* bullet = nullptr;  ///< null before it is held and after the end of the host's world
  BodyIndex index = 0;
  bool is_held = false;     ///< the island moves it; neighbours come and go
  bool is_leaving = false;  ///< for the host's thread: about to be given back
  RigidState seen;          ///< Bullet's state for the haptic thread, which must not read Bullet
  HostLoad load;
  HandOver step;
};

inline void HostLoad::note(const LateMomentum& momentum) noexcept {
  if (late.size() < late.capacity()) return late.push_back(momentum);
  if (late.empty()) return;
  late.back().time = momentum.time;
  late.back().momentum.linear_W += momentum.momentum.linear_W;
  late.back().momentum.angular_W += momentum.momentum.angular_W;
}

}  // namespace tandem
