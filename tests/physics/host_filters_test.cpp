// Hosts decide by code of their own which bodies touch: the island asks it, and heeds the answer.

#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

constexpr double kHalf = 0.02;  // [m]
const btVector3 kWeight(0, 0, btScalar(-9.81));

/// A host hides a pair by one of these.
enum class Way { kCollision, kResponse, kOverlap, kNear };

/// A pair that must not touch, in all ways in which a host may say so.
struct Gate {
  Way way = Way::kCollision;
  const btCollisionObject *one = nullptr, *other = nullptr;
  bool is_shut = false;

  [[nodiscard]] bool hides(Way by, const void* a, const void* b) {
    return is_shut && by == way && ((a == one && b == other) || (a == other && b == one));
  }
};

struct GateDispatcher final : btCollisionDispatcher {
  GateDispatcher(btCollisionConfiguration* configuration, Gate& its)
      : btCollisionDispatcher(configuration), gate(its) {}
  bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override {
    return !gate.hides(Way::kCollision, a, b) && btCollisionDispatcher::needsCollision(a, b);
  }
  bool needsResponse(const btCollisionObject* a, const btCollisionObject* b) override {
    return !gate.hides(Way::kResponse, a, b) && btCollisionDispatcher::needsResponse(a, b);
  }
  Gate& gate;
};

struct GateFilter final : btOverlapFilterCallback {
  explicit GateFilter(Gate& its) : gate(its) {}
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    return !gate.hides(Way::kOverlap, a->m_clientObject, b->m_clientObject) &&
           (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
           (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0;
  }
  Gate& gate;
};

Gate* gate_of_near_callback = nullptr;

void passGate(btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
              const btDispatcherInfo& info) {
  if (gate_of_near_callback->hides(Way::kNear, pair.m_pProxy0->m_clientObject,
                                   pair.m_pProxy1->m_clientObject))
    return;
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
}

/// A shared cube and a box of the host above a floor, which the cube may be hidden from.
class GateHost {
 public:
  GateHost(Way way, bool is_shut, double height) {
    world.setGravity(kWeight);
    gate.way = way;
    gate.is_shut = is_shut;
    gate.one = &add(btVector3(2, 2, btScalar(0.1)), 0.0, Vec3(0.0, 0.0, -0.1));
    const btVector3 half = toBullet(Vec3::Constant(kHalf));
    cube = &add(half, 0.2, Vec3(0.0, 0.0, height));
    box = &add(half, 0.2, Vec3(0.0, 0.045, kHalf));
    gate.other = cube;
    if (way == Way::kOverlap) world.getPairCache()->setOverlapFilterCallback(&filter);
    if (way == Way::kNear) {
      gate_of_near_callback = &gate;
      dispatcher->setNearCallback(&passGate);
    }
    SiteSettings settings;
    settings.contact = {2000.0, 10.0};
    settings.coordination = {0.0, 0.0};
    site = std::make_unique<Site>(settings, world, device);
    site->share(*cube);
  }
  ~GateHost() {
    site.reset();
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }
  GateHost(const GateHost&) = delete;
  GateHost& operator=(const GateHost&) = delete;

  void run(double duration) {
    for (int i = 0; i < static_cast<int>(duration * 60.0 + 0.5); ++i)
      world.stepSimulation(btScalar(1.0 / 60.0), 0);
  }
  static double z(const btRigidBody& body) {
    return static_cast<double>(body.getCenterOfMassPosition().z());
  }

