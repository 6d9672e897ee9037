#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/bodies/haptic_body.h"

namespace tandem {
namespace {

using test::BulletRig;

/// Two cubes pressed into each other by 1 mm.
struct NativeContact : ::testing::Test {
  BulletRig rig;
  btRigidBody& a = rig.addCube(0.1, 0.02, Vec3::Zero());
  btRigidBody& b = rig.addCube(0.1, 0.02, Vec3(0.039, 0, 0));

  [[nodiscard]] int countPoints() {
    int points = 0;
    for (int i = 0; i < rig.dispatcher.getNumManifolds(); ++i)
      points += rig.dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
    return points;
  }
};

TEST_F(NativeContact, GoesWithItsCachedPointsWhenFiltered) {
  rig.step(1e-3);
  ASSERT_GT(countPoints(), 0);
  filterNativeContact(rig.world, a, b, true);
  EXPECT_EQ(countPoints(), 0);
  a.setLinearVelocity(btVector3(1, 0, 0));
  const btVector3 v_b = b.getLinearVelocity();
  for (int i = 0; i < 10; ++i) rig.step(1e-3);
  EXPECT_EQ(countPoints(), 0);
  EXPECT_EQ(a.getLinearVelocity(), btVector3(1, 0, 0));
  EXPECT_EQ(b.getLinearVelocity(), v_b);
}

TEST_F(NativeContact, ComesBackWhenSwitchedOnAgain) {
  filterNativeContact(rig.world, a, b, true);
  rig.step(1e-3);
  ASSERT_EQ(countPoints(), 0);
  filterNativeContact(rig.world, a, b, false);
  rig.step(1e-3);
  EXPECT_GT(countPoints(), 0);
  EXPECT_TRUE(a.checkCollideWith(&b));
}

TEST_F(NativeContact, LeavesTheHostsOwnFilterAlone) {
  a.setIgnoreCollisionCheck(&b, true);
  filterNativeContact(rig.world, a, b, true);
  filterNativeContact(rig.world, a, b, false);
  EXPECT_FALSE(a.checkCollideWith(&b));
  EXPECT_TRUE(b.checkCollideWith(&a));
}

}  // namespace
}  // namespace tandem
