// The central chain against a solver that shares no code with the island: device, cube and the
// remote user's proxy. Contacts are off the cube's middle, so it turns.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"
#include "reference/rigid_reference.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;                                       // haptic period [s]
constexpr double kRadius = 0.01, kEdge = 0.04;                         // [m]
constexpr double kProxyMass = 0.1, kCubeMass = 0.25;                   // [kg]
const CouplerGains kTie = {2000.0, 10.0};                              // coordination [N/m, N s/m]
const Vec3 kDevice(-0.03, 0.006, 0.002), kProxy(0.03, -0.003, 0.003);  // just touching the cube

struct ChainCase {
  const char* name;
  CouplerGains contact;
  double gap;             // gap of each sphere to the cube at the start [m]
  double travel, speed;   // distance [m] and rate [1/s] of the device's way in
  double reference_step;  // [s]
  double tolerance;       // [m]
};

/// Distance that the device and the proxy's user have moved in at time t.
double wayIn(const ChainCase& c, double t) { return c.travel * (1.0 - std::exp(-c.speed * t)); }

reference::SpringDamper convert(const CouplerGains& g) { return {g.stiffness, g.damping}; }

class IslandChain : public ::testing::TestWithParam<ChainCase> {};

TEST_P(IslandChain, FollowsTheFineReference) {
  const ChainCase& c = GetParam();
  const Vec3 back(c.gap, 0.0, 0.0);
  const CouplerGains turn_tie = {kTie.stiffness * kEdge * kEdge / 6.0,
                                 kTie.damping * kEdge * kEdge / 6.0};

  reference::RigidScene expected;
  expected.contact = convert(c.contact);
  expected.spheres.resize(2);
  reference::Sphere &device = expected.spheres[0], &proxy = expected.spheres[1];
  device.radius = proxy.radius = kRadius;
  device.motion = reference::Motion::kPrescribed;
  proxy.mass = kProxyMass;
  proxy.p = kProxy + back;
  proxy.coupling = convert(kTie);
  expected.boxes = {reference::makeUniformBox(Vec3::Constant(kEdge), kCubeMass)};
  reference::Box& box = expected.boxes[0];
  box.coupling = convert(kTie);
  box.angular_coupling = convert(turn_tie);

  Island island({});
  IslandBody body;
  body.shape = Sphere{kRadius};
  body.motion = Motion::kPrescribed;
  const BodyIndex hip = island.addBody(body);
  body.motion = Motion::kDynamic;
  body.mass = kProxyMass;
  body.start.p_W = kProxy + back;
  const BodyIndex rdp = island.addBody(body);
  body = {};
  body.shape = Box{Vec3::Constant(0.5 * kEdge)};
  body.mass = kCubeMass;
  body.inertia_B = box.inertia;
  const BodyIndex cube = island.addBody(body);
  island.addContact(hip, cube, c.contact);
  island.addContact(rdp, cube, c.contact);
  const CouplerIndex rdp_tie = island.addCoupler(rdp, {kTie, {}});
  island.addCoupler(cube, {kTie, turn_tie});
  island.prepare();

  double worst_p = 0.0, worst_turn = 0.0, turned = 0.0;
  for (int tick = 0; tick < 200; ++tick) {
    const double t = tick * kPeriod;
    RigidState hand;
    hand.p_W = device.p = kDevice - back + Vec3(wayIn(c, t), 0.0, 0.0);
    hand.v_W = device.v = Vec3((wayIn(c, t + kPeriod) - wayIn(c, t)) / kPeriod, 0.0, 0.0);
    island.setState(hip, hand);
    RigidState user;
    user.p_W = proxy.target_p = kProxy + back - Vec3(wayIn(c, t), 0.0, 0.0);
    island.setTarget(rdp_tie, user);

    island.advance(kPeriod);
    reference::advanceScene(expected, kPeriod, c.reference_step);
    worst_p = std::max({worst_p, (island.state(cube).p_W - box.p).norm(),
                        (island.state(rdp).p_W - proxy.p).norm()});
    worst_turn = std::max(worst_turn, island.state(cube).q_WB.angularDistance(box.q));
    turned = std::max(turned, box.q.angularDistance(Quat::Identity()));
  }
  EXPECT_GT(turned, 0.01);
  EXPECT_LT(worst_p, c.tolerance);
  EXPECT_LT(worst_turn, c.tolerance / kRadius);
  RecordProperty("worst_position_error_pm", static_cast<int>(worst_p * 1e12));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, IslandChain,
    ::testing::Values(
        // No event follows the first instant: the difference is the island's own error.
        ChainCase{"press", {2000.0, 10.0}, 0.0, 0.004, 50.0, 1e-5, 2e-10},
        ChainCase{"stiff_press", {4000.0, 1.0}, 0.0, 0.003, 50.0, 1e-5, 5e-10},
        // The reference is off by one step at the first contact: B v h / m of velocity, 1e-8 m.
        ChainCase{"impact", {2000.0, 10.0}, 0.004, 0.02, 30.0, 5e-7, 1e-7},
        ChainCase{"stiff_impact", {4000.0, 1.0}, 0.004, 0.02, 30.0, 1e-6, 1e-7}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace tandem
