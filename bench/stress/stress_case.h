#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "tandem/coordination/shape.h"
#include "tandem/coordination/simulated_link.h"

#include "coordination/src/island/virtual_coupler.h"

/// \file
/// Random cases of `tandem bench stress`: scenes with absurd gains, masses, steps and delays.
namespace tandem::demos::bench {

enum class StressKind {
  kTwoSites,    ///< two users, each with a world, share a free body over a simulated link
  kGuided,      ///< the same in a slot, with each user's device in it
  kPaper,       ///< Experiment I or II of the paper, with a reference
  kScripted,    ///< one site; remote users are scripts, shared body and obstacles are free
  kRigid,       ///< cube pushed about on a floor with friction, among static boxes
  kNeighbours,  ///< the same among the host's own boxes; several shared bodies
  kJoined,      ///< pendulums and chains of the host's joints, one link of them shared
};
inline constexpr int kStressKindCount = 7;
[[nodiscard]] std::string_view nameOf(StressKind kind);

/// A body of the host's world.
struct StressBody {
  Shape shape;
  double mass = 0.0;  ///< mass of this copy [kg]; 0: static
  bool is_shared = false;
  RigidState start;
};

/// A joint of body `a` with the body before it in a chain, or of the first with the world.
struct StressJoint {
  std::size_t a = 0;
  std::optional<std::size_t> b;  ///< none: the world
  Vec3 pin_W = Vec3::Zero();     ///< at the start [m]
  std::optional<Vec3> axis_W;    ///< of a hinge; none: a ball
};

/// Motion of a scripted user from `start_W`: even, to and fro, or by leaps.
struct StressPath {
  enum class Form { kEven, kSine, kLeaps } form = Form::kEven;
  Vec3 start_W = Vec3::Zero();
  Vec3 v_W = Vec3::Zero();  ///< initial [m/s]
  double turn_time = 0.0;  ///< kEven: time of turning back [s]; kSine: 1/w [s]; kLeaps: between two
  Vec3 leap_W = Vec3::Zero();  ///< kLeaps: one leap, there and back [m]

  [[nodiscard]] PointState at(double time) const;
};

/// A user: the device at this site, or a script in place of a remote.
struct StressUser {
  StressPath path;  ///< path of scripted users; others start at its start
  bool is_scripted = true;
  double device_mass = 0.1, device_damping = 0.5;  ///< simulated device [kg, N s/m]
  double max_force = 0.0;                          ///< limit of the device [N]; 0: none
  Vec3 hand_W = Vec3::Zero();                      ///< constant force of the hand [N]
};

/// One case: everything that its run depends on.
struct StressCase {
  std::uint64_t seed = 0;
  std::uint64_t index = 0;
  StressKind kind = StressKind::kTwoSites;
  double duration = 0.2;  ///< [s]
  double host_step = 1.0 / 60.0, packet_rate = 128.0, haptic_rate = 1000.0;
  CouplerGains contact, coordination;
  std::optional<CouplerGains> angular;
  double proxy_mass = 0.1, proxy_damping = 0.0, radius = 0.01, object_damping = 0.0;
  double friction = 0.0;
  Impairments network;
  Vec3 origin_W = Vec3::Zero();
  Vec3 gravity_W = Vec3::Zero();
  std::optional<Vec3> guide;
  std::string_view scheme = "remote_dynamic_proxy";
  std::vector<StressBody> bodies;
  std::vector<StressJoint> joints;  ///< bodies of a scene with joints pass through each other
  std::vector<StressUser> users;    ///< the local one, then the remote ones
};

/// Cases from this index on are of kJoined; those before are of all other kinds.
inline constexpr std::uint64_t kFirstJoinedCase = 100000000;

/// Case `index` of a seed. Equal arguments give equal cases.
[[nodiscard]] StressCase drawStressCase(std::uint64_t seed, std::uint64_t index);

}  // namespace tandem::demos::bench
