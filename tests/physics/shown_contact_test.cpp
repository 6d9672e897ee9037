// The host sees the contacts that the island decides, as it sees Bullet's own.

#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;

constexpr double kMass = 0.2, kHalf = 0.02, kGravity = 9.81, kDt = 1.0 / 60.0;

int started = 0, ended = 0, processed = 0, destroyed = 0;
std::thread::id called_in;

struct Callbacks {
  Callbacks() {
    started = ended = processed = destroyed = 0;
    gContactStartedCallback = [](btPersistentManifold* const&) { ++started; };
    gContactEndedCallback = [](btPersistentManifold* const&) { ++ended; };
    gContactProcessedCallback = [](btManifoldPoint& point, void*, void*) {
      point.m_userPersistentData = &processed;
      called_in = std::this_thread::get_id();
      return ++processed > 0;
    };
    gContactDestroyedCallback = [](void* data) { return data == &processed && ++destroyed > 0; };
  }
  ~Callbacks() {
    gContactStartedCallback = nullptr;
    gContactEndedCallback = nullptr;
    gContactProcessedCallback = nullptr;
    gContactDestroyedCallback = nullptr;
  }
  Callbacks(const Callbacks&) = delete;
  Callbacks& operator=(const Callbacks&) = delete;
};

/// Points and impulses between two objects, as a host reads them.
struct Seen {
  int points = 0;
  double impulse = 0.0;       // normal, on the first [N s]
  Vec3 sum_W = Vec3::Zero();  // with friction, on the first [N s]
};

Seen look(const BulletRig& rig, const btCollisionObject& first, const btCollisionObject& second) {
  Seen seen;
  const btDispatcher& dispatcher = rig.dispatcher;
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold =
        *const_cast<btDispatcher&>(dispatcher).getManifoldByIndexInternal(m);
    EXPECT_EQ(manifold.m_index1a, m);
    const bool is_swapped = manifold.getBody0() == &second && manifold.getBody1() == &first;
    if (!is_swapped && (manifold.getBody0() != &first || manifold.getBody1() != &second)) continue;
    const double side = is_swapped ? -1.0 : 1.0;
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      ++seen.points;
      seen.impulse += static_cast<double>(point.m_appliedImpulse);
      seen.sum_W += side * fromBullet(point.m_normalWorldOnB * point.m_appliedImpulse +
                                      point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                                      point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2);
      EXPECT_NEAR(static_cast<double>(point.getDistance()), 0.0, 1e-3);
    }
  }
  return seen;
}

/// The whole object is ours, so that its weight is that of its mass.
SiteSettings makeAlone() {
  SiteSettings settings;
  settings.peers = 1;
  return settings;
}

/// A shared cube on a plane, and a hand that is far away.
struct Scene {
  explicit Scene(double height = kHalf) : rig(Vec3(0.0, 0.0, -kGravity)) {
    floor = &rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0.0);
    cube = &rig.addCube(kMass, kHalf, Vec3(0.0, 0.0, height));
    site = std::make_unique<Site>(makeAlone(), rig.world, device);
    id = site->share(*cube);
  }
  void run(double seconds) {
    for (double t = 0.0; t < seconds - 0.5 * kDt; t += kDt) rig.step(kDt);
  }

  BulletRig rig;
  btRigidBody *floor, *cube;
  test::FakeDevice device{Vec3(-1.0, 0.0, 0.1)};
  std::unique_ptr<Site> site;
  ObjectId id;
};

constexpr double kWeight = kMass * kGravity * kDt;
/// Relative to the weight of a step.
const double kExact = test::byWidth(1e-6, 1e-5);

TEST(ShownContact, ACubeAtRestHasFourPointsThatCarryItsWeight) {
  Scene scene;
  for (int step = 0; step < 180; ++step) {
    scene.rig.step(kDt);
    if (step < 30) continue;
    const Seen seen = look(scene.rig, *scene.cube, *scene.floor);
    EXPECT_EQ(seen.points, 4) << step;
    EXPECT_NEAR(seen.impulse, kWeight, kExact * kWeight) << step;
    EXPECT_NEAR(seen.sum_W.z(), kWeight, kExact * kWeight) << step;
  }
  EXPECT_GT(scene.site->counters().host_steps_skipped, 0u) << "the cube was to be parked";
}

TEST(ShownContact, AFallShowsTheWholeImpulse) {
  Scene scene(kHalf + 0.05);
  double sum = 0.0;
  for (int step = 0; step < 60; ++step) {
    scene.rig.step(kDt);
    sum += look(scene.rig, *scene.cube, *scene.floor).impulse;
  }
  EXPECT_NEAR(sum, 60 * kWeight, 0.01 * kWeight) << "it has no momentum in the end";
}

