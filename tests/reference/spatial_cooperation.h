#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "bench/reference/sampling.h"
#include "reference/rigid_scene.h"

namespace tandem::reference {

/// Experiment I in space: two users hold a free cube between two spheres, by remote dynamic
/// proxies.
///
/// The cube starts centred at the origin with its edges along the axes. User 1's sphere just
/// touches its face at -x and user 2's the face at +x. Index 0 is site 1 (user 1), index 1 is site
/// 2.
struct SpatialParameters {
  HipMotion hip_motion = HipMotion::kExtrapolated;
  std::array<Vec3, 2> hand_force{Vec3(5.0, 0.0, 0.0), Vec3::Zero()};  ///< constant, in W [N]
  std::array<Vec3, 2> start_offset{Vec3::Zero(), Vec3::Zero()};  ///< added to the start, x = 0 [m]

  SpringDamper contact{4000.0, 1.0};       ///< gains of every contact
  SpringDamper coordination{200.0, 30.0};  ///< RDP to its user, cube copy to the other copy
  /// Turns the copies towards each other [N m/rad, N m s/rad]. If empty: `coordination` times J / m
  /// of a copy, which makes both motions equally stiff.
  std::optional<SpringDamper> angular_coordination{};

  double object_size = 0.04;    ///< edge of the cube [m]
  double object_mass = 0.2;     ///< the whole cube: each copy carries half [kg]
  double object_damping = 0.0;  ///< damping of a copy's translation [N s/m]
  double proxy_radius = 0.01;   ///< radius of HIPs and proxies [m]
  double proxy_mass = 0.1;      ///< mass of an RDP and of the device it stands for [kg]
  double proxy_damping = 0.0;   ///< [N s/m]
  double device_damping = 0.5;  ///< [N s/m]
  Sampling sampling{};          ///< rates, delay and duration
  double step = 5e-6;           ///< longest step of the integrator [s]
};

/// One site's part of a row, in W.
struct SpatialSite {
  Vec3 device_p = Vec3::Zero();   ///< [m]
  Vec3 device_v = Vec3::Zero();   ///< [m/s]
  Vec3 box_p = Vec3::Zero();      ///< centre of the site's copy [m]
  Quat box_q = Quat::Identity();  ///< its orientation
  Vec3 proxy_p = Vec3::Zero();    ///< RDP of the other user at this site [m]
  Vec3 force = Vec3::Zero();      ///< contact force on the device in this period [N]
};

struct SpatialRow {
  double t = 0.0;  ///< [s]
  std::array<SpatialSite, 2> site{};
};

struct SpatialResult {
  std::vector<SpatialRow> rows;  ///< tick k at k / haptic_rate before its period, k = 0 .. N-1
  SpatialRow end;                ///< state at t = duration, with the force of the last period
};

/// Start of user `user` (0 or 1): centre of the HIP [m].
[[nodiscard]] Vec3 computeStart(const SpatialParameters& parameters, std::size_t user);

/// Gains that turn the copies: angular_coordination, or its default for the uniform cube.
[[nodiscard]] SpringDamper computeAngularCoordination(const SpatialParameters& parameters);

/// Runs both sites. At each, the local HIP, the RDP of the other user and the cube copy touch each
/// other. Devices, ticks and packets are timed as in runPaperModel(). There is no guide and no
/// gravity. Throws std::invalid_argument on invalid masses, step or sampling.
[[nodiscard]] SpatialResult runSpatialCooperation(const SpatialParameters& parameters);

}  // namespace tandem::reference
