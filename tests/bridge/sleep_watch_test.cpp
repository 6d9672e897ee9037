#include "bullet_bridge/src/bodies/sleep_watch.h"

#include <functional>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/bodies/haptic_body.h"

namespace tandem {
namespace {

using test::BulletRig;

/// Something that a host does to a sleeping body.
struct HostAct {
  const char* name;
  std::function<void(BulletRig&, btRigidBody&)> act;
};

const HostAct kHostActs[] = {
    {"force", [](auto&, auto& b) { b.applyCentralForce(btVector3(0, 0, 1)); }},
    {"torque", [](auto&, auto& b) { b.applyTorque(btVector3(0, 1, 0)); }},
    {"velocity", [](auto&, auto& b) { b.setLinearVelocity(btVector3(-1, 0, 0)); }},
    {"turning", [](auto&, auto& b) { b.setAngularVelocity(btVector3(0, 0, 1)); }},
    {"pose", [](auto&, auto& b) { b.translate(btVector3(0, btScalar(1e-6), 0)); }},
    {"gravity", [](auto&, auto& b) { b.setGravity(btVector3(0, 0, 1)); }},
    {"mass", [](auto&, auto& b) { b.setMassProps(2, btVector3(1, 1, 1)); }},
    {"inertia", [](auto&, auto& b) { b.setInvInertiaDiagLocal(btVector3(1, 2, 3)); }},
    {"linear factor", [](auto&, auto& b) { b.setLinearFactor(btVector3(1, 0, 1)); }},
    {"angular factor", [](auto&, auto& b) { b.setAngularFactor(btVector3(0, 0, 1)); }},
    {"flags",
     [](auto&, auto& b) { b.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE); }},
    {"activation", [](auto&, auto& b) { b.activate(true); }},
    {"switched off", [](auto&, auto& b) { b.forceActivationState(DISABLE_SIMULATION); }},
    {"group", [](auto&, auto& b) { b.getBroadphaseHandle()->m_collisionFilterGroup = 64; }},
    {"mask", [](auto&, auto& b) { b.getBroadphaseHandle()->m_collisionFilterMask = 64; }},
    {"margin", [](auto&, auto& b) { b.getCollisionShape()->setMargin(btScalar(0.01)); }},
    {"scaling", [](auto&, auto& b) { b.getCollisionShape()->setLocalScaling(btVector3(2, 1, 1)); }},
    {"shape",
     [](auto& rig, auto& b) {
       b.setCollisionShape(&rig.template makeShape<btSphereShape>(btScalar(0.02)));
     }},
    {"removal", [](auto& rig, auto& b) { rig.world.removeRigidBody(&b); }},
    {"removal and return", [](auto& rig, auto& b) {
       rig.world.removeRigidBody(&b);
       rig.world.addRigidBody(&b);
       b.forceActivationState(ISLAND_SLEEPING);
     }}};

// Bullet tells nobody about a setter. Each one on the second of three bodies at rest is noticed.
TEST(SleepWatch, NoticesWhateverAHostDoesToASleepingBody) {
  for (const HostAct& host : kHostActs) {
    SCOPED_TRACE(host.name);
    BulletRig rig(Vec3(0, 0, 0));
    std::vector<std::unique_ptr<HapticBody>> bodies;
    std::vector<HapticBody*> watched;
    for (int i = 0; i < 3; ++i) {
      btRigidBody& cube = rig.addCube(0.2, 0.02, Vec3(0.1 * i, 0, 0));
      bodies.push_back(std::make_unique<HapticBody>(rig.world, cube));
      bodies.back()->handOff(bodies.back()->state(), 0.01);
      (void)bodies.back()->restore();
      bodies.back()->park();
      watched.push_back(bodies.back().get());
    }
    SleepWatch watch(rig.world);
    ASSERT_TRUE(watch.remember(watched));
    for (int step = 0; step < 3; ++step) {
      EXPECT_TRUE(watch.isUndisturbed());
      rig.world.stepSimulation(btScalar(0.01), 0);
      EXPECT_TRUE(watch.areAsleep());
    }
    host.act(rig, watched[1]->body());
    EXPECT_FALSE(watch.isUndisturbed());
    EXPECT_FALSE(watch.remember(watched));
  }
}

}  // namespace
}  // namespace tandem
