// A hand that is stronger than its device goes into a thin plate, and is pushed out where it came
// from: before the middle, behind it, and far behind the plate.

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"

namespace tandem {
namespace {

using test::BulletRig;

constexpr double kPeriod = 1e-3;
constexpr double kHalfThickness = 0.01, kHalfWidth = 0.1;
constexpr double kStrength = 9.0;  // of the hand [N]
constexpr double kLimit = 8.0;     // of the device [N]
constexpr double kPressing = 0.4;  // time until it lets go [s]

/// A hand that presses down, and lets go after a while.
class PressingHand final : public Hand {
 public:
  Vec3 computeForce(double t, const PointState&) const noexcept override {
    return {0.0, t < kPressing ? -kStrength : 0.0, 0.0};
  }
};

enum class Kind { kBox, kHull, kTriangles };

class ThinPlate : public ::testing::TestWithParam<Kind> {
 protected:
  btCollisionShape& makeShape() {
    const btVector3 half = toBullet(Vec3(kHalfWidth, kHalfThickness, kHalfWidth));
    if (GetParam() == Kind::kBox) {
      shape_ = std::make_unique<btBoxShape>(half);
    } else if (GetParam() == Kind::kHull) {
      auto hull = std::make_unique<btConvexHullShape>();
      for (int i = 0; i < 8; ++i) hull->addPoint(corner(i));
      shape_ = std::move(hull);
    } else {
      constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
      for (const auto& face : kFaces) {
        triangles_.addTriangle(corner(face[0]), corner(face[1]), corner(face[2]));
        triangles_.addTriangle(corner(face[0]), corner(face[2]), corner(face[3]));
      }
      shape_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
    }
    shape_->setMargin(0);
    return *shape_;
  }

 private:
  static btVector3 corner(int i) {
    return {static_cast<btScalar>((i & 1) ? kHalfWidth : -kHalfWidth),
            static_cast<btScalar>((i & 2) ? kHalfThickness : -kHalfThickness),
            static_cast<btScalar>((i & 4) ? kHalfWidth : -kHalfWidth)};
  }
  btTriangleMesh triangles_;
  std::unique_ptr<btCollisionShape> shape_;
};

TEST_P(ThinPlate, PushesToTheSideThatWasTouched) {
  BulletRig rig;
  btRigidBody plate(0, nullptr, &makeShape());
  rig.world.addRigidBody(&plate);

  SimulatedDeviceSettings handle;
  handle.max_force = kLimit;
  handle.start_W = Vec3(0.013, kHalfThickness + 0.02, 0.004);
  SimulatedDevice device(handle, std::make_unique<PressingHand>());
  SiteSettings settings;
  settings.tick_source = TickSource::kCaller;
  Site site(settings, rig.world, device);
  double deepest = 0.0, lowest_force = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    site.tick(tick * kPeriod);
    if (tick % 16 == 15) rig.step(16 * kPeriod);
    deepest = std::min(deepest, site.hip().p_W.y());
    lowest_force = std::min(lowest_force, site.force().y());
  }
  EXPECT_LT(deepest, -5.0 * kHalfThickness) << "it never went through";
  EXPECT_GE(lowest_force, 0.0);
  EXPECT_GT(site.hip().p_W.y(), kHalfThickness);
  rig.world.removeRigidBody(&plate);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ThinPlate,
                         ::testing::Values(Kind::kBox, Kind::kHull, Kind::kTriangles),
                         [](const auto& kind) {
                           return std::string(std::array{"Box", "Hull", "Triangles"}.at(
                               static_cast<std::size_t>(kind.param)));
                         });

}  // namespace
}  // namespace tandem
