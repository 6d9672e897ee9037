// Hosts drag bodies by joints whose frames they move, as Bullet's mouse picking does.

#include <algorithm>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::NeighbourScene;

constexpr double kHalf = NeighbourScene::kHalf;
constexpr double kSpeed = 1.0;  // of the mouse [m/s]
constexpr double kStep = 1 / 60.0;

/// Picks a body as Bullet's examples do.
class Mouse {
 public:
  Mouse(btDiscreteDynamicsWorld& world, btRigidBody& body, const Vec3& pivot_B)
      : world_(world), body_(body), joint_(body, toBullet(pivot_B)), start_(joint_.getPivotInB()) {
    body_.setActivationState(DISABLE_DEACTIVATION);
    joint_.m_setting.m_impulseClamp = 30;
    joint_.m_setting.m_tau = btScalar(0.001);
    world_.addConstraint(&joint_, true);
  }
  ~Mouse() {
    world_.removeConstraint(&joint_);
    body_.forceActivationState(ACTIVE_TAG);
  }
  Mouse(const Mouse&) = delete;
  Mouse& operator=(const Mouse&) = delete;

  void moveTo(const Vec3& way) { joint_.setPivotB(start_ + toBullet(way)); }

 private:
  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  btPoint2PointConstraint joint_;
  btVector3 start_;
};

/// The same cube in a world with a site, and in one without.
struct Twins {
  NeighbourScene scene;
  BulletRig bare;
  btRigidBody& twin;

  Twins() : twin(bare.addCube(2.0 * NeighbourScene::kCubeMass, kHalf)) {
    scene.start();
    twin.setSleepingThresholds(0, 0);
    scene.cube->setSleepingThresholds(0, 0);
    step(6);
  }
  template <typename Each>
  void step(int count, Each each) {
    for (int i = 0; i < count; ++i) {
      each(i);
      scene.rig.step(kStep);
      bare.step(kStep);
      apart = std::max(
          apart,
          (NeighbourScene::positionOf(*scene.cube) - NeighbourScene::positionOf(twin)).norm());
      spin = std::max(spin, static_cast<double>(scene.cube->getAngularVelocity().length()));
      twins_spin = std::max(twins_spin, static_cast<double>(twin.getAngularVelocity().length()));
    }
  }
  void step(int count) {
    step(count, [](int) {});
  }
  double apart = 0.0, spin = 0.0, twins_spin = 0.0;
};

/// Drags both by 1 m, and holds them for a moment.
void drag(Twins& twins, const Vec3& pivot_B) {
  Mouse mouse(twins.scene.rig.world, *twins.scene.cube, pivot_B);
  Mouse twins_mouse(twins.bare.world, twins.twin, pivot_B);
  twins.step(6);
  const int count = static_cast<int>(1.0 / (kSpeed * kStep) + 0.5);
  twins.step(count, [&](int i) {
    for (Mouse* one : {&mouse, &twins_mouse}) one->moveTo(Vec3(kSpeed * kStep * (i + 1), 0, 0));
  });
  twins.step(20);
}

constexpr double kApart = test::byWidth(1e-6, 1e-3);  // [m]

// The island pulled at 0.25 m/s, and the cube was left behind.
TEST(DraggedJoints, ACubeFollowsTheMouseAsInBareBullet) {
  Twins twins;
  drag(twins, Vec3::Zero());
  EXPECT_LT(twins.apart, kApart);
  EXPECT_NEAR(NeighbourScene::positionOf(*twins.scene.cube).x(), 1.0, 0.01);
}

// It spun at 52 rad/s.
TEST(DraggedJoints, ACubeIsSpunByItsCornerNoFasterThanInBareBullet) {
  Twins twins;
  drag(twins, Vec3(0.0, 0.01, 0.005));
  EXPECT_LT(twins.apart, kApart);
  EXPECT_LT(twins.spin, 1.01 * twins.twins_spin + 1e-3);
}

TEST(DraggedJoints, ACubeIsHeldAgainOnceTheMouseStands) {
  Twins twins;
  Mouse mouse(twins.scene.rig.world, *twins.scene.cube, Vec3::Zero());
  twins.step(6);
  EXPECT_TRUE(twins.scene.site->isHeld(0));
  mouse.moveTo(Vec3(0.05, 0.0, 0.0));
  twins.step(1);
  EXPECT_FALSE(twins.scene.site->isHeld(0));
  twins.step(60);
  EXPECT_TRUE(twins.scene.site->isHeld(0));
  EXPECT_EQ(twins.scene.site->status(), kTickOk);
  EXPECT_NEAR(NeighbourScene::positionOf(*twins.scene.cube).x(), 0.05, 1e-3);
  EXPECT_LT(NeighbourScene::velocityOf(*twins.scene.cube).norm(), 0.01);
}

TEST(DraggedJoints, ANeighbourIsDraggedByBullet) {
  NeighbourScene scene;
  btRigidBody& box = scene.addBox(Vec3(0.0, 0.045, 0.0));
  scene.start();
  scene.run(0.1);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  Mouse mouse(scene.rig.world, box, Vec3::Zero());
  scene.run(0.1);
  double way = 0.0;
  scene.run(0.2, 60.0, [&] { mouse.moveTo(Vec3(0.0, way += kSpeed * kStep, 0.0)); });
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_NEAR(NeighbourScene::velocityOf(box).y(), kSpeed, 0.15);
}

}  // namespace
}  // namespace tandem