TEST(ShownContact, PressedByTheHandTheFloorCarriesMore) {
  Scene scene;
  scene.run(0.5);
  scene.device.sample.hip.p_W = Vec3(0.0, 0.0, 2.0 * kHalf + 0.0099);
  scene.run(1.0);
  const Seen seen = look(scene.rig, *scene.cube, *scene.floor);
  EXPECT_GT(scene.site->force().norm(), 0.05);
  EXPECT_NEAR(seen.impulse, kWeight + scene.site->force().norm() * kDt, 1e-3 * kWeight);
}

TEST(ShownContact, ASlopeShowsFriction) {
  BulletRig rig(Vec3(1.0, 0.0, -kGravity));
  btRigidBody& floor = rig.addBody(rig.makeShape<btBoxShape>(btVector3(1, 1, btScalar(0.1))), 0.0,
                                   Vec3(0.0, 0.0, -0.1));
  btRigidBody& cube = rig.addCube(kMass, kHalf, Vec3(0.0, 0.0, kHalf));
  test::FakeDevice device(Vec3(-1.0, 0.0, 0.5));
  Site site(makeAlone(), rig.world, device);
  (void)site.share(cube);
  for (int step = 0; step < 60; ++step) rig.step(kDt);
  const Seen seen = look(rig, cube, floor);
  EXPECT_NEAR(seen.sum_W.x(), -kMass * 1.0 * kDt, 1e-4 * kWeight);
  EXPECT_NEAR(seen.sum_W.z(), kWeight, 1e-4 * kWeight);
}

TEST(ShownContact, AStackIsSeenBodyByBody) {
  Scene scene;
  btRigidBody& upper = scene.rig.addCube(2.0 * kMass, kHalf, Vec3(0.0, 0.0, 3.0 * kHalf));
  scene.run(3.0);
  EXPECT_GT(scene.site->counters().promoted, 0u);
  EXPECT_NEAR(look(scene.rig, upper, *scene.cube).sum_W.z(), 2.0 * kWeight, 1e-4 * kWeight);
  EXPECT_NEAR(look(scene.rig, *scene.cube, *scene.floor).sum_W.z(), 3.0 * kWeight, 1e-4 * kWeight);
}

TEST(ShownContact, BulletsOwnComesBackAfterUnshare) {
  BulletRig rig(Vec3(0.0, 0.0, -kGravity));
  btRigidBody& floor = rig.addBody(rig.makeShape<btBoxShape>(btVector3(1, 1, btScalar(0.1))), 0.0,
                                   Vec3(0.0, 0.0, -0.1));
  btRigidBody& cube = rig.addCube(kMass, kHalf, Vec3(0.0, 0.0, kHalf));
  test::FakeDevice device(Vec3(-1.0, 0.0, 0.5));
  const auto run = [&](int steps) {
    for (int step = 0; step < steps; ++step) rig.step(kDt);
  };
  {
    Site site(makeAlone(), rig.world, device);
    const ObjectId id = site.share(cube);
    run(30);
    EXPECT_EQ(look(rig, cube, floor).points, 4);
    site.unshare(id);
    EXPECT_EQ(look(rig, cube, floor).points, 0);
  }
  run(30);
  EXPECT_NEAR(look(rig, cube, floor).impulse, kWeight, 0.05 * kWeight);
  EXPECT_EQ(rig.dispatcher.getNumManifolds(), 1);
}

// AddressSanitizer watches that nothing refers to the body any more.
TEST(ShownContact, AHostMayDeleteATouchingBodyBetweenSteps) {
  for (const bool is_at_rest : {false, true}) {
    Scene scene(is_at_rest ? kHalf : kHalf + 0.001);
    scene.run(is_at_rest ? 1.0 : 0.2);
    auto box =
        std::make_unique<btRigidBody>(btScalar(0.1), nullptr, scene.cube->getCollisionShape(),
                                      btVector3(1, 1, 1) * btScalar(3e-5));
    // With a gap of rounding Bullet lets it fall into the cube, and then throws it off.
    const double height = is_at_rest ? 3.0 * kHalf : 3.0 * kHalf + 1e-4;
    box->setWorldTransform(toBullet(Vec3(0.0, 0.0, height), Quat::Identity()));
    scene.rig.world.addRigidBody(box.get());
    scene.run(is_at_rest ? 1.0 : 0.1);
    EXPECT_GT(look(scene.rig, *box, *scene.cube).points, 0);
    scene.rig.world.removeRigidBody(box.get());
    EXPECT_EQ(look(scene.rig, *box, *scene.cube).points, 0);
    EXPECT_EQ(scene.rig.dispatcher.getNumManifolds(), 1);
    box.reset();
    scene.run(0.2);
    EXPECT_NEAR(look(scene.rig, *scene.cube, *scene.floor).impulse, kWeight, 1e-3 * kWeight);
  }
}

