#pragma once

#include <optional>
#include <vector>

#include "island/island.h"

/// \file
/// What the island's laws of motion work on. Private to coordination.
namespace tandem {

/// A body with what is derived from its settings, its state now, and the outside forces on it.
struct ModelBody {
  IslandBody settings;
  RigidState state;
  double inverse_mass = 0.0;              ///< 0: not moved by forces
  Vec3 inverse_inertia_B = Vec3::Zero();  ///< 0: does not rotate
  double bounding_radius = 0.0;
  double mobility = 0.0;  ///< how easily a push on the surface moves it there, at the most [1/kg]
  Vec3 f_external_W = Vec3::Zero();
  Vec3 t_external_W = Vec3::Zero();
  bool is_slot = false;
  bool is_active = true;       ///< false: a slot that is not filled
  bool is_asleep = false;      ///< at rest, and left out: see Sleepers
  bool disturbed = true;       ///< something from outside has changed since the last advance
  bool is_ghost = false;       ///< stands where it is set, and meets nothing
  double contact_share = 1.0;  ///< of the gains of its contacts
  double extra_damping = 0.0;  ///< besides its own [N s/m]

  /// From checked settings: the body at its start, nothing from outside on it. A guided body does
  /// not turn.
  [[nodiscard]] static ModelBody make(const IslandBody& settings, bool is_guided) noexcept;

  [[nodiscard]] bool isDynamic() const {
    return is_active && !is_ghost && settings.motion == Motion::kDynamic;
  }
  [[nodiscard]] bool isPresent() const { return is_active && !is_asleep; }
  [[nodiscard]] double damping() const { return settings.damping + extra_damping; }
  [[nodiscard]] bool rotates() const { return inverse_inertia_B != Vec3::Zero(); }
  /// Equal moments about all axes: no gyroscopic torque.
  [[nodiscard]] bool isRound() const {
    const Vec3& i = settings.inertia_B;
    return i.x() == i.y() && i.y() == i.z();
  }
};

struct ModelCoupler {
  BodyIndex follower = 0;
  CouplerSettings settings;  ///< as it was added
  RigidState target;
  double share = 1.0;
  CouplerSettings now = settings;  ///< the gains times the share
};

[[nodiscard]] inline CouplerGains computeShare(const CouplerGains& gains, double share) noexcept {
  return {share * gains.stiffness, share * gains.damping};
}

/// The island as it was built, and who of it takes part now. What is done at each tick goes over
/// those who are present, and over nobody else.
struct IslandModel {
  IslandSettings settings;
  std::vector<ModelBody> bodies;
  std::vector<ModelCoupler> couplers;
  std::vector<IslandContact> contacts;
  std::vector<BodyIndex> slots;
  const std::vector<Obstacle>* obstacles = nullptr;
  ContactFinder* finder = nullptr;

  std::vector<BodyIndex> present;               ///< active and awake, in order
  std::vector<IslandContact> present_contacts;  ///< between two of them
  std::vector<int> present_couplers;            ///< on one of them
  int asleep_count = 0;
  bool is_listed = false;  ///< these lists are right

  /// Of the gains of a contact between two bodies, and of one's with what stands.
  [[nodiscard]] double contactShare(BodyIndex a, BodyIndex b) const noexcept {
    return bodies[a].contact_share * bodies[b].contact_share;
  }

  /// Room for all, so that listPresent() never allocates.
  void reserveLists();
  void listPresent() noexcept;
  void wake(BodyIndex body) noexcept {
    is_listed = is_listed && !bodies[body].is_asleep;
    bodies[body].is_asleep = false;
  }
};

/// Force and torque about the centre of mass, in W [N, N m].
struct Wrench {
  Vec3 f_W = Vec3::Zero();
  Vec3 t_W = Vec3::Zero();
};

/// Linear and angular force of a coupler on its follower.
[[nodiscard]] Wrench computeCouplerWrench(const ModelCoupler& coupler,
                                          const RigidState& follower) noexcept;

/// Torque of a body's angular damping, in W [N m].
[[nodiscard]] Vec3 computeAngularDamping(const IslandBody& body, const RigidState& state) noexcept;

/// Moves a pose on by its own velocities.
void goOn(RigidState& state, double dt) noexcept;

/// Where a prescribed or held body is `dt` later.
[[nodiscard]] RigidState extrapolate(const ModelBody& body, double dt) noexcept;

}  // namespace tandem
