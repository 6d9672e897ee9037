#pragma once

#include <optional>
#include <vector>

#include "tandem/coordination/island.h"

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
  Vec3 f_external_W = Vec3::Zero();
  Vec3 t_external_W = Vec3::Zero();

  [[nodiscard]] bool isDynamic() const { return settings.motion == Motion::kDynamic; }
  [[nodiscard]] bool rotates() const { return inverse_inertia_B != Vec3::Zero(); }
};

struct ModelCoupler {
  BodyIndex follower = 0;
  CouplerSettings settings;
  RigidState target;
};

struct ModelContact {
  BodyIndex sphere = 0;
  BodyIndex other = 0;
  CouplerGains gains;
};

struct IslandModel {
  IslandSettings settings;
  std::vector<ModelBody> bodies;
  std::vector<ModelCoupler> couplers;
  std::vector<ModelContact> contacts;
  const std::vector<Obstacle>* obstacles = nullptr;
  RigidContacts* rigid = nullptr;
};

/// Force and torque about the centre of mass, in W [N, N m].
struct Wrench {
  Vec3 f_W = Vec3::Zero();
  Vec3 t_W = Vec3::Zero();
};

/// Linear and angular force of a coupler on its follower.
[[nodiscard]] Wrench computeCouplerWrench(const ModelCoupler& coupler,
                                          const RigidState& follower) noexcept;

/// Where a prescribed or held body is `dt` later.
[[nodiscard]] RigidState extrapolate(const ModelBody& body, double dt) noexcept;

}  // namespace tandem
