// Bodies on couplers follow the closed form in every kind of world, at any stepping of the host.

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "host/any_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::FakeDevice;
using test::FakeLink;
using test::WorldKind;

constexpr PeerId kRemote{2};
constexpr double kStart = 0.01;    // [m] from the coupler's rest
constexpr double kDuration = 0.5;  // [s]
/// Largest error [m]; docs/embedding.md names it.
constexpr double kTolerance = sizeof(btScalar) == sizeof(double) ? 1e-12 : 6.5e-10;

/// m x'' + B x' + K x = 0 from kStart at rest. K = 2000, B = 10, m = 0.1: w0 = 141/s, damping ratio
/// 0.35.
double computeRinging(double t) {
  const double c = 10.0 / 0.2, w = std::sqrt(2000.0 / 0.1 - c * c);
  return kStart * std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
}

/// One way to call stepSimulation(). Returns the time that the world advanced [s].
struct Stepping {
  const char* name;
  std::function<double(btDiscreteDynamicsWorld&, int call)> step;
};

/// A call with `n` steps of 1/240 s.
Stepping makeGrouped(const char* name, int n) {
  return {name, [n](btDiscreteDynamicsWorld& world, int) {
            const btScalar fixed = btScalar(1) / 240;
            // The small excess keeps rounding from losing a sub-step.
            const btScalar excess = btScalar(1e-6);
            const int done =
                world.stepSimulation(static_cast<btScalar>(n) * fixed + excess, n, fixed);
            return done * static_cast<double>(fixed);
          }};
}

std::vector<Stepping> makeSteppings() {
  return {
      makeGrouped("OneSubStep", 1),
      makeGrouped("FourSubSteps", 4),
      makeGrouped("SixteenSubSteps", 16),
      {"NoFixedStep",
       [](btDiscreteDynamicsWorld& world, int) {
         const btScalar dt = btScalar(1) / 60;
         world.stepSimulation(dt, 0);
         return static_cast<double>(dt);
       }},
      {"ChangingStep",
       [](btDiscreteDynamicsWorld& world, int call) {
         const auto dt = static_cast<btScalar>(0.003 + 0.002 * ((call * 7) % 5));
         world.stepSimulation(dt, 0);
         return static_cast<double>(dt);
       }},
      {"ChangingFramesOfFixedSteps",
       [](btDiscreteDynamicsWorld& world, int call) {
         const auto fixed = btScalar(0.001);
         const auto frame = static_cast<btScalar>(0.008 + 0.0031 * ((call * 7) % 5));
         return world.stepSimulation(frame, 40, fixed) * static_cast<double>(fixed);
       }},
      {"LessThanAStep",  // two calls of three move nothing
       [](btDiscreteDynamicsWorld& world, int) {
         const btScalar fixed = btScalar(1) / 120;
         return world.stepSimulation(fixed / 3, 1, fixed) * static_cast<double>(fixed);
       }},
  };
}

class HostStepping : public ::testing::TestWithParam<std::tuple<WorldKind, Stepping>> {};

// A shared cube is pulled to a remote copy at rest; the proxy's remote user is at rest too. Near
// the origin float shows positions to half a bit of 10 mm, 6e-10 m.
TEST_P(HostStepping, FreeCouplersFollowTheClosedForm) {
  const auto& [kind, stepping] = GetParam();
  AnyHost host(kind, Vec3(0.0, 0.0, 0.0));
  btRigidBody& cube = host.addCube(0.2, Vec3(kStart, 0.0, 0.0));
  FakeDevice device(Vec3(10.0, 0.0, 0.0));
  FakeLink link;
  SiteSettings settings;
  settings.coordination = {2000.0, 10.0};
  settings.link_loss.enabled = false;  // one packet pulls for ever
  Site site(settings, *host.world, device);
  site.share(cube);
  const Vec3 user_W(0.0, 1.0, 0.0);
  site.connect(kRemote, link, user_W + Vec3(kStart, 0.0, 0.0));
  StatePacket packet = test::makePacket(kRemote, 0, user_W);
  packet.objects[packet.object_count++] = {0, RigidState{}};
  link.arrivals.push_back({packet, 0.0});

  double t = 0.0, worst = 0.0;
  const auto off = [&](const btRigidBody& body) {
    return std::abs(static_cast<double>(body.getWorldTransform().getOrigin().x()) -
                    computeRinging(t));
  };
  for (int call = 0; t < kDuration; ++call) {
    t += stepping.step(*host.world, call);
    worst = std::max({worst, off(cube), off(*site.proxyBody(0))});
  }
  EXPECT_LT(worst, kTolerance);
  RecordProperty("worst_um", std::to_string(1e6 * worst));
}

INSTANTIATE_TEST_SUITE_P(Ways, HostStepping,
                         ::testing::Combine(::testing::ValuesIn(test::kAllKinds),
                                            ::testing::ValuesIn(makeSteppings())),
                         [](const auto& way) {
                           return std::string(test::nameOf(std::get<0>(way.param))) +
                                  std::get<1>(way.param).name;
                         });

/// Way of a shared body under 0.1 N in a second, after `steps_before` host steps without a tick
/// [m].
double computePush(int steps_before, bool shares_first, double first_tick) {
  AnyHost host(WorldKind::kDiscrete, Vec3::Zero());
  btRigidBody& cube = host.addCube(0.2);
  FakeDevice device(Vec3(0.0, 0.0, 5.0));
  SiteSettings settings;
  settings.peers = 1;
  settings.tick_source = TickSource::kCaller;
  Site site(settings, *host.world, device);
  const auto wait = [&] {
    for (int i = 0; i < steps_before; ++i) host.step(1.0 / 60.0);
  };
  if (!shares_first) wait();
  site.share(cube);
  if (shares_first) wait();
  int ticks = 0;
  for (int step = 1; step <= 60; ++step) {
    while (ticks * 1e-3 < step / 60.0) site.tick(first_tick + 1e-3 * ticks++);
    cube.applyCentralForce(btVector3(btScalar(0.1), 0, 0));
    host.step(1.0 / 60.0);
  }
  return site.object(0).p_W.x();
}

TEST(HostClock, StepsBeforeTheFirstTickAreNotOfItsTime) {
  const double push = computePush(0, false, 0.0);
  ASSERT_NEAR(push, 0.25, 0.01);  // f t^2 / (2 m)
  for (const bool shares_first : {false, true}) {
    for (const double first_tick : {0.0, 10.0}) {
      // A step just before the clock begins counts as the first.
      EXPECT_NEAR(computePush(600, shares_first, first_tick), push, 0.01)
          << shares_first << ' ' << first_tick;
    }
  }
}

}  // namespace
}  // namespace tandem
