// When a site ends, every setting that it changed in the host is restored.

#include <memory>

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

void hostPreTick(btDynamicsWorld*, btScalar) {}
void hostPostTick(btDynamicsWorld*, btScalar) {}

struct Slots : btDiscreteDynamicsWorld {
  static btInternalTickCallback pre(btDynamicsWorld& world) {
    return world.*(&Slots::m_internalPreTickCallback);
  }
  static btInternalTickCallback post(btDynamicsWorld& world) {
    return world.*(&Slots::m_internalTickCallback);
  }
};

/// The settings of a body, and its place in the world, that a host can change.
struct Seen {
  explicit Seen(btRigidBody& body)
      : settings(test::readSettings(body)),
        user_pointer(body.getUserPointer()),
        user_index(body.getUserIndex()),
        group(body.getBroadphaseHandle()->m_collisionFilterGroup),
        mask(body.getBroadphaseHandle()->m_collisionFilterMask),
        ignored(body.getNumObjectsWithoutCollision()),
        place(body.getWorldArrayIndex()),
        joints(body.getNumConstraintRefs()),
        shape(body.getCollisionShape()) {}
  bool operator==(const Seen&) const = default;

  std::vector<btScalar> settings;
  void* user_pointer;
  int user_index, group, mask, ignored, place, joints;
  btCollisionShape* shape;
};

class Detach : public ::testing::TestWithParam<WorldKind> {};

TEST_P(Detach, LeavesEverythingAsItWas) {
  int host_data = 0, body_data = 0;
  AnyHost host(GetParam(), Vec3(0.0, 0.0, -9.81));
  btDiscreteDynamicsWorld& world = *host.world;
  world.setInternalTickCallback(hostPreTick, &host_data, true);
  world.setInternalTickCallback(hostPostTick, &host_data, false);
  btSimulationIslandManager* const manager = world.getSimulationIslandManager();
  btRigidBody& floor = host.addBody(host.makeBox(Vec3(1.0, 1.0, 0.1)), 0.0, Vec3(0.0, 0.0, -0.12));
  btRigidBody& cube = host.addCube(0.2);
  btRigidBody& box = host.addCube(0.1, Vec3(0.045, 0.0, 0.0));
  btRigidBody& behind = host.addCube(0.1, Vec3(0.09, 0.0, 0.0));
  cube.setUserPointer(&body_data);
  cube.setUserIndex(7);
  cube.setDamping(btScalar(0.05), btScalar(0.1));
  cube.setFlags(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT | BT_DISABLE_WORLD_GRAVITY);
  cube.setGravity(btVector3(0, 0, -5));
  cube.setSleepingThresholds(btScalar(0.3), btScalar(0.4));
  box.setDamping(btScalar(0.2), btScalar(0.3));
  box.setLinearFactor(btVector3(1, btScalar(0.5), 1));
  box.setIgnoreCollisionCheck(&behind, true);
  if (host.multi()) host.addMultiBody(Vec3(0.0, 0.3, 0.3));
  if (host.soft()->isThere()) host.addSoftBody(Vec3(0.0, -0.3, 0.1));
  for (int i = 0; i < 10; ++i) host.step(1.0 / 60.0);

  btRigidBody* const all[] = {&floor, &cube, &box, &behind};
  std::vector<Seen> before;
  for (btRigidBody* body : all) before.emplace_back(*body);
  const int objects = world.getNumCollisionObjects(), joints = world.getNumConstraints();
  const Vec3 cube_W = fromBullet(cube.getCenterOfMassPosition());

  FakeDevice device(cube_W - Vec3(0.031, 0.0, 0.0));
  FakeLink link;
  auto site = std::make_unique<Site>(SiteSettings{}, world, device);
  site->share(cube);
  site->connect(PeerId{2}, link, Vec3(0.045, 0.04, 0.0));
  EXPECT_NE(Seen(cube), before[1]);
  for (int i = 0; i < 30; ++i) {
    device.sample.hip.p_W.x() += 5e-4;
    host.step(1.0 / 60.0);
  }
  ASSERT_EQ(site->status(), kTickOk);
  ASSERT_GE(site->neighbourCount(), 1);
  ASSERT_GT(cube.getCenterOfMassPosition().x(), cube_W.x() + 0.005) << "nothing was pushed";
  site.reset();

  EXPECT_EQ(Slots::pre(world), &hostPreTick);
  EXPECT_EQ(Slots::post(world), &hostPostTick);
  EXPECT_EQ(world.getWorldUserInfo(), &host_data);
  EXPECT_EQ(world.getSimulationIslandManager(), manager);
  EXPECT_EQ(world.getNumCollisionObjects(), objects);
  EXPECT_EQ(world.getNumConstraints(), joints);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(Seen(*all[i]), before[i]) << i;
  host.step(1.0 / 60.0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Detach, ::testing::ValuesIn(test::kAllKinds),
                         [](const auto& kind) { return test::nameOf(kind.param); });

}  // namespace
}  // namespace tandem
