// A site with extreme numbers that no real scene has, found by `tandem bench stress`.

#include <algorithm>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;
using test::FakeLink;

// A proxy of 12 g starts 1 cm deep in a fixed ball, above a floor that is beyond the range searched
// around a body at rest. It used to be shot out at 9 m/s.
TEST(SiteStress, ProxyThatStartsInABallIsNotShotAtTheFloor) {
  BulletRig rig;
  btSphereShape ball_shape(btScalar(0.02));
  btRigidBody ball(0, nullptr, &ball_shape);
  rig.world.addRigidBody(&ball);
  btBoxShape floor_shape(btVector3(1, btScalar(0.1), 1));
  btRigidBody floor(0, nullptr, &floor_shape);
  const double top = -0.1;  // [m]
  btTransform pose;
  pose.setIdentity();
  pose.setOrigin(btVector3(0, btScalar(top - 0.1), 0));
  floor.setWorldTransform(pose);
  rig.world.addRigidBody(&floor);

  SiteSettings settings;
  settings.host_step = 1.0 / 30.0;
  settings.contact = {1e4, 0.0};
  settings.coordination = {0.0, 0.0};
  settings.proxy = {0.012, 0.0, 0.01};
  settings.tick_source = TickSource::kCaller;
  FakeDevice device(Vec3(10.0, 0.0, 0.0));
  FakeLink link;
  {
    Site site(settings, rig.world, device);
    site.connect(PeerId{2}, link, Vec3(0.0, -0.02, 0.0));
    double speed = 0.0;
    for (int tick = 0; tick < 400; ++tick) {
      site.tick(tick * 1e-3);
      speed = std::max(speed, site.proxy(0)->v_W.norm());
      EXPECT_GT(site.proxy(0)->p_W.y(), top) << "tick " << tick;
    }
    EXPECT_GT(speed, 0.05);
    EXPECT_LT(speed, 0.11);
  }
  rig.world.removeRigidBody(&floor);
  rig.world.removeRigidBody(&ball);
}

}  // namespace
}  // namespace tandem
