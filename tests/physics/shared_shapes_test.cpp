// A hand pushes shared objects of shapes other than boxes on a floor, and feels floors of
// triangles.

#include <cmath>

#include <gtest/gtest.h>

#include "coordination/src/geometry/triangle_mesh.h"
#include "physics/neighbour_scene.h"
#include "support/solids.h"

namespace tandem {
namespace {

using test::byWidth;
using test::kGravity;
using test::NeighbourScene;

constexpr double kRadius = 0.01;  // radius of the hand [m]
constexpr double kHeight = 0.02;  // half height of the objects [m]
constexpr double kMargin = 1e-4;  // collision margin of hulls and meshes [m]
constexpr double kObject = 0.1;   // mass of the copy [kg]

/// A hand that waits, then moves along x. Records its mean force in the last half second.
class MovingHand final : public HapticDevice {
 public:
  explicit MovingHand(const Vec3& start) : start_(start) {}
  static constexpr double kWait = 0.3, kSpeed = 0.05, kEnd = 1.8;  // [s], [m/s], [s]

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    now_ = now;
    if (now < kWait) return {{start_, Vec3::Zero()}, true};
    return {{start_ + Vec3(kSpeed * (now - kWait), 0, 0), Vec3(kSpeed, 0, 0)}, true};
  }
  void write(const Vec3& f_W) noexcept override {
    if (now_ < kEnd - 0.5) return;
    sum_ += f_W;
    ++count_;
  }
  [[nodiscard]] Vec3 meanForce() const { return sum_ / count_; }