// Bullet finds a manifold that it releases by its place. A wrong one lost another body's contact.
TEST(ShownContact, PlacesAreRightAfterAHostTakesOutAndPutsBackAFarBody) {
  Scene scene;
  std::vector<btRigidBody*> far;
  for (const double x : {2.0, 4.0})
    far.push_back(&scene.rig.addBody(scene.rig.makeShape<btSphereShape>(btScalar(kHalf)), kMass,
                                     Vec3(x, 0.0, kHalf)));
  scene.run(0.2);
  scene.rig.world.removeRigidBody(far.front());
  scene.rig.world.addRigidBody(far.front());
  scene.run(0.2);
  EXPECT_EQ(look(scene.rig, *scene.cube, *scene.floor).points, 4);
  scene.rig.world.removeRigidBody(scene.cube);
  scene.run(0.2);
  for (const btRigidBody* body : far) EXPECT_GT(look(scene.rig, *body, *scene.floor).points, 0);
}

TEST(ShownContact, TheSiteLeavesNoneBehind) {
  Scene scene;
  scene.run(0.5);
  EXPECT_EQ(scene.rig.dispatcher.getNumManifolds(), 1);
  scene.site.reset();
  EXPECT_EQ(scene.rig.dispatcher.getNumManifolds(), 0);
}

TEST(ShownContact, CallbacksComeInTheHostsThread) {
  const Callbacks callbacks;
  Scene scene(kHalf + 0.01);
  scene.run(0.5);
  EXPECT_EQ(called_in, std::this_thread::get_id());
  EXPECT_EQ(started, ended + 1);
  EXPECT_GT(processed, 0);
  scene.rig.world.removeRigidBody(scene.cube);
  EXPECT_EQ(started, ended);
  EXPECT_GT(destroyed, 0);
  scene.rig.step(kDt);
  scene.rig.world.addRigidBody(scene.cube);
  scene.run(0.2);
  EXPECT_EQ(started, ended + 1);
}

// Bullet's contactTest() asks algorithms anew. Those of boxes with boxes, and of planes, do not
// work for a filtered pair.
TEST(ShownContact, ContactTestSeesASharedHull) {
  struct Counter final : btCollisionWorld::ContactResultCallback {
    int points = 0;
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      ++points;
      return 0;
    }
  };
  BulletRig rig(Vec3(0.0, 0.0, -kGravity));
  btRigidBody& floor = rig.addBody(rig.makeShape<btBoxShape>(btVector3(1, 1, btScalar(0.1))), 0.0,
                                   Vec3(0.0, 0.0, -0.1));
  auto& hull = rig.makeShape<btConvexHullShape>();
  for (int i = 0; i < 8; ++i)
    hull.addPoint(toBullet(kHalf * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  hull.setMargin(0);
  btRigidBody& body = rig.addBody(hull, kMass, Vec3(0.0, 0.0, kHalf));
  test::FakeDevice device(Vec3(-1.0, 0.0, 0.5));
  Site site(makeAlone(), rig.world, device);
  (void)site.share(body);
  for (int step = 0; step < 10; ++step) rig.step(kDt);
  Counter all, pair;
  all.m_closestDistanceThreshold = pair.m_closestDistanceThreshold = btScalar(1e-3);
  rig.world.contactTest(&body, all);
  rig.world.contactPairTest(&body, &floor, pair);
  EXPECT_GT(all.points, 0);
  EXPECT_GT(pair.points, 0);
}

// A host that looks into the broadphase's pairs, as character controllers do, sees them too.
TEST(ShownContact, PairsTellTheirManifolds) {
  Scene scene;
  scene.run(0.5);
  btBroadphasePair* pair = scene.rig.world.getPairCache()->findPair(
      scene.cube->getBroadphaseHandle(), scene.floor->getBroadphaseHandle());
  ASSERT_TRUE(pair != nullptr && pair->m_algorithm != nullptr);
  btManifoldArray manifolds;
  pair->m_algorithm->getAllContactManifolds(manifolds);
  ASSERT_EQ(manifolds.size(), 1);
  EXPECT_EQ(manifolds[0]->getNumContacts(), 4);
}

}  // namespace
}  // namespace tandem
