// A hand is pressed into fixed objects of all of Bullet's shapes.

#include "bridge/standing_shapes.h"

#include <algorithm>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btEmptyShape.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_gap.h"
#include "support/fakes.h"

namespace tandem::test {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kRadius = 0.01;       // of the hand [m]
constexpr double kStiffness = 1000.0;  // [N/m]
constexpr double kDepth = 0.004;       // [m]

/// A site alone with one fixed shape. Bullet does not know of the hand.
class PressedShape {
 public:
  PressedShape() : shapes(rig) {}

  /// Force on a hand that comes along -n, 10 mm in 0.1 s, and stays at `p_W` [N].
  Vec3 press(btCollisionShape& shape, const Vec3& p_W, const Vec3& n_W) {
    rig.addBody(shape, 0.0);
    FakeDevice device(p_W + 0.01 * n_W);
    SiteSettings settings;
    settings.tick_source = TickSource::kCaller;
    settings.contact = {kStiffness, 1.0};
    settings.hip_radius = kRadius;
    Site site(settings, rig.world, device);
    for (int tick = 0; tick < 400; ++tick) {
      const double left = std::max(0.0, 1.0 - tick / 100.0);
      device.sample.hip.p_W = p_W + 0.01 * left * n_W;
      device.sample.hip.v_W = left > 0.0 ? Vec3(-0.1 * n_W) : Vec3(0, 0, 0);
      site.tick(tick * kPeriod);
      if (tick % 4 == 3) rig.step(4.0 * kPeriod);
    }
    return device.force_W;
  }

  BulletRig rig;
  StandingShapes shapes;
};

/// Where Bullet lets the hand touch a shape, coming from far along -u.
SphereContact findTouch(const btConvexShape& shape, const Vec3& u, Vec3& p) {
  double low = 0.0, high = 0.2;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (findBulletContact(shape, middle * u, kRadius).gap > 0.0 ? high : low) = middle;
  }
  p = high * u;
  return findBulletContact(shape, p, kRadius);
}

class ConvexShapes : public ::testing::TestWithParam<StandingShape> {};

TEST_P(ConvexShapes, PushWithTheirDepthFromBothSides) {
  for (const double side : {1.0, -1.0}) {
    PressedShape scene;
    auto& shape = static_cast<btConvexShape&>(GetParam().make(scene.shapes));
    Vec3 p_touch;
    const SphereContact touch = findTouch(shape, side * Vec3(0.1, 1.0, 0.05).normalized(), p_touch);
    const Vec3 f_W = scene.press(shape, p_touch - kDepth * touch.n_W, touch.n_W);
    const double error = kStiffness * (GetParam().accuracy + byWidth(1e-6, 3e-5));
    EXPECT_NEAR(f_W.norm(), kStiffness * kDepth, error) << "side " << side;
    EXPECT_LT(f_W.cross(touch.n_W).norm(), 0.1 * f_W.norm()) << "side " << side;
  }
}

INSTANTIATE_TEST_SUITE_P(Standing, ConvexShapes, ::testing::ValuesIn(listConvexShapes()),
                         [](const auto& shape) { return shape.param.name; });

class FlatTops : public ::testing::TestWithParam<FlatTop> {};

TEST_P(FlatTops, PushAtTheirHeight) {
  PressedShape scene;
  btCollisionShape& shape = GetParam().make(scene.shapes);
  const Vec3 at(0.003, GetParam().height + kRadius - kDepth, 0.004);
  const Vec3 f_W = scene.press(shape, at, Vec3::UnitY());
  EXPECT_NEAR((f_W - kStiffness * kDepth * Vec3::UnitY()).norm(), 0.0, byWidth(1e-5, 1e-3));
}

INSTANTIATE_TEST_SUITE_P(Standing, FlatTops, ::testing::ValuesIn(listFlatTops()),
                         [](const auto& shape) { return shape.param.name; });

// Bullet's margin turns a flat 2-D box inside out: on one side it collides 3 mm too early.
TEST(FlatShapes, PushOnBothSides) {
  for (const double side : {1.0, -1.0}) {
    PressedShape scene;
    auto& box = scene.rig.makeShape<btBox2dShape>(toBullet(Vec3(0.03, 0.02, 0.0)));
    const Vec3 n = side * Vec3::UnitZ();
    const Vec3 f_W = scene.press(box, (kRadius - kDepth) * n, n);
    EXPECT_NEAR((f_W - kStiffness * kDepth * n).norm(), 0.0, 0.01) << side;
  }
}

TEST(EmptyShapes, AreNotFelt) {
  PressedShape scene;
  auto& shape = scene.rig.makeShape<btEmptyShape>();
  EXPECT_EQ(scene.press(shape, Vec3::Zero(), Vec3::UnitY()), Vec3::Zero());
}

}  // namespace
}  // namespace tandem::test