  Gate gate;
  btDefaultCollisionConfiguration configuration;
  std::unique_ptr<btCollisionDispatcher> dispatcher = makeDispatcher();
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  GateFilter filter{gate};
  btDiscreteDynamicsWorld world{dispatcher.get(), &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  test::FakeDevice device{Vec3(0.0, 0.0, 10.0)};
  btRigidBody *cube = nullptr, *box = nullptr;
  std::unique_ptr<Site> site;

 private:
  std::unique_ptr<btCollisionDispatcher> makeDispatcher() {
    return std::make_unique<GateDispatcher>(&configuration, gate);
  }
  btRigidBody& add(const btVector3& half, double mass, const Vec3& p_W) {
    shapes.push_back(std::make_unique<btBoxShape>(half));
    btVector3 inertia(0, 0, 0);
    if (mass > 0.0) shapes.back()->calculateLocalInertia(btScalar(mass), inertia);
    bodies.push_back(
        std::make_unique<btRigidBody>(btScalar(mass), nullptr, shapes.back().get(), inertia));
    bodies.back()->setCenterOfMassTransform(toBullet(p_W, Quat::Identity()));
    world.addRigidBody(bodies.back().get());
    return *bodies.back();
  }
};

constexpr Way kAllWays[] = {Way::kCollision, Way::kResponse, Way::kOverlap, Way::kNear};

TEST(HostFilters, ABodyFallsThroughAFloorThatIsHiddenFromIt) {
  for (const Way way : kAllWays) {
    GateHost host(way, true, 0.1);
    host.run(0.5);
    EXPECT_LT(GateHost::z(*host.cube), -0.5) << static_cast<int>(way);
    EXPECT_NEAR(GateHost::z(*host.box), kHalf, 2e-3) << static_cast<int>(way);
  }
}

TEST(HostFilters, ABodyStandsOnAFloorThatIsNot) {
  for (const Way way : kAllWays) {
    GateHost host(way, false, kHalf);
    host.run(1.0);
    EXPECT_NEAR(GateHost::z(*host.cube), kHalf, way == Way::kNear ? 2e-3 : 1e-5)
        << static_cast<int>(way);
  }
}

// Bullet keeps pairs that its overlap filter once let in, and asks all others in each step.
TEST(HostFilters, TheAnswerMayChange) {
  for (const Way way : {Way::kCollision, Way::kResponse, Way::kNear}) {
    SCOPED_TRACE(static_cast<int>(way));
    GateHost host(way, true, 0.3);
    host.run(0.1);
    host.gate.is_shut = false;
    host.run(1.0);
    EXPECT_NEAR(GateHost::z(*host.cube), kHalf, 2e-3);
    if (way == Way::kNear) continue;  // Bullet goes on with the points that it has
    host.gate.is_shut = true;
    host.cube->activate(true);
    host.run(0.5);
    EXPECT_LT(GateHost::z(*host.cube), -0.5);
  }
}

TEST(HostFilters, ANearCallbackIsHeededFromTheNextStepOn) {
  GateHost host(Way::kNear, false, kHalf);
  host.dispatcher->setNearCallback(&btCollisionDispatcher::defaultNearCallback);
  host.run(0.5);
  const auto isSaid = [&] {
    for (const std::string& line : host.site->warnings())
      if (line.find("near callback") != std::string::npos) return true;
    return false;
  };
  EXPECT_FALSE(isSaid());
  EXPECT_NEAR(GateHost::z(*host.cube), kHalf, 1e-5);
  host.dispatcher->setNearCallback(&passGate);
  EXPECT_TRUE(isSaid());
  host.gate.is_shut = true;
  host.cube->activate(true);
  host.run(0.5);
  EXPECT_LT(GateHost::z(*host.cube), -0.5);
}

TEST(HostFilters, AllFiltersOfOursAreGoneAtTheEnd) {
  GateHost host(Way::kCollision, true, 0.1);
  host.run(0.2);
  host.gate.is_shut = false;
  host.run(0.1);
  host.site.reset();
  for (const auto& body : host.bodies) EXPECT_EQ(body->getNumObjectsWithoutCollision(), 0);
}

/// A dispatcher that lets everything collide, ignored or not.
struct Deaf final : btCollisionDispatcher {
  using btCollisionDispatcher::btCollisionDispatcher;
  bool needsCollision(const btCollisionObject*, const btCollisionObject*) override { return true; }
};

TEST(HostFilters, ADispatcherThatMindsNoFilterKeepsItsContact) {
  btDefaultCollisionConfiguration configuration;
  Deaf dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(kWeight);
  btBoxShape shape(toBullet(Vec3::Constant(kHalf))), ground(btVector3(2, 2, btScalar(0.1)));
  btVector3 inertia;
  shape.calculateLocalInertia(btScalar(0.2), inertia);
  btRigidBody cube(btScalar(0.2), nullptr, &shape, inertia), floor(0, nullptr, &ground);
  cube.setCenterOfMassTransform(toBullet(Vec3(0.0, 0.0, kHalf), Quat::Identity()));
  floor.setCenterOfMassTransform(toBullet(Vec3(0.0, 0.0, -0.1), Quat::Identity()));
  cube.setRestitution(btScalar(0.5));
  floor.setRestitution(1);
  world.addRigidBody(&floor);
  world.addRigidBody(&cube);
  {
    test::FakeDevice device{Vec3(0.0, 0.0, 10.0)};
    Site site({}, world, device);
    site.share(cube);
    for (int i = 0; i < 60; ++i) world.stepSimulation(btScalar(1.0 / 60.0), 0);
    EXPECT_NEAR(GateHost::z(cube), kHalf, 2e-3);
    EXPECT_EQ(cube.getNumObjectsWithoutCollision(), 0);
    EXPECT_EQ(floor.getNumObjectsWithoutCollision(), 0);
  }
  world.removeRigidBody(&cube);
  world.removeRigidBody(&floor);
}

}  // namespace
}  // namespace tandem
