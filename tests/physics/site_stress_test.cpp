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

// A proxy of 12 g deep in a fixed ball is shot out at 9 m/s. It is at rest when the host searches
// its surroundings. The floor is 70 mm away; a body at rest is searched to 40 mm. The next search
// is a step of 1/30 s later, after 0.3 m of way. The floor used to be found only when the proxy was
// deep in it.
TEST(SiteStress, FloorIsFoundBeforeAShotProxyIsInIt) {
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
    // From 1 cm of overlap v = x sqrt(K / m). The floor's spring sinks by the same depth.
    const double deepest = top + settings.proxy.radius - 0.011;
    double rise = 0.0;
    for (int tick = 0; tick < 30; ++tick) {
      site.tick(tick * 1e-3);
      rise = std::max(rise, site.proxy(0)->v_W.y());
      EXPECT_GT(site.proxy(0)->p_W.y(), deepest) << "tick " << tick;
    }
    EXPECT_GT(rise, 8.0);
  }
  rig.world.removeRigidBody(&floor);
  rig.world.removeRigidBody(&ball);
}

}  // namespace
}  // namespace tandem
