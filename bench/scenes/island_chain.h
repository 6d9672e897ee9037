#pragma once

#include <cmath>
#include <cstdint>

#include "coordination/src/island/island.h"

namespace tandem::demos::bench {

/// Device, cube and remote user's proxy on a line: the island of the published tick costs. The
/// device presses and yields once per second; the targets of proxy and cube move slowly.
class IslandChain {
 public:
  /// The spheres are `gap` [m] away from the cube; a negative gap presses it.
  IslandChain(const CouplerGains& contact, double gap, bool cube_turns)
      : place_(0.5 * kEdge + kRadius + gap) {
    hip_ = island_.addBody(makeBall(Motion::kPrescribed, Vec3(-place_, 0.006, 0.0)));
    IslandBody body;
    body.shape = Box{Vec3::Constant(0.5 * kEdge)};
    body.mass = 0.25;
    if (cube_turns) body.inertia_B = Vec3::Constant(body.mass * kEdge * kEdge / 6.0);
    cube_ = island_.addBody(body);
    const BodyIndex proxy =
        island_.addBody(makeBall(Motion::kDynamic, Vec3(place_, -0.004, 0.003)));
    island_.addContact(hip_, cube_, contact);
    island_.addContact(proxy, cube_, contact);
    island_.addContact(hip_, proxy, contact);
    const double square = kEdge * kEdge / 6.0;
    cube_tie_ = island_.addCoupler(cube_, {{2000.0, 10.0}, {2000.0 * square, 10.0 * square}});
    proxy_tie_ = island_.addCoupler(proxy, {{2000.0, 10.0}, {}});
    island_.prepare();
  }

  /// Runs one haptic period.
  void tick() {
    const double w = 6.2831853071795865;
    const double phase = w * 1e-3 * static_cast<double>(++ticks_ % 1000);
    RigidState device, target;
    device.p_W = Vec3(-place_ + 1e-3 * (1.0 - std::cos(phase)), 0.006, 0.0);
    device.v_W = Vec3(1e-3 * w * std::sin(phase), 0.0, 0.0);
    island_.setState(hip_, device);
    target.p_W = Vec3(place_ - 2e-3 - 1e-4 * std::cos(phase), -0.004, 0.003);
    island_.setTarget(proxy_tie_, target);
    target.p_W = Vec3(1e-5 * std::sin(phase), 0.0, 0.0);
    island_.setTarget(cube_tie_, target);
    island_.advance(1e-3);
  }

  [[nodiscard]] const RigidState& cube() const { return island_.state(cube_); }

 private:
  static constexpr double kEdge = 0.04, kRadius = 0.01;  // [m]

  static IslandBody makeBall(Motion motion, const Vec3& p_W) {
    IslandBody ball;
    ball.shape = Sphere{kRadius};
    ball.motion = motion;
    ball.mass = motion == Motion::kDynamic ? 0.1 : 0.0;
    ball.start.p_W = p_W;
    return ball;
  }

  Island island_{{}};
  double place_;  // distance of the spheres from the cube's middle [m]
  BodyIndex hip_, cube_;
  CouplerIndex cube_tie_, proxy_tie_;
  std::uint64_t ticks_ = 0;
};

/// No body is in reach of another.
inline IslandChain makeLoneCouplers() { return IslandChain({2000.0, 10.0}, 0.05, false); }
/// Both spheres press the cube beside its middle, so it rotates.
inline IslandChain makeThreeInContact() { return IslandChain({2000.0, 10.0}, -1e-3, true); }

}  // namespace tandem::demos::bench
