// A hand that starts inside something, and something that the host puts onto a hand: neither is
// thrown.

#include <algorithm>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::FakeLink;
using test::makePacket;
using test::NeighbourScene;

constexpr double kLeaving = 0.101;  // top speed of a thing that is let out [m/s]
constexpr double kHipRadius = 0.01;

/// Place of a hand above a 4 cm cube at the origin, `depth` deep.
Vec3 over(double depth) { return {0.002, 0.001, NeighbourScene::kHalf + kHipRadius - depth}; }

/// Top speed of a body, and the hand's top force in its first 20 ms and ever.
struct Watch {
  NeighbourScene& scene;
  double top_speed = 0.0, first_force = 0.0, top_force = 0.0;
  int steps = 0;

  void operator()(const btRigidBody& body) {
    top_speed = std::max(top_speed, NeighbourScene::velocityOf(body).norm());
    const double force = scene.device.force_W.norm();
    top_force = std::max(top_force, force);
    if (++steps <= 1) first_force = std::max(first_force, force);
  }
};

class SiteJump : public ::testing::TestWithParam<double> {};

TEST_P(SiteJump, HandThatStartsInASharedBodyLetsItOut) {
  NeighbourScene scene;
  scene.settings.contact = {4000.0, 0.0};
  scene.settings.hip_radius = kHipRadius;
  scene.device.sample.hip.p_W = over(GetParam());
  scene.start();
  Watch watch{scene};
  scene.run(2.0, 60.0, [&] { watch(*scene.cube); });
  EXPECT_LT(watch.top_speed, kLeaving);
  EXPECT_GT(watch.top_speed, 0.01);
  EXPECT_LT(watch.first_force, 4000.0 * 0.05 * 0.018);
  EXPECT_LT(watch.top_force, 2.0);  // speed times the root of stiffness and mass
}

TEST_P(SiteJump, SharedBodyThatTheHostPutsOntoAHandIsLetOut) {
  NeighbourScene scene;
  scene.settings.contact = {4000.0, 0.0};
  scene.settings.hip_radius = kHipRadius;
  scene.device.sample.hip.p_W = over(GetParam());
  scene.start(Vec3(0.0, 0.5, 0.0));
  scene.run(0.1);
  scene.cube->setWorldTransform(toBullet(Vec3::Zero(), Quat::Identity()));
  Watch watch{scene};
  scene.run(2.0, 60.0, [&] { watch(*scene.cube); });
  EXPECT_LT(watch.top_speed, kLeaving);
  EXPECT_GT(watch.top_speed, 0.01);
  EXPECT_LT(watch.top_force, 2.0);
}

TEST_P(SiteJump, NeighbourThatTheHostPutsOntoAHandIsLetOut) {
  NeighbourScene scene;
  scene.settings.contact = {4000.0, 0.0};
  scene.settings.hip_radius = kHipRadius;
  scene.device.sample.hip.p_W = over(GetParam());
  int steps = 0;
  btRigidBody& box = scene.addBox(Vec3(0.0, 1.0, 0.0));
  scene.start(Vec3(0.0, 0.5, 0.0));
  // A hand that moves: around one at rest the site does not look for what comes.
  const auto move = [&] { scene.device.sample.hip.p_W.x() = 0.002 + 1e-5 * (++steps % 2); };
  scene.run(0.1, 60.0, move);
  box.setWorldTransform(toBullet(Vec3::Zero(), Quat::Identity()));
  Watch watch{scene};
  scene.run(2.0, 60.0, [&] { move(), watch(box); });
  EXPECT_LT(watch.top_speed, kLeaving);
  EXPECT_GT(watch.top_speed, 0.01);
  EXPECT_LT(watch.top_force, 2.5);
}

// 4000 N/m push with 80 N in the end; the device gets them over 0.4 s.
TEST(SiteJump, FixedObjectThatTheHostPutsOntoAHandPushesGently) {
  for (const bool is_moved : {false, true}) {
    NeighbourScene scene;
    scene.settings.passivity.enabled =
        false;  // the account allows 33 N to a hand that gave nothing
    scene.settings.contact = {4000.0, 0.0};
    scene.settings.hip_radius = kHipRadius;
    scene.device.sample.hip.p_W = over(0.02);
    btRigidBody* wall = nullptr;
    if (is_moved) wall = &scene.rig.addCube(0.0, NeighbourScene::kHalf, Vec3(0.06, 0.0, 0.0));
    scene.start(Vec3(0.0, 0.5, 0.0));
    scene.run(0.1);
    if (is_moved) {
      wall->setWorldTransform(toBullet(Vec3::Zero(), Quat::Identity()));
      scene.rig.world.updateSingleAabb(wall);
    } else {
      scene.rig.addCube(0.0, NeighbourScene::kHalf);
    }
    scene.run(1.0 / 60.0);
    double time = 0.0;
    scene.run(1.0, 60.0, [&] {
      time += 1.0 / 60.0;
      EXPECT_LT(scene.device.force_W.norm(), 4000.0 * 0.05 * time + 0.2);
    });
    EXPECT_NEAR(scene.device.force_W.norm(), 80.0, 0.5);
  }
}

TEST_P(SiteJump, ImpulseInjectionLetsOutTheSame) {
  NeighbourScene scene;
  scene.settings.contact = {2000.0, 1.0};
  scene.settings.hip_radius = kHipRadius;
  scene.settings.injection = Injection::kImpulse;
  scene.settings.host_step = 1.0 / scene.settings.haptic_rate;
  scene.device.sample.hip.p_W = over(GetParam());
  scene.start();
  Watch watch{scene};
  scene.run(2.0, 1000.0, [&] { watch(*scene.cube); });
  EXPECT_LT(watch.top_speed, 1.1 * kLeaving);
  EXPECT_GT(watch.top_speed, 0.01);
}

// A remote user is inside our cube from the start.
TEST_P(SiteJump, ProxyThatComesInLetsABodyOut) {
  NeighbourScene scene;
  scene.settings.contact = {4000.0, 0.0};
  scene.settings.coordination = {1000.0, 10.0};
  scene.settings.link_loss.enabled = false;
  FakeLink link;
  scene.addCube(Vec3::Zero());
  scene.site = std::make_unique<Site>(scene.settings, scene.rig.world, scene.device);
  scene.site->share(*scene.cube);
  const Vec3 place(0.002, 0.001, NeighbourScene::kHalf + scene.settings.proxy.radius - GetParam());
  scene.site->connect(PeerId{2}, link, place);
  StatePacket packet = makePacket(PeerId{2}, 0, place);
  link.arrivals.push_back({packet, 0.0});
  Watch watch{scene};
  scene.run(2.0, 60.0, [&] { watch(*scene.cube); });
  EXPECT_LT(watch.top_speed, kLeaving);
}

INSTANTIATE_TEST_SUITE_P(Depths, SiteJump, ::testing::Values(0.002, 0.02, 0.025));

}  // namespace
}  // namespace tandem
