// Mistakes of hosts. Each gives a message or a status bit, and no freed object is touched.

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "host/any_host.h"
#include "host/body_bits.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::FakeDevice;
using test::FakeLink;
using test::WorldKind;

constexpr double kStep = 1.0 / 60.0;
constexpr PeerId kRemote{2};
const Vec3 kRemoteStart(0.0, 0.05, 0.0);

template <typename Call>
std::string refusalOf(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A host with a cube of 0.2 kg that is shared, and a remote user.
struct Scene {
  Scene() : cube(host.addCube(0.2)), before(test::readSettings(cube)) {
    site = std::make_unique<Site>(SiteSettings{}, *host.world, device);
    site->share(cube);
    site->connect(kRemote, link, kRemoteStart);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) host.step(kStep);
  }

  AnyHost host{WorldKind::kDiscrete};
  btRigidBody& cube;
  std::vector<btScalar> before;
  FakeDevice device{Vec3(-0.029, 0.0, 0.0)};
  FakeLink link;
  std::unique_ptr<Site> site;
};

// Mistakes at attach.

TEST(Misuse, AttachingTwiceIsRefusedAndLeavesTheFirstAlone) {
  Scene scene;
  const std::string message =
      refusalOf([&] { const Site second({}, *scene.host.world, scene.device); });
  EXPECT_TRUE(says(message, "attached already")) << message;
  scene.run(2);
  EXPECT_EQ(scene.site->counters().host_steps, 2u);
}

TEST(Misuse, AnotherBulletIsRefusedWithBothNamedAndTheWorldIsLeftAlone) {
  AnyHost host(WorldKind::kDiscrete);
  FakeDevice device;
  BulletAbi wrong = bulletAbiOfThisCode();
  btSimulationIslandManager* const manager = host.world->getSimulationIslandManager();
  wrong.scalar_bytes = sizeof(btScalar) == 8 ? 4 : 8;
  std::string message = refusalOf([&] { const Site site({}, *host.world, device, wrong); });
  EXPECT_TRUE(says(message, "8-byte (double)") && says(message, "4-byte (float)")) << message;
  wrong = bulletAbiOfThisCode();
  wrong.version += 3;
  message = refusalOf([&] { const Site site({}, *host.world, device, wrong); });
  EXPECT_TRUE(says(message, std::to_string(wrong.version)) &&
              says(message, std::to_string(wrong.version - 3)))
      << message;
  EXPECT_EQ(host.world->getSimulationIslandManager(), manager);
  const Site site({}, *host.world, device);
}

TEST(Misuse, BodiesThatCannotBeSharedAreRefusedWithTheReason) {
  Scene scene;
  btRigidBody& box = scene.host.addCube(0.1, Vec3(0.3, 0.0, 0.0));
  scene.host.world->removeRigidBody(&box);
  EXPECT_TRUE(says(refusalOf([&] { scene.site->share(box); }), "not in this Bullet world"));
  scene.host.world->addRigidBody(&box);
  EXPECT_TRUE(
      says(refusalOf([&] { scene.site->share(scene.cube); }), "shared already, as object 0"));
  EXPECT_TRUE(
      says(refusalOf([&] { scene.site->share(*scene.site->proxyBody(0)); }), "remote user"));
  EXPECT_EQ(scene.site->objectCount(), 1);
  scene.run(4);
  scene.site.reset();
  EXPECT_EQ(scene.before, test::readSettings(scene.cube));
}

TEST(Misuse, ABodyThatWasRefusedIsANeighbourLikeAnyOther) {
  Scene scene;
  btRigidBody& box = scene.host.addCube(0.1, scene.site->object(0).p_W + Vec3(0.0405, 0.0, 0.0));
  scene.host.world->removeRigidBody(&box);
  EXPECT_TRUE(says(refusalOf([&] { scene.site->share(box); }), "not in this Bullet world"));
  const int before = scene.site->neighbourCount();
  scene.host.world->addRigidBody(&box);
  scene.run(1);
  EXPECT_EQ(scene.site->neighbourCount(), before + 1);
}

