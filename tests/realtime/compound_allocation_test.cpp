// Bodies of many shapes cost no allocation in a tick, and only the shapes nearby cost time.

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <btBulletDynamicsCommon.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/coordination/island_counters.h"
#include "tandem/plugin/site.h"

#include "realtime/allocation_count.h"
#include "support/fakes.h"
#include "support/random.h"

namespace tandem {
namespace {

/// A bar of thirty drawn hulls along x, as a convex decomposition has them.
class Bar {
 public:
  static constexpr int kHulls = 30;
  static constexpr double kStep = 0.02;  // from hull to hull [m]

  explicit Bar(std::uint64_t seed) {
    test::Random random(seed);
    for (int i = 0; i < kHulls; ++i) {
      auto hull = std::make_unique<btConvexHullShape>();
      hull->setMargin(btScalar(0.0005));
      const Vec3 middle(kStep * (i - 0.5 * kHulls), 0.0, 0.0);
      for (int k = 0; k < 24; ++k)
        hull->addPoint(toBullet(Vec3(middle + 0.02 * random.direction())), false);
      hull->recalcLocalAabb();
      compound.addChildShape(btTransform::getIdentity(), hull.get());
      hulls_.push_back(std::move(hull));
    }
  }
  btCompoundShape compound;

 private:
  std::vector<std::unique_ptr<btConvexHullShape>> hulls_;
};

TEST(CompoundAllocation, NoneWhileAHandMovesAlongThirtyHulls) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  world.setGravity(btVector3(0, 0, 0));
  const Bar bar(1), other(2);
  const btVector3 inertia(btScalar(1e-2), btScalar(1e-2), btScalar(1e-2));
  btRigidBody shared(btScalar(1), nullptr, const_cast<btCompoundShape*>(&bar.compound), inertia);
  btRigidBody near(btScalar(1), nullptr, const_cast<btCompoundShape*>(&other.compound), inertia);
  near.setWorldTransform(toBullet(Vec3(0.05, 0.0, 0.06), Quat::Identity()));
  for (btRigidBody* body : {&shared, &near}) world.addRigidBody(body);
  test::FakeDevice device(Vec3(-0.3, 0.02, 0.03));
  std::size_t in_ticks = 0;
  std::uint64_t searches = 0, skipped = 0;
  {
    SiteSettings settings;
    settings.peers = 1;
    settings.tick_source = TickSource::kCaller;
    settings.contact = {2000.0, 2.0};
    Site site(settings, world, device);
    site.share(shared);
    for (int tick = 0; tick < 4000; ++tick) {
      const double t = 1e-3 * tick;
      device.sample.hip = {Vec3(-0.3 * std::cos(t), 0.02, 0.03 + 0.01 * std::sin(9.0 * t)),
                           Vec3(0.3 * std::sin(t), 0.0, 0.09 * std::cos(9.0 * t))};
      {
        const test::AllocationCount count;
        static_cast<void>(site.tick(t));
        if (tick >= 400) in_ticks += count.count();
      }
      if (tick % 4 == 3) world.stepSimulation(btScalar(4e-3), 0);
    }
    searches = site.islandCounters().contact_searches;
    skipped = site.islandCounters().contact_searches_skipped;
    EXPECT_GT(site.neighbourCount(), 0);
  }
  EXPECT_EQ(in_ticks, 0u);
  EXPECT_GT(searches, 1000u) << "the hand has met the hulls";
  EXPECT_LT(searches, 4000u * 8u) << "but looks at few of sixty in a tick";
  EXPECT_GT(skipped, searches);
  for (btRigidBody* body : {&shared, &near}) world.removeRigidBody(body);
}

}  // namespace
}  // namespace tandem
