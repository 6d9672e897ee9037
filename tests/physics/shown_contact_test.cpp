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

/// Sums of normal impulses that a host's own callback sees after each sub-step.
struct Watcher {
  const BulletRig& rig;
  const btRigidBody &cube, &floor;
  std::vector<double> impulses;

  static void note(btDynamicsWorld* world, btScalar) {
    auto& self = *static_cast<Watcher*>(world->getWorldUserInfo());
    self.impulses.push_back(look(self.rig, self.cube, self.floor).impulse);
  }
};

// A body that parked between two sub-steps woke with twice its weight, and pressed as hard.
TEST(ShownContact, SubStepsEachShowTheirOwnImpulses) {
  for (const int substeps : {1, 2, 4}) {
    Scene scene;
    const double h = kDt / substeps, weight = kMass * kGravity * h;
    Watcher watcher{scene.rig, *scene.cube, *scene.floor, {}};
    scene.site.reset();
    scene.rig.world.setInternalTickCallback(&Watcher::note, &watcher);
    scene.site = std::make_unique<Site>(makeAlone(), scene.rig.world, scene.device);
    scene.id = scene.site->share(*scene.cube);
    for (int step = 0; step < 120; ++step) {
      scene.rig.world.stepSimulation(static_cast<btScalar>(kDt * (1 + 1e-6)), substeps,
                                     static_cast<btScalar>(h));
      ASSERT_EQ(watcher.impulses.size(), static_cast<std::size_t>(substeps * (step + 1)));
      if (step < 30) continue;
      const double seen = look(scene.rig, *scene.cube, *scene.floor).impulse;
      EXPECT_NEAR(seen, weight, 0.01 * weight) << substeps << " sub-steps, step " << step;
    }
    for (std::size_t i = 30; i < watcher.impulses.size(); ++i)
      EXPECT_NEAR(watcher.impulses[i], weight, 0.01 * weight) << substeps << " sub-steps, " << i;
    EXPECT_EQ(scene.site->counters().bodies_woken, 0u) << substeps << " sub-steps";
    EXPECT_GT(scene.site->counters().host_steps_skipped, 0u) << substeps << " sub-steps";
  }
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

/// Points that a host's own query finds.
struct Query final : btCollisionWorld::ContactResultCallback {
  std::vector<double> distances;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    distances.push_back(static_cast<double>(point.getDistance()));
    return 0;
  }
};

/// A body on a floor, and what Bullet's queries say of the two.
struct Asked {
  BulletRig rig{Vec3(0.0, 0.0, -kGravity)};
  btRigidBody *floor, *body;

