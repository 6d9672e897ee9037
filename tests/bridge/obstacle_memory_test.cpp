#include <cstdlib>

#include <gtest/gtest.h>

#include "bridge/obstacle_scene.h"
#include "coordination/src/geometry/triangle_mesh.h"

namespace tandem {
namespace {

int allocations = 0;

void* countingAllocate(std::size_t size, int alignment) {
  ++allocations;
  const auto step = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(step, (size + step - 1) / step * step);
}
void countingFree(void* memory) { std::free(memory); }

/// Counts Bullet's allocations from the start of the process. Bullet frees with the functions that
/// are set at that time, and its fixed body lives for ever.
[[maybe_unused]] const bool counts_bullet = [] {
  btAlignedAllocSetCustomAligned(countingAllocate, countingFree);
  return true;
}();

/// Counts Bullet's allocations while a cube touches, slides and tips on a floor, after one warm-up.
int countWhileSliding(test::ObstacleScene& scene) {
  scene.start(Vec3(0, test::ObstacleScene::kHalf, 0));
  const RigidState start = scene.state;
  Island island = scene.makeIsland(1.0 / 4000.0);
  island.setExternalWrench(0, test::ObstacleScene::kMass * Vec3(5, -9.81, 1), Vec3::Zero());
  const auto play = [&] {
    for (const double lift : {0.0, 0.01}) {
      scene.state = start;
      scene.state.p_W.y() += lift;
      scene.state.w_W = Vec3(0, 0, 50 * lift);
      island.setState(0, scene.state);
      for (int i = 0; i < 400; ++i) island.advance(1.0 / 4000.0);
    }
  };
  play();  // warm-up
  EXPECT_GT(scene.obstacles.searches() + scene.obstacles.frozenSearches(), 400u);
  EXPECT_GT(scene.obstacles.searches(), 5u);
  allocations = 0;
  play();
  return allocations;
}

TEST(ObstacleMemory, SeesAllocations) {
  allocations = 0;
  btAlignedFree(btAlignedAlloc(64, 16));
  EXPECT_EQ(allocations, 1);
}

TEST(ObstacleMemory, PlaneContactDoesNotAllocateAfterWarmUp) {
  test::ObstacleScene scene;
  scene.addPlane(0.3);
  EXPECT_EQ(countWhileSliding(scene), 0);
}

TEST(ObstacleMemory, BoxContactDoesNotAllocateAfterWarmUp) {
  test::ObstacleScene scene;
  scene.addBoxFloor(0.3);
  EXPECT_EQ(countWhileSliding(scene), 0);
}

TEST(ObstacleMemory, MeshContactDoesNotAllocateAfterWarmUp) {
  btTriangleMesh triangles;
  triangles.addTriangle(btVector3(-1, 0, -1), btVector3(-1, 0, 1), btVector3(1, 0, 1));
  triangles.addTriangle(btVector3(-1, 0, -1), btVector3(1, 0, 1), btVector3(1, 0, -1));
  test::ObstacleScene scene;
  scene.addObstacle(scene.rig.makeShape<btBvhTriangleMeshShape>(&triangles, true), 0.3);
  EXPECT_EQ(countWhileSliding(scene), 0);
}

}  // namespace
}  // namespace tandem
