// Some hosts wrap every shape in a compound of one child at its origin. It counts as that child.

#include <gtest/gtest.h>

#include "tandem/bullet_bridge/shapes.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"

namespace tandem::test {
namespace {

btCompoundShape& wrap(BulletRig& rig, btCollisionShape& shape,
                      const btTransform& pose = btTransform::getIdentity()) {
  auto& compound = rig.makeShape<btCompoundShape>();
  compound.addChildShape(pose, &shape);
  return compound;
}

TEST(OnlyShape, IsWhatTheIslandKnowsOfACompound) {
  BulletRig rig;
  auto& box = rig.makeShape<btBoxShape>(toBullet(Vec3(0.05, 0.05, 0.025)));
  EXPECT_TRUE(convertShape(wrap(rig, box)));
  EXPECT_TRUE(std::holds_alternative<Box>(*convertShape(wrap(rig, wrap(rig, box)))));
  EXPECT_TRUE(std::holds_alternative<Plane>(*convertShape(
      wrap(rig, rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0))))));

  const auto is_compound = [](const btCollisionShape& shape) {
    return std::holds_alternative<Compound>(*convertShape(shape));
  };
  EXPECT_TRUE(is_compound(wrap(rig, box, toBullet(Vec3(1e-3, 0, 0), Quat::Identity()))));
  EXPECT_TRUE(is_compound(wrap(rig, box, toBullet(Vec3::Zero(), turn(1e-3, Vec3::UnitZ())))));
  auto& two = wrap(rig, box);
  two.addChildShape(btTransform::getIdentity(), &box);
  EXPECT_TRUE(is_compound(two));
}

/// Pushes a shared box over a floor for half a second, with a neighbour in its way.
std::vector<btVector3> runOver(bool is_wrapped) {
  BulletRig rig(Vec3(0, 0, -9.81));
  const auto shapeOf = [&](btCollisionShape& shape) -> btCollisionShape& {
    return is_wrapped ? wrap(rig, shape) : shape;
  };
  auto& floor = rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0));
  auto& box = rig.makeShape<btBoxShape>(toBullet(Vec3(0.05, 0.05, 0.025)));
  rig.addBody(shapeOf(floor), 0);
  // A compound's own inertia is that of its bounding box, which includes a margin.
  const auto add = [&](const Vec3& p_W) -> btRigidBody& {
    btRigidBody& body = rig.addBody(shapeOf(box), 0.2, p_W);
    btVector3 inertia;
    box.calculateLocalInertia(btScalar(0.2), inertia);
    body.setMassProps(btScalar(0.2), inertia);
    body.updateInertiaTensor();
    return body;
  };
  btRigidBody& shared = add(Vec3(0, 0, 0.025));
  btRigidBody& neighbour = add(Vec3(0.2, 0.01, 0.025));

  SimulatedDeviceSettings device_settings;
  device_settings.start_W = Vec3(-0.06, 0, 0.025);
  SimulatedDevice device(device_settings, makeConstantHand(Vec3(5, 0, 0)));
  SiteSettings settings;
  settings.peers = 1;
  Site site(settings, rig.world, device);
  site.share(shared);
  std::vector<btVector3> places;
  for (int i = 0; i < 30; ++i) {
    rig.step(1.0 / 60.0);
    places.push_back(shared.getCenterOfMassPosition());
    places.push_back(neighbour.getCenterOfMassPosition());
  }
  return places;
}

TEST(OnlyShape, MovesInACompoundAsWithoutToTheBit) {
  const std::vector<btVector3> bare = runOver(false), wrapped = runOver(true);
  ASSERT_EQ(bare.size(), wrapped.size());
  for (std::size_t i = 0; i < bare.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(bare[i][axis], wrapped[i][axis]) << i;
  EXPECT_GT(bare[bare.size() - 2].x(), 0.2) << "the shared box has been pushed";
  EXPECT_GT(bare.back().x(), 0.25) << "and has pushed its neighbour";
}

}  // namespace
}  // namespace tandem::test