 private:
  DeviceCapabilities limits_{"moving hand"};
  Vec3 start_, sum_ = Vec3::Zero();
  double now_ = 0.0;
  int count_ = 0;
};

class SharedShape : public ::testing::TestWithParam<const char*> {
 protected:
  btCollisionShape& make(NeighbourScene& scene) {
    const std::string kind = GetParam();
    const auto h = static_cast<btScalar>(kHeight);
    if (kind == "CylinderUpright") return scene.rig.makeShape<btCylinderShapeZ>(btVector3(h, h, h));
    if (kind == "CapsuleLying") return scene.rig.makeShape<btCapsuleShape>(h, btScalar(0.04));
    auto& hull = scene.rig.makeShape<btConvexHullShape>();
    hull.setMargin(static_cast<btScalar>(kMargin));
    // A prism of eight sides, standing upright.
    for (const Vec3& p : test::makePrism(kHeight, kHeight, 8).corners)
      hull.addPoint(toBullet(Vec3(p.x(), -p.z(), p.y())));
    return hull;
  }
};

// The hand pushes from the side through the middle at 5 cm/s. The object goes along; the hand feels
// its friction.
TEST_P(SharedShape, IsPushedOverAFloor) {
  NeighbourScene scene(true);
  scene.addFloor();
  btRigidBody& object =
      scene.rig.addBody(make(scene), 2.0 * kObject, Vec3(0.0, 0.0, kHeight + kMargin));
  object.setFriction(static_cast<btScalar>(std::sqrt(NeighbourScene::kFriction)));
  // The hand is low, so the object does not tip, but off the floor.
  MovingHand hand(Vec3(-kHeight - kRadius - 0.005, 0.0, 0.6 * kHeight));
  Site site(scene.settings, scene.rig.world, hand);
  site.share(object);
  scene.run(MovingHand::kWait, 240.0);
  const double rest = scene.positionOf(object).z();
  scene.run(MovingHand::kEnd - MovingHand::kWait, 240.0);
  EXPECT_GT(scene.positionOf(object).x(), 0.05);
  EXPECT_NEAR(scene.positionOf(object).z(), rest, 1e-4);
  // A capsule rolls away.
  if (std::string(GetParam()) == "CapsuleLying") return;
  // While the object slides, Bullet drops contact points and finds them again.
  // The hull yields sideways at its edge and yaws: friction of its points is no longer along x.
  const double yaw_rate = std::abs(static_cast<double>(object.getAngularVelocity().z()));
  EXPECT_NEAR(scene.velocityOf(object).x(), MovingHand::kSpeed, yaw_rate < 1e-3 ? 1e-4 : 1e-2);
  EXPECT_NEAR(-hand.meanForce().x(), NeighbourScene::kFriction * kObject * kGravity,
              yaw_rate < 1e-3 ? 1e-3 : 0.02);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SharedShape,
                         ::testing::Values("CylinderUpright", "CapsuleLying", "Hull"),
                         [](const auto& kind) { return std::string(kind.param); });

// The hand feels neighbours of these shapes, and they hold the shared cube.
TEST(SharedShapes, NeighboursOfOtherShapesAreFelt) {
  NeighbourScene scene;
  auto& hull = scene.rig.makeShape<btConvexHullShape>();
  hull.setMargin(static_cast<btScalar>(kMargin));
  for (const Vec3& p : test::makeOctahedron(Vec3::Constant(0.03)).corners)
    hull.addPoint(toBullet(p));
  btRigidBody& body = scene.rig.addBody(hull, 0.2, Vec3(0.0, 0.06, 0.0));
  body.setSleepingThresholds(0, 0);
  scene.device.sample.hip.p_W = Vec3(0.0, 0.06 + 0.03 + kRadius + 0.002, 0.0);
  scene.start();
  scene.run(0.1);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  const Vec3 start = scene.device.sample.hip.p_W;
  double time = 0.0;
  scene.run(0.5, 240.0, [&] {
    time += 1.0 / 240.0;
    scene.device.sample.hip = {start - Vec3(0.0, 0.03 * time, 0.0), Vec3(0.0, -0.03, 0.0)};
  });
  EXPECT_LT(scene.velocityOf(body).y(), -0.01);
}

/// The device's force over a floor of triangles or a plane.
std::vector<Vec3> pressAndSlide(bool is_mesh) {
  NeighbourScene scene;
  btTriangleMesh triangles;
  const std::vector<Vec3> corners = test::makeFloor(20, 0.012);
  const auto up = [](const Vec3& p) {
    return btVector3(btScalar(p.z()), btScalar(p.x()), btScalar(p.y()));
  };
  for (std::size_t i = 0; i < corners.size(); i += 3)
    triangles.addTriangle(up(corners[i]), up(corners[i + 1]), up(corners[i + 2]));
  if (is_mesh) {
    auto& mesh = scene.rig.makeShape<btBvhTriangleMeshShape>(&triangles, true);
    mesh.setMargin(static_cast<btScalar>(kMargin));
    scene.rig.addBody(mesh, 0.0);
  } else {
    scene.rig.addBody(
        scene.rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), static_cast<btScalar>(kMargin)),
        0.0);
  }
  scene.device.sample.hip.p_W = Vec3(0.0, 0.0, 0.02);
  scene.addCube(Vec3(0.0, 0.0, 1.0));
  scene.start();
  std::vector<Vec3> forces;
  double time = 0.0;
  scene.run(1.0, 240.0, [&] {
    time += 1.0 / 240.0;
    scene.device.sample.hip.p_W =
        Vec3(0.05 * std::sin(5.0 * time), 0.03 * std::sin(9.0 * time), 0.012 - 0.008 * time);
    forces.push_back(scene.device.force_W);
  });
  return forces;
}

TEST(FeltMesh, FloorOfTrianglesIsAPlane) {
  const std::vector<Vec3> mesh = pressAndSlide(true), plane = pressAndSlide(false);
  double most = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_LT((mesh[i] - plane[i]).norm(), byWidth(1e-9, 1e-3)) << i;
    most = std::max(most, mesh[i].norm());
  }
  EXPECT_GT(most, 5.0);
}

}  // namespace
}  // namespace tandem
