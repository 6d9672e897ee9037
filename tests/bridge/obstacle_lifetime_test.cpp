// A host may overwrite and delete what its world does not have any more, whoever still searches.

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "bridge/obstacle_scene.h"
#include "bridge/vanishing_shape.h"

namespace tandem {
namespace {

using test::ObstacleScene;
using test::Vanishing;
using test::VanishingFloor;

class ObstacleLifetime : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static Vanishing kind() { return static_cast<Vanishing>(GetParam()); }
};

// The cube goes on standing on a floor that the host deleted after the last search.
TEST_P(ObstacleLifetime, CubeStandsOnADeletedFloorUntilTheNextSearch) {
  ObstacleScene scene;
  auto floor = std::make_unique<VanishingFloor>(kind());
  btRigidBody& body = scene.addObstacle(floor->shape(), 1.0);
  scene.start(Vec3(0.0, ObstacleScene::kHalf + 0.001, 0.0));
  scene.run(0.05, 1.0 / 4000.0);
  const double height = scene.position().y();
  Island island = scene.makeIsland(1.0 / 4000.0);
  island.setExternalWrench(0, Vec3(0.05, -ObstacleScene::kMass * ObstacleScene::kGravity, 0.0),
                           Vec3::Zero());
  scene.rig.world.removeRigidBody(&body);
  body.setCollisionShape(nullptr);
  floor.reset();
  for (int i = 0; i < 400; ++i) island.advance(1.0 / 4000.0);
  EXPECT_NEAR(island.state(0).p_W.y(), height, 1e-4);
  // Nothing is there any more.
  scene.search();
  scene.state = island.state(0);
  scene.run(0.1, 1.0 / 4000.0);
  EXPECT_LT(scene.position().y(), height - 0.02);
}
INSTANTIATE_TEST_SUITE_P(Kinds, ObstacleLifetime, ::testing::Range(0, test::kVanishingKinds));

// A child that the host took out of its compound is gone after the next search.
TEST(ObstacleChanges, AChildThatLeftItsCompoundHoldsNothing) {
  ObstacleScene scene;
  auto& compound = scene.rig.makeShape<btCompoundShape>();
  auto child =
      std::make_unique<btBoxShape>(btVector3(btScalar(0.2), btScalar(0.05), btScalar(0.2)));
  btBoxShape far_box(btVector3(1, 1, 1));
  const btTransform beside(btQuaternion::getIdentity(), btVector3(5, 0, 0));
  compound.addChildShape(beside, &far_box);
  compound.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(0, btScalar(-0.05), 0)),
                         child.get());
  scene.addObstacle(compound, 1.0);
  scene.start(Vec3(0.0, ObstacleScene::kHalf, 0.0));
  scene.run(0.1, 1.0 / 4000.0);
  EXPECT_NEAR(scene.position().y(), ObstacleScene::kHalf, 1e-5);
  compound.removeChildShape(child.get());
  child.reset();
  scene.run(0.1, 1.0 / 4000.0);
  EXPECT_LT(scene.position().y(), 0.0);
}

// Only triangles near the body are copied of a large mesh, and more when it moves on.
TEST(ObstacleChanges, ABodySlidesOverALargeMesh) {
  ObstacleScene scene;
  std::vector<btScalar> heights(401 * 401, btScalar(0));
  auto& field = scene.rig.makeShape<btHeightfieldTerrainShape>(401, 401, heights.data(),
                                                               btScalar(-1), btScalar(1), 1, false);
  field.setLocalScaling(btVector3(btScalar(0.005), 1, btScalar(0.005)));
  field.setMargin(0);
  scene.addObstacle(field, 0.0);
  scene.start(Vec3(-0.9, ObstacleScene::kHalf, 0.0));
  scene.state.v_W = Vec3(1.5, 0.0, 0.0);
  double lowest = 1.0;
  scene.run(1.2, 1.0 / 1000.0, Vec3::Zero(),
            [&] { lowest = std::min(lowest, scene.position().y()); });
  // Inner edges of triangles brake it, as in Bullet; in float more.
  EXPECT_GT(scene.position().x(), test::byWidth(0.5, 0.2));
  EXPECT_GT(lowest, ObstacleScene::kHalf - test::byWidth(1e-4, 1e-3));
}

}  // namespace
}  // namespace tandem