  Asked(int shape, bool has_plane)
      : floor(has_plane ? &rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), 0), 0)
                        : &rig.addBody(rig.makeShape<btBoxShape>(btVector3(1, 1, btScalar(0.1))), 0,
                                       Vec3(0.0, 0.0, -0.1))),
        body(&rig.addBody(makeShape(shape), kMass, Vec3(0.0, 0.0, kHalf))) {
    body->setActivationState(DISABLE_DEACTIVATION);  // Bullet finds no sleeper on a plane
  }
  btCollisionShape& makeShape(int shape) {
    const btVector3 half = btVector3(1, 1, 1) * static_cast<btScalar>(kHalf);
    if (shape == 0) return rig.makeShape<btBoxShape>(half);
    if (shape == 1) return rig.makeShape<btSphereShape>(half.x());
    if (shape == 2) return rig.makeShape<btCylinderShapeZ>(half);
    if (shape == 3) {
      auto& compound = rig.makeShape<btCompoundShape>();
      compound.addChildShape(btTransform::getIdentity(), &rig.makeShape<btBoxShape>(half));
      return compound;
    }
    auto& hull = rig.makeShape<btConvexHullShape>();
    for (int i = 0; i < 8; ++i)
      hull.addPoint(toBullet(kHalf * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    hull.setMargin(0);
    return hull;
  }
  [[nodiscard]] std::vector<double> testAll() {
    Query query;
    rig.world.contactTest(body, query);
    return query.distances;
  }
  [[nodiscard]] std::vector<double> testPair(bool is_swapped, double reach) {
    Query query;
    query.m_closestDistanceThreshold = static_cast<btScalar>(reach);
    rig.world.contactPairTest(is_swapped ? floor : body, is_swapped ? body : floor, query);
    return query.distances;
  }
};

void expectSame(const std::vector<double>& seen, const std::vector<double>& expected) {
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_NEAR(seen[i], expected[i], test::byWidth(1e-12, 1e-7));
}

// Bullet's algorithms for planes, and for boxes in compounds, refuse a pair that is filtered.
TEST(ShownContact, QueriesSeeASharedBodyAsBulletDoes) {
  for (int shape = 0; shape < 5; ++shape) {
    for (const bool has_plane : {false, true}) {
      SCOPED_TRACE(testing::Message() << "shape " << shape << ", plane " << has_plane);
      Asked shared(shape, has_plane), bare(shape, has_plane);
      test::FakeDevice device(Vec3(-1.0, 0.0, 0.5));
      auto site = std::make_unique<Site>(makeAlone(), shared.rig.world, device);
      (void)site->share(*shared.body);
      for (const int steps : {10, 170}) {
        for (int step = 0; step < steps; ++step) shared.rig.step(kDt);
        for (const double way : {0.0, -1e-5, 1e-5}) {
          const btTransform pose = shared.body->getWorldTransform();
          shared.body->translate(btVector3(0, 0, static_cast<btScalar>(way)));
          bare.body->setWorldTransform(shared.body->getWorldTransform());
          bare.rig.world.updateAabbs();
          expectSame(shared.testAll(), bare.testAll());
          for (const bool is_swapped : {false, true})
            for (const double reach : {0.0, 1e-3})
              expectSame(shared.testPair(is_swapped, reach), bare.testPair(is_swapped, reach));
          EXPECT_GT(shared.testPair(false, 1e-3).size(), 0u);
          shared.body->setWorldTransform(pose);
        }
      }
      const int manifolds = shared.rig.dispatcher.getNumManifolds();
      (void)shared.testAll();
      EXPECT_EQ(shared.rig.dispatcher.getNumManifolds(), manifolds);
      site.reset();
      bare.body->setWorldTransform(shared.body->getWorldTransform());
      expectSame(shared.testAll(), bare.testAll());
    }
  }
}

// A host's queries do not find on a plane what it filters itself: as without a site.
TEST(ShownContact, QueriesDoNotSeeAPairThatTheHostIgnores) {
  Asked shared(0, true);
  test::FakeDevice device(Vec3(-1.0, 0.0, 0.5));
  Site site(makeAlone(), shared.rig.world, device);
  (void)site.share(*shared.body);
  for (int step = 0; step < 2; ++step) shared.rig.step(kDt);  // it is not parked yet
  shared.floor->setIgnoreCollisionCheck(shared.body, true);
  shared.rig.step(kDt);
  EXPECT_TRUE(shared.testAll().empty());
  shared.floor->setIgnoreCollisionCheck(shared.body, false);
}

// The dispatcher's functions are the host's again at the end, in whatever order sites end.
TEST(ShownContact, TheDispatchersFunctionsAreBackAtTheEnd) {
  struct Functions : btCollisionDispatcher {
    static std::vector<btCollisionAlgorithmCreateFunc*> of(btCollisionDispatcher& dispatcher) {
      auto& contact = dispatcher.*(&Functions::m_doubleDispatchContactPoints);
      auto& closest = dispatcher.*(&Functions::m_doubleDispatchClosestPoints);
      std::vector<btCollisionAlgorithmCreateFunc*> all;
      for (int i = 0; i < MAX_BROADPHASE_COLLISION_TYPES; ++i)
        for (int j = 0; j < MAX_BROADPHASE_COLLISION_TYPES; ++j)
          all.insert(all.end(), {contact[i][j], closest[i][j]});
      return all;
    }
  };
  Asked first(0, true);
  btDbvtBroadphase broadphase;
  btDiscreteDynamicsWorld world(&first.rig.dispatcher, &broadphase, &first.rig.solver,
                                &first.rig.configuration);
  btRigidBody cube(static_cast<btScalar>(kMass), nullptr, first.body->getCollisionShape());
  btRigidBody floor(0, nullptr, first.floor->getCollisionShape());
  cube.setWorldTransform(toBullet(Vec3(0.0, 0.0, kHalf), Quat::Identity()));
  world.addRigidBody(&cube);
  world.addRigidBody(&floor);
  const auto before = Functions::of(first.rig.dispatcher);
  test::FakeDevice device(Vec3(-1.0, 0.0, 0.5));
  for (const bool first_ends_first : {false, true}) {
    auto site = std::make_unique<Site>(makeAlone(), first.rig.world, device);
    auto other = std::make_unique<Site>(makeAlone(), world, device);
    (void)site->share(*first.body);
    (void)other->share(cube);
    for (int step = 0; step < 10; ++step) {
      first.rig.step(kDt);
      world.stepSimulation(static_cast<btScalar>(kDt), 0);
    }
    EXPECT_NE(Functions::of(first.rig.dispatcher), before);
    (first_ends_first ? site : other).reset();
    if (!first_ends_first) {
      EXPECT_FALSE(first.testAll().empty());
    }
    (first_ends_first ? other : site).reset();
    EXPECT_EQ(Functions::of(first.rig.dispatcher), before);
  }
  world.removeRigidBody(&cube);
  world.removeRigidBody(&floor);
}

// An action runs within the step, before the points of the step are known.
TEST(ShownContact, ActionsSeeThePointsOfTheStepBefore) {
  struct Looker final : btActionInterface {
    explicit Looker(Scene& of) : scene(of) {}
    void updateAction(btCollisionWorld*, btScalar) override {
      seen = look(scene.rig, *scene.cube, *scene.floor);
    }
    void debugDraw(btIDebugDraw*) override {}
    Scene& scene;
    Seen seen;
  };
  Scene scene;
  Looker early(scene), late(scene);
  scene.rig.world.addAction(&early);
  for (int step = 0; step < 180; ++step) {
    scene.rig.step(kDt);
    if (step == 10) scene.rig.world.addAction(&late);
    if (step < 30) continue;
    for (const Looker* looker : {&early, &late}) {
      EXPECT_EQ(looker->seen.points, 4) << step;
      EXPECT_NEAR(looker->seen.impulse, kWeight, kExact * kWeight) << step;
    }
  }
  scene.site.reset();
  scene.rig.world.removeAction(&early);
  scene.rig.world.removeAction(&late);
}

TEST(ShownContact, ActionsOfTheHostKeepTheirOrder) {
  struct Noter final : btActionInterface {
    Noter(std::vector<int>& all, int own) : order(all), number(own) {}
    void updateAction(btCollisionWorld*, btScalar) override { order.push_back(number); }
    void debugDraw(btIDebugDraw*) override {}
    std::vector<int>& order;
    int number;
  };
  Scene scene;
  std::vector<int> order;
  std::vector<Noter> noters;
  for (int i = 0; i < 4; ++i) noters.emplace_back(order, i);
  for (int i = 0; i < 3; ++i) scene.rig.world.addAction(&noters[static_cast<std::size_t>(i)]);
  scene.run(0.2);
  scene.rig.world.addAction(&noters[3]);
  order.clear();
  scene.rig.step(kDt);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
  scene.site.reset();
  order.clear();
  scene.rig.step(kDt);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
  for (Noter& noter : noters) scene.rig.world.removeAction(&noter);
}

/// Two worlds, each with a shared cube that slides over a plane, and the places of the cubes.
std::vector<Vec3> slideInTwoWorlds(bool have_one_dispatcher) {
  struct One {
    One(btCollisionDispatcher& of, double speed) : world(&of, &broadphase, &solver, &conf) {
      world.setGravity(toBullet(Vec3(0.0, 0.0, -kGravity)));
      cube.setWorldTransform(toBullet(Vec3(0.0, 0.0, kHalf), Quat::Identity()));
      cube.setLinearVelocity(toBullet(Vec3(speed, 0.0, 0.0)));
      for (btRigidBody* body : {&cube, &floor}) world.addRigidBody(body);
      site = std::make_unique<Site>(makeAlone(), world, device);
      (void)site->share(cube);
    }
    ~One() {
      site.reset();
      for (btRigidBody* body : {&cube, &floor}) world.removeRigidBody(body);
    }
    One(const One&) = delete;
    One& operator=(const One&) = delete;

    btDefaultCollisionConfiguration conf;
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world;
    btBoxShape box{btVector3(1, 1, 1) * static_cast<btScalar>(kHalf)};
    btStaticPlaneShape plane{btVector3(0, 0, 1), 0};
    btRigidBody cube{static_cast<btScalar>(kMass), nullptr, &box,
                     btVector3(1, 1, 1) * btScalar(5e-5)};
    btRigidBody floor{0, nullptr, &plane};
    test::FakeDevice device{Vec3(-1.0, 0.0, 0.5)};
    std::unique_ptr<Site> site;
  };
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher first(&configuration), second(&configuration);
  One ones[] = {{first, 0.5}, {have_one_dispatcher ? first : second, 1.0}};
  std::vector<Vec3> places;
  for (int step = 0; step < 120; ++step) {
    for (One& one : ones) one.world.stepSimulation(static_cast<btScalar>(kDt), 0);
    for (One& one : ones) places.push_back(fromBullet(one.cube.getCenterOfMassPosition()));
  }
  EXPECT_GT(places.back().x(), 0.05);
  EXPECT_EQ(first.getNumManifolds(), have_one_dispatcher ? 2 : 1);
  return places;
}

// Each world's solver has all manifolds of the dispatcher, also of bodies of the other world.
TEST(ShownContact, WorldsWithOneDispatcherDoNotSolveEachOthersContacts) {
  const std::vector<Vec3> alone = slideInTwoWorlds(false), together = slideInTwoWorlds(true);
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(together[i], alone[i]) << i;
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