TEST(Misuse, ABodyOfAnotherWorldIsRefused) {
  Scene one, two;
  EXPECT_TRUE(says(refusalOf([&] { two.site->share(one.cube); }), "not in this Bullet world"));
  EXPECT_EQ(two.site->objectCount(), 1);
}

// Mistakes while attached.

TEST(Misuse, ABodyTakenOutAndDeletedIsLeftOut) {
  Scene scene;
  scene.run(4);
  scene.host.world->removeRigidBody(&scene.cube);
  scene.host.bodies.clear();
  scene.run(10);
  EXPECT_EQ(scene.site->status(), kBodyMissing);
  EXPECT_EQ(scene.site->force(), Vec3::Zero());
  EXPECT_FALSE(scene.site->isHeld(0));
  scene.site->connect(PeerId{3}, scene.link, Vec3(0.0, 1.0, 0.0));
  scene.run(4);
}

TEST(Misuse, SoItDoesWithANativeModel) {
  for (const ContactModel model : {ContactModel::kNativeRigid, ContactModel::kNativeSoft}) {
    AnyHost host(WorldKind::kDiscrete);
    FakeDevice device(Vec3(-0.029, 0.0, 0.0));
    FakeLink link;
    SiteSettings settings;
    settings.contact_model = model;
    Site site(settings, *host.world, device);
    site.share(host.addCube(0.2), 0.1);
    site.connect(kRemote, link, kRemoteStart);
    host.step(kStep);
    host.world->removeRigidBody(host.bodies.back().get());
    host.bodies.clear();
    for (int i = 0; i < 10; ++i) host.step(kStep);
    EXPECT_EQ(site.status(), kBodyMissing);
    EXPECT_EQ(site.force(), Vec3::Zero());
  }
}

TEST(Misuse, ABodyPutBackIsRestoredWhenTheSiteEnds) {
  Scene scene;
  scene.run(4);
  scene.host.world->removeRigidBody(&scene.cube);
  scene.run(1);
  scene.host.world->addRigidBody(&scene.cube);
  scene.run(1);
  EXPECT_TRUE(scene.site->isHeld(0));
  scene.site.reset();
  EXPECT_EQ(scene.before, test::readSettings(scene.cube));
}

TEST(Misuse, AProxyTakenOutIsStillItsOwn) {
  Scene scene;
  scene.run(4);
  btRigidBody* proxy = scene.site->proxyBody(0);
  scene.host.world->removeRigidBody(proxy);
  scene.run(1);
  EXPECT_EQ(scene.site->status(), kBodyMissing);
  EXPECT_EQ(scene.site->proxyBody(0), proxy);
}

TEST(Misuse, AProxyTakenOutAndDeletedIsNotDeletedTwice) {
  Scene scene;
  scene.host.addCube(0.1,
                     Vec3(0.0, 0.09, 0.0));  // the island holds it and filters it from the cube
  scene.run(4);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  btRigidBody* proxy = scene.site->proxyBody(0);
  scene.host.world->removeRigidBody(proxy);
  delete proxy;
  EXPECT_EQ(scene.site->proxyBody(0), nullptr);
  scene.site->share(*scene.host.bodies.back());
  scene.run(4);
  EXPECT_EQ(scene.site->status(), kBodyMissing);
}

TEST(Misuse, ANeighbourMayComeAfterAProxyWasDeleted) {
  Scene scene;
  scene.run(4);
  btRigidBody* proxy = scene.site->proxyBody(0);
  scene.host.world->removeRigidBody(proxy);
  delete proxy;
  scene.run(1);
  const int before = scene.site->neighbourCount();
  scene.host.addCube(0.1, scene.site->object(0).p_W + Vec3(0.0405, 0.0, 0.0));
  scene.run(2);
  EXPECT_EQ(scene.site->neighbourCount(), before + 1);
}

