// Multi-bodies and soft bodies beside shared bodies stay Bullet's. Shared bodies meet them in
// Bullet at the host's rate; the hand does not feel them.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "host/any_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::FakeDevice;
using test::FakeLink;
using test::WorldKind;

/// The hand pushes a shared cube along x into any body there.
struct Push {
  explicit Push(WorldKind kind) : host(kind) {
    cube = &host.addCube(0.2);
    device.sample.hip = {Vec3(-0.032, 0.0, 0.0), Vec3(0.1, 0.0, 0.0)};
  }
  void run(double seconds) {
    Site site(SiteSettings{}, *host.world, device);
    site.share(*cube);
    site.connect(PeerId{2}, link, Vec3(0.0, 0.2, 0.0));  // the remote copy holds this one back
    for (int i = 0; i < static_cast<int>(120.0 * seconds); ++i) {
      device.sample.hip.p_W.x() += 0.1 / 120.0;
      host.step(1.0 / 120.0);
      farthest = std::max(farthest, std::abs(site.object(0).p_W.z()));
      reached = std::max(reached, site.object(0).p_W.x());
      if (!site.force().allFinite()) FAIL() << "step " << i;
    }
    EXPECT_EQ(site.status(), kTickOk);
    neighbours = site.neighbourCount();
    EXPECT_TRUE(isFinite(site.object(0)));
    EXPECT_GT(reached, 0.0195);
  }

  AnyHost host;
  btRigidBody* cube = nullptr;
  FakeDevice device;
  FakeLink link;
  double farthest = 0.0;  // farthest distance of the cube from its plane [m]
  double reached = 0.0;   // farthest x of the cube; a link in the way stops it at 20 mm [m]
  int neighbours = 0;     // at the end
};

class MultiBodyNearby : public ::testing::TestWithParam<WorldKind> {};

// The pendulum hangs across the cube's path. Its links turn about x, the direction of the push:
// they do not give way.
TEST_P(MultiBodyNearby, StopsASharedCube) {
  for (const bool is_in_the_way : {true, false}) {
    Push push(GetParam());
    push.host.addMultiBody(Vec3(0.06, 0.0, is_in_the_way ? 0.05 : 0.5));
    push.host.multi_body->setJointPos(0, btScalar(0.1));
    push.run(0.6);
    EXPECT_EQ(push.neighbours, is_in_the_way ? 2 : 0);
    EXPECT_EQ(push.reached < 0.0205, is_in_the_way) << push.reached;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, MultiBodyNearby,
                         ::testing::Values(WorldKind::kMultiBody, WorldKind::kSoftMultiBody),
                         [](const auto& kind) { return test::nameOf(kind.param); });

class SoftBodyNearby : public ::testing::TestWithParam<WorldKind> {};

// A cloth falls on the cube, or beside both the cube and the hand.
TEST_P(SoftBodyNearby, PushesASharedCubeInBullet) {
  for (const bool is_over_it : {true, false}) {
    Push push(GetParam());
    push.host.world->setGravity(btVector3(0, 0, -2));
    push.cube->setFlags(push.cube->getFlags() | BT_DISABLE_WORLD_GRAVITY);
    push.cube->setGravity(btVector3(0, 0, 0));
    push.host.addSoftBody(Vec3(is_over_it ? 0.0 : 1.0, 0.0, 0.03));
    push.run(0.6);
    EXPECT_EQ(push.neighbours, 0);
    if (is_over_it) {
      EXPECT_GT(push.farthest, 1e-6);
    } else {
      EXPECT_LT(push.farthest, 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SoftBodyNearby,
                         ::testing::Values(WorldKind::kSoftRigid, WorldKind::kSoftMultiBody),
                         [](const auto& kind) { return test::nameOf(kind.param); });

}  // namespace
}  // namespace tandem
