// A host may destroy its world before the site attached to it. The sanitizer detects late accesses
// and leaks.

#include <memory>
#include <new>
#include <string>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>

#include "tandem/plugin/site.h"

#include "host/any_host.h"
#include "host/body_bits.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::FakeDevice;
using test::FakeLink;
using test::makePacket;
using test::WorldKind;

constexpr PeerId kRemote{2};
constexpr double kPeriod = 1e-3;      // period of a tick [s]
constexpr double kStep = 1.0 / 60.0;  // step of the host [s]

std::string allOf(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// A hand presses a shared cube, beside boxes that the island holds and a remote user's proxy.
struct PressedCube {
  explicit PressedCube(WorldKind kind, ContactModel model = ContactModel::kIsland)
      : host(std::make_unique<AnyHost>(kind, Vec3(0.0, 0.0, -9.81))) {
    host->addBody(host->makeBox(Vec3(1.0, 1.0, 0.1)), 0.0, Vec3(0.0, 0.0, -0.12));
    cube = &host->addCube(0.2);
    cube->setDamping(btScalar(0.1), btScalar(0.2));
    box = &host->addCube(0.1, Vec3(0.041, 0.0, 0.0));
    for (btRigidBody* body : {cube, box}) before.push_back(test::readSettings(*body));
    settings.contact_model = model;
    settings.tick_source = TickSource::kCaller;
    site = std::make_unique<Site>(settings, *host->world, device);
    site->share(*cube);
    site->connect(kRemote, link, Vec3(0.0, 0.031, 0.0));
    run(4);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      while (static_cast<double>(ticks) * kPeriod < (i + 1 + steps_done) * kStep) tick();
      host->step(kStep);
    }
    steps_done += steps;
  }
  std::uint32_t tick() { return site->tick(static_cast<double>(ticks++) * kPeriod); }

  std::unique_ptr<AnyHost> host;
  btRigidBody* cube = nullptr;
  btRigidBody* box = nullptr;
  std::vector<std::vector<btScalar>> before;
  FakeDevice device{Vec3(-0.0295, 0.0, 0.0)};
  FakeLink link;
  SiteSettings settings;
  std::unique_ptr<Site> site;
  int ticks = 0, steps_done = 0;
};

class WorldEnd : public ::testing::TestWithParam<WorldKind> {};

TEST_P(WorldEnd, GivesTheBodiesBackAndLetsTheHandGo) {
  PressedCube scene(GetParam());
  Site& site = *scene.site;
  ASSERT_EQ(site.status(), kTickOk);
  scene.device.sample.hip.p_W = site.object(0).p_W - Vec3(0.028, 0.0, 0.0);
  scene.tick();
  ASSERT_GT(site.force().norm(), 2.0);
  ASSERT_EQ(site.neighbourCount(), 1);
  const RigidState last = site.object(0);

  scene.host->world.reset();
  EXPECT_EQ(scene.before[0], test::readSettings(*scene.cube));
  EXPECT_EQ(scene.before[1], test::readSettings(*scene.box));
  EXPECT_EQ(scene.host->broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
  EXPECT_EQ(site.status(), kWorldGone);
  scene.host.reset();

  // The force falls by 2 N a tick.
  double force = site.force().norm();
  while (force > 0.0) {
    EXPECT_EQ(scene.tick(), kWorldGone);
    EXPECT_NEAR(site.force().norm(), std::max(0.0, force - 2.0), 1e-9);
    force = site.force().norm();
  }
  for (int i = 0; i < 100; ++i) EXPECT_EQ(scene.tick(), kWorldGone);
  EXPECT_EQ(scene.device.force_W, Vec3::Zero());
  EXPECT_EQ(site.object(0).p_W, last.p_W);
  EXPECT_EQ(site.proxyBody(0), nullptr);
  EXPECT_EQ(site.neighbourCount(), 0);
}

TEST_P(WorldEnd, IsSaidInWords) {
  PressedCube scene(GetParam());
  EXPECT_EQ(allOf(scene.site->warnings()).find("destroyed"), std::string::npos);
  scene.host->world.reset();
  EXPECT_NE(allOf(scene.site->warnings()).find("destroy a Site before its world"),
            std::string::npos);
  // Warnings about the destroyed bodies are still available.
  EXPECT_NE(allOf(scene.site->warnings()).find("damping"), std::string::npos);
  try {
    scene.site->share(*scene.cube);
    ADD_FAILURE() << "shared without a world";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("has been destroyed"), std::string::npos);
  }
  EXPECT_THROW(scene.site->connect(PeerId{3}, scene.link, Vec3::Zero()), Error);
}

// Bullet's examples end so: they delete every object in the world, then the world.
TEST_P(WorldEnd, HostMayDeleteAllThatIsInItsWorldFirst) {
  PressedCube scene(GetParam());
  btDiscreteDynamicsWorld& world = *scene.host->world;
  for (auto& body : scene.host->bodies) body.release();
  for (int i = world.getNumCollisionObjects(); i-- > 0;) {
    btCollisionObject* object = world.getCollisionObjectArray()[i];
    world.removeCollisionObject(object);
    delete object;
  }
  scene.host->bodies.clear();
  EXPECT_EQ(scene.site->proxyBody(0), nullptr);
  scene.tick();
  scene.host->world.reset();
  EXPECT_TRUE(scene.site->status() & kWorldGone);
  for (int i = 0; i < 10; ++i) scene.tick();
  EXPECT_EQ(scene.site->force(), Vec3::Zero());
}