TEST(Misuse, DeviceAndLinkMayEndBeforeASiteThatTicksNoMore) {
  AnyHost host(WorldKind::kDiscrete);
  auto device = std::make_unique<FakeDevice>();
  auto link = std::make_unique<FakeLink>();
  auto site = std::make_unique<Site>(SiteSettings{}, *host.world, *device);
  site->share(host.addCube(0.2));
  site->connect(kRemote, *link, kRemoteStart);
  host.step(kStep);
  link.reset();
  device.reset();
  site.reset();
  host.step(kStep);
}

// Calls from the host's own callbacks.

/// Actions of the callbacks below, each done once.
struct Doings {
  std::unique_ptr<Site>* ends = nullptr;
  int calls = 0;
};
Doings in_pre, in_post;

void doOnce(Doings& doings) {
  ++doings.calls;
  if (doings.ends) doings.ends->reset();
  doings.ends = nullptr;
}
void hostPreTick(btDynamicsWorld*, btScalar) { doOnce(in_pre); }
void hostPostTick(btDynamicsWorld*, btScalar) { doOnce(in_post); }

struct EndingAction final : btActionInterface {
  void updateAction(btCollisionWorld*, btScalar) override { site->reset(); }
  void debugDraw(btIDebugDraw*) override {}
  std::unique_ptr<Site>* site = nullptr;
};

struct HostCallbacks : ::testing::Test {
  HostCallbacks() {
    in_pre = in_post = {};
    scene.site.reset();
    scene.host.world->setInternalTickCallback(hostPreTick, this, true);
    scene.host.world->setInternalTickCallback(hostPostTick, this, false);
    scene.site = make();
  }
  std::unique_ptr<Site> make() {
    auto site = std::make_unique<Site>(SiteSettings{}, *scene.host.world, scene.device);
    site->share(scene.cube);
    site->connect(kRemote, scene.link, kRemoteStart);
    return site;
  }
  /// The site is gone; the host's own callbacks still run.
  void expectLeft() {
    EXPECT_EQ(scene.site, nullptr);
    EXPECT_EQ(scene.before, test::readSettings(scene.cube));
    EXPECT_EQ(scene.host.world->getWorldUserInfo(), this);
    const int pre = in_pre.calls, post = in_post.calls;
    scene.run(3);
    EXPECT_EQ(in_pre.calls, pre + 3);
    EXPECT_EQ(in_post.calls, post + 3);
    EXPECT_EQ(scene.host.world->getNumCollisionObjects(), 1);
    // A new site can attach to the world.
    scene.site = make();
    scene.run(3);
    EXPECT_EQ(scene.site->counters().host_steps, 3u);
  }
  Scene scene;
};

TEST_F(HostCallbacks, MayEndTheSiteBeforeAStep) {
  scene.run(2);
  in_pre.ends = &scene.site;
  scene.run(1);
  expectLeft();
}

TEST_F(HostCallbacks, MayEndTheSiteAfterAStep) {
  scene.run(2);
  in_post.ends = &scene.site;
  scene.run(1);
  expectLeft();
}

TEST_F(HostCallbacks, AnActionMayEndTheSiteBetween) {
  EndingAction action;
  action.site = &scene.site;
  scene.run(2);
  scene.host.world->addAction(&action);
  scene.run(1);
  scene.host.world->removeAction(&action);
  expectLeft();
}

TEST_F(HostCallbacks, ASiteBornWithinAStepHearsOfTheNext) {
  struct BirthAction final : btActionInterface {
    void updateAction(btCollisionWorld*, btScalar) override {
      if (!fixture->scene.site) fixture->scene.site = fixture->make();
    }
    void debugDraw(btIDebugDraw*) override {}
    HostCallbacks* fixture = nullptr;
  } action;
  action.fixture = this;
  scene.site.reset();
  scene.host.world->addAction(&action);
  scene.run(1);
  ASSERT_NE(scene.site, nullptr);
  EXPECT_EQ(scene.site->counters().host_steps, 0u);
  EXPECT_EQ(scene.site->tickCount(), 0u);
  scene.run(1);
  EXPECT_EQ(scene.site->counters().host_steps, 1u);
  EXPECT_EQ(scene.site->status(), kTickOk);
  scene.host.world->removeAction(&action);
}

}  // namespace
}  // namespace tandem
