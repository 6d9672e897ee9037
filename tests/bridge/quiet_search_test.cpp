// Bullet's global callbacks are the host's: the private search never calls them.

#include <atomic>

#include <gtest/gtest.h>

#include "bridge/obstacle_scene.h"
#include "bridge/vanishing_shape.h"

namespace tandem {
namespace {

using test::ObstacleScene;
using test::Vanishing;
using test::VanishingFloor;

std::atomic<int> calls{0};
int combinations = 0;
const btCollisionObject* combined_a = nullptr;

/// Sets all of Bullet's global contact callbacks to counting ones.
class CountingCallbacks {
 public:
  CountingCallbacks() {
    calls = 0;
    gContactAddedCallback = [](btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                               const btCollisionObjectWrapper*, int, int) { return ++calls > 0; };
    gContactProcessedCallback = [](btManifoldPoint&, void*, void*) { return ++calls > 0; };
    gContactStartedCallback = [](btPersistentManifold* const&) { ++calls; };
    gContactEndedCallback = [](btPersistentManifold* const&) { ++calls; };
    gContactDestroyedCallback = [](void*) { return ++calls > 0; };
  }
  ~CountingCallbacks() {
    gContactAddedCallback = nullptr;
    gContactProcessedCallback = nullptr;
    gContactStartedCallback = nullptr;
    gContactEndedCallback = nullptr;
    gContactDestroyedCallback = nullptr;
  }
  CountingCallbacks(const CountingCallbacks&) = delete;
  CountingCallbacks& operator=(const CountingCallbacks&) = delete;
};

TEST(QuietSearch, NoShapeCallsTheHostBack) {
  for (int kind = -1; kind < test::kVanishingKinds; ++kind) {
    ObstacleScene scene;
    std::unique_ptr<VanishingFloor> floor;
    if (kind < 0) {
      scene.addPlane(0.5);
    } else {
      floor = std::make_unique<VanishingFloor>(static_cast<Vanishing>(kind));
      scene.addObstacle(floor->shape(), 0.5);
    }
    const CountingCallbacks counting;
    scene.start(Vec3(0.0, ObstacleScene::kHalf + 0.002, 0.0));
    // It lands, slides and is lifted off.
    scene.run(0.1, 1.0 / 2000.0, Vec3(0.8, 0.0, 0.0));
    scene.run(0.1, 1.0 / 2000.0, Vec3(0.0, 4.0, 0.0));
    EXPECT_GT(scene.obstacles.searches() + scene.obstacles.frozenSearches(), 100u) << kind;
    EXPECT_GT(scene.obstacles.searches(), 0u) << kind;
    EXPECT_EQ(calls, 0) << kind;
    scene.rig.world.removeRigidBody(scene.rig.bodies.front().get());
    scene.rig.bodies.erase(scene.rig.bodies.begin());
  }
}

// A host that combines friction in its own way gets its own objects, and what it says holds.
TEST(QuietSearch, FrictionIsCombinedByTheHostFromItsOwnObjects) {
  const auto bullets = gCalculateCombinedFrictionCallback;
  ObstacleScene scene;
  scene.addPlane(1.0);
  scene.start(Vec3(0.0, ObstacleScene::kHalf, 0.0));
  combinations = 0;
  gCalculateCombinedFrictionCallback = [](const btCollisionObject* a, const btCollisionObject*) {
    ++combinations;
    combined_a = a;
    return btScalar(0);
  };
  scene.run(0.1, 1.0 / 2000.0, Vec3(0.5, 0.0, 0.0));
  EXPECT_NEAR(scene.state.v_W.x(), 0.5, 1e-6) << "5 m/s^2 without friction";
  EXPECT_EQ(combinations, 1) << "once, as nothing changed later";
  EXPECT_TRUE(combined_a == scene.rig.bodies[0].get() || combined_a == scene.rig.bodies[1].get());
  gCalculateCombinedFrictionCallback = bullets;
  scene.run(0.05, 1.0 / 2000.0);
  EXPECT_NEAR(scene.state.v_W.x(), 0.5 - 0.05 * ObstacleScene::kGravity, 0.01) << "friction 1";
}

// Only Bullet's own contact can tell what a callback makes of an object's points.
TEST(QuietSearch, AnObjectWithACallbackIsLeftToBullet) {
  ObstacleScene scene;
  btRigidBody& floor = scene.addBoxFloor(0.5);
  floor.setCollisionFlags(floor.getCollisionFlags() |
                          btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  scene.start(Vec3(0.0, ObstacleScene::kHalf, 0.0));
  const btRigidBody& cube = *scene.rig.bodies.back();
  const auto isBullets = [&] {
    return floor.checkCollideWith(&cube) && cube.checkCollideWith(&floor);
  };
  EXPECT_FALSE(isBullets()) << "no callback is set";
  {
    const CountingCallbacks counting;
    scene.search();
    EXPECT_TRUE(isBullets());
    scene.rig.step(1.0 / 240.0);
    EXPECT_GT(calls, 0) << "Bullet's own contact calls it";
  }
  scene.search();
  EXPECT_FALSE(isBullets());
}

}  // namespace
}  // namespace tandem