TEST_P(WorldEnd, AfterASiteLeavesTheWorldAsItWas) {
  AnyHost host(GetParam());
  FakeDevice device;
  btSimulationIslandManager* own = host.world->getSimulationIslandManager();
  own->setSplitIslands(false);
  {
    const Site site({}, *host.world, device);
    btSimulationIslandManager* other = host.world->getSimulationIslandManager();
    ASSERT_NE(other, own);
    EXPECT_FALSE(other->getSplitIslands());
    // A host may set it through either manager.
    other->setSplitIslands(true);
    host.step(kStep);
    EXPECT_TRUE(own->getSplitIslands());
    own->setSplitIslands(false);
    host.step(kStep);
    EXPECT_FALSE(other->getSplitIslands());
    other->setSplitIslands(true);
  }
  EXPECT_EQ(host.world->getSimulationIslandManager(), own);
  EXPECT_TRUE(own->getSplitIslands());
}

INSTANTIATE_TEST_SUITE_P(Kinds, WorldEnd, ::testing::ValuesIn(test::kAllKinds),
                         [](const auto& kind) { return test::nameOf(kind.param); });

TEST(WorldEndsEarly, GivesNativeModelsBack) {
  for (const ContactModel model : {ContactModel::kNativeRigid, ContactModel::kNativeSoft,
                                   ContactModel::kSpring6Dof, ContactModel::kPointToPoint}) {
    PressedCube scene(WorldKind::kDiscrete, model);
    scene.host->world.reset();
    EXPECT_EQ(scene.before[0], test::readSettings(*scene.cube));
    scene.host.reset();
    for (int i = 0; i < 20; ++i) EXPECT_EQ(scene.tick(), kWorldGone);
    EXPECT_EQ(scene.site->force(), Vec3::Zero());
  }
}

// A world of multi-bodies loses these first, before it is known to end.
TEST(WorldEndsEarly, LetsTheLinksOfAnArmGo) {
  AnyHost host(WorldKind::kMultiBody);
  host.addMultiBody(Vec3::Zero());
  FakeDevice device{Vec3(0.0, 0.0, 0.03)};
  Site site({}, *host.world, device);
  for (int i = 0; i < 5; ++i) host.world->stepSimulation(btScalar(1.0 / 60.0), 0);
  ASSERT_EQ(site.neighbourCount(), 2);
  host.world.reset();
  EXPECT_TRUE(site.status() & kWorldGone);
  EXPECT_EQ(site.neighbourCount(), 0);
  EXPECT_EQ(host.multi_body->getMaxCoordinateVelocity(), btScalar(100));
}

TEST(WorldEndsEarly, TakesNothingFromAWorldAtTheSameAddress) {
  FakeDevice device;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  alignas(btDiscreteDynamicsWorld) std::byte memory[sizeof(btDiscreteDynamicsWorld)];
  const auto make = [&] {
    return new (memory) btDiscreteDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration);
  };
  auto* world = make();
  auto first = std::make_unique<Site>(SiteSettings{}, *world, device);
  world->~btDiscreteDynamicsWorld();
  world = make();
  const Site second({}, *world, device);
  first.reset();
  world->stepSimulation(btScalar(kStep), 0);
  EXPECT_EQ(second.counters().host_steps, 1u);
  world->~btDiscreteDynamicsWorld();
}

/// Another plugin that installs its own island manager on top, as we do, and leaves at any time.
struct OnTop {
  struct Manager final : btSimulationIslandManager {};
  struct Slot : btDiscreteDynamicsWorld {
    static btSimulationIslandManager*& of(btDiscreteDynamicsWorld& world) {
      return world.*(&Slot::m_islandManager);
    }
  };
  explicit OnTop(btDiscreteDynamicsWorld& host) : world(host), below(Slot::of(host)) {
    Slot::of(world) = new (btAlignedAlloc(sizeof(Manager), 16)) Manager;
  }
  ~OnTop() {
    btSimulationIslandManager* own = Slot::of(world);
    Slot::of(world) = below;
    own->~btSimulationIslandManager();
    btAlignedFree(own);
  }
  btDiscreteDynamicsWorld& world;
  btSimulationIslandManager* below;
};

TEST(WorldEndsEarly, AnotherManagerOnTopMayLeaveBeforeOrAfter) {
  FakeDevice device;
  for (const bool leaves_first : {true, false}) {
    AnyHost host(WorldKind::kDiscrete);
    auto site = std::make_unique<Site>(SiteSettings{}, *host.world, device);
    auto on_top = std::make_unique<OnTop>(*host.world);
    host.step(kStep);
    if (leaves_first) on_top.reset();
    site.reset();
    on_top.reset();
    host.step(kStep);
    const Site again({}, *host.world, device);
    host.step(kStep);
    EXPECT_EQ(again.counters().host_steps, 1u);
  }
}

TEST(WorldEndsEarly, WarnsWhereItCouldNotBeNoticed) {
  AnyHost host(WorldKind::kDiscrete);
  const OnTop own(*host.world);
  FakeDevice device;
  const Site site({}, *host.world, device);
  host.step(kStep);
  EXPECT_NE(allOf(site.warnings()).find("its end cannot be noticed"), std::string::npos);
}

}  // namespace
}  // namespace tandem
