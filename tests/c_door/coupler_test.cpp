// A free coupler through each way into a world. The host's bodies follow the closed form at any
// step and sub-step of the host.

#include <tuple>

#include "bridge/bullet_rig.h"
#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

// Rounding of 10 mm, about 1e-12. In float: half a bit of 10 mm, plus 6e-8 of a step of 17 ms,
// which Bullet rounds too, at 1 m/s.
const double kExact = byDoorWidth(5e-12, 0.01 * 0x1p-24 + 1e-9);
constexpr double kDuration = 0.5;

class LoneCoupler : public ::testing::TestWithParam<std::tuple<double, int>> {
 protected:
  [[nodiscard]] static double frame() { return 1.0 / std::get<0>(GetParam()); }
  [[nodiscard]] static int substeps() { return std::get<1>(GetParam()); }
  [[nodiscard]] static double step() { return roundToDoor(frame() / substeps()); }

  /// Largest difference over half a second of frames. `advance` makes a frame, `where` gives the
  /// body's place.
  template <typename Advance, typename Where>
  static double findWorst(Advance advance, Where where) {
    double worst = 0.0, t = 0.0;
    while (t < kDuration) {
      advance();
      t += substeps() * step();
      worst = std::max(worst, std::abs(where() - computeRinging(0.01, t)));
    }
    return worst;
  }
};

TEST_P(LoneCoupler, IsTheClosedFormInAWorldOfTandems) {
  const LoneDoorProxy proxy(makeWorld());
  const double worst = findWorst(
      [&] { ok(tandem_world_step(proxy.world, substeps() * step(), substeps(), step())); },
      [&] { return proxy.body(proxy.proxy).position[0]; });
  EXPECT_LE(worst, kExact);
}

TEST_P(LoneCoupler, IsTheClosedFormInAHostsWorld) {
  BulletRig rig;
  TandemWorld* world = nullptr;
  ok(tandem_world_attach(&rig.world, TANDEM_ATTACH_ABI, &world));
  const LoneDoorProxy proxy(world);
  const double worst = findWorst(
      [&] {
        rig.world.stepSimulation(static_cast<btScalar>(substeps() * step()), substeps(),
                                 static_cast<btScalar>(step()));
      },
      [&] { return proxy.body(proxy.proxy).position[0]; });
  EXPECT_LE(worst, kExact);
}

/// An engine independent of Tandem: gravity, then x += v dt.
struct Engine {
  TandemState body;
  double gravity = 0.0;

  void step(double dt) {
    body.velocity[0] += dt * gravity;
    for (int i = 0; i < 3; ++i) body.position[i] += dt * body.velocity[i];
  }
};

class LoneGuest : public LoneCoupler {
 protected:
  static double findWorstWith(double gravity) {
    const LoneDoorProxy proxy(makeWorld());
    Engine engine{proxy.body(proxy.proxy), gravity};
    const double host_gravity[3] = {gravity, 0.0, 0.0};
    double worst_before_set = 0.0, t = 0.0;
    const double worst = findWorst(
        [&] {
          for (int i = 0; i < substeps(); ++i) {
            TandemState given{};
            ok(tandem_world_begin_step(proxy.world, step(), host_gravity, 1, &proxy.proxy,
                                       &engine.body, &given));
            std::copy_n(given.velocity, 3, engine.body.velocity);
            engine.step(step());
            t += step();
            worst_before_set = std::max(
                worst_before_set, std::abs(engine.body.position[0] - computeRinging(0.01, t)));
            ok(tandem_world_end_step(proxy.world, 1, &proxy.proxy, &engine.body, &engine.body));
          }
        },
        [&] { return engine.body.position[0]; });
    EXPECT_EQ(proxy.read().status, 0u);
    return std::max(worst, worst_before_set);
  }
};

TEST_P(LoneGuest, IsTheClosedForm) { EXPECT_LE(findWorstWith(0.0), kExact); }

// The engine's own gravity is no force on bodies that the island moves.
TEST_P(LoneGuest, IsTheClosedFormUnderTheEnginesGravity) {
  EXPECT_LE(findWorstWith(-9.81), kExact);
}

const auto kSteps = ::testing::Combine(::testing::Values(60.0, 240.0), ::testing::Values(1, 4, 16));
INSTANTIATE_TEST_SUITE_P(Steps, LoneCoupler, kSteps);
INSTANTIATE_TEST_SUITE_P(Steps, LoneGuest, kSteps);

}  // namespace
}  // namespace tandem
