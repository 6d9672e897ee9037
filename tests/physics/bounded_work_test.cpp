// Each act of a host, and each that it leaves out, costs a bounded amount of work.

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include <gtest/gtest.h>

#include "tandem/coordination/island_counters.h"

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::NeighbourScene;

constexpr int kPerStep = 17;  // bodies that come, and as many that go: 1020 a second at 60 Hz
constexpr int kTicksPerStep = 17;
constexpr double kPeriod = 1e-3;  // [s]

/// Balls around a shared cube, in rings: some near enough to be neighbours.
class Crowd {
 public:
  explicit Crowd(NeighbourScene& scene) : scene_(scene) {}
  ~Crowd() {
    for (const auto& ball : balls_) scene_.rig.world.removeRigidBody(ball.get());
  }
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

  void add() {
    const double angle = 2.4 * number_, radius = 0.05 + 0.01 * (number_ % 20);
    ++number_;
    auto ball = std::make_unique<btRigidBody>(btScalar(0.01), nullptr, &shape_,
                                              btVector3(1, 1, 1) * btScalar(4e-7));
    ball->setWorldTransform(toBullet(
        Vec3(radius * std::cos(angle), radius * std::sin(angle), kRadius), Quat::Identity()));
    scene_.rig.world.addRigidBody(ball.get());
    balls_.push_back(std::move(ball));
  }
  /// Deletes the eldest.
  void remove() {
    scene_.rig.world.removeRigidBody(balls_.front().get());
    balls_.pop_front();
  }

 private:
  static constexpr double kRadius = 0.01;  // [m]
  NeighbourScene& scene_;
  btSphereShape shape_{static_cast<btScalar>(kRadius)};
  std::deque<std::unique_ptr<btRigidBody>> balls_;
  int number_ = 0;
};

/// Greatest work of a tick.
struct Work {
  std::uint64_t rigid_steps = 0, factorisations = 0, integrated_steps = 0, searches = 0;

  void note(const IslandCounters& before, const IslandCounters& now) {
    rigid_steps = std::max(rigid_steps, now.rigid_steps - before.rigid_steps);
    factorisations =
        std::max(factorisations, now.rigid_factorisations - before.rigid_factorisations);
    integrated_steps = std::max(integrated_steps, now.integrated_steps - before.integrated_steps);
    searches = std::max(searches, now.contact_searches - before.contact_searches);
  }
};

TEST(BoundedWork, AddingAndRemoving1000BodiesASecondBesideATouchedCubeLosesNoTick) {
  NeighbourScene scene(true);
  scene.settings.tick_source = TickSource::kCaller;
  scene.settings.host_step = kTicksPerStep * kPeriod;
  scene.addFloor();
  scene.device.sample.hip.p_W = Vec3(0.0, 0.0, 2.0 * NeighbourScene::kHalf + 0.0095);
  scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  Crowd crowd(scene);
  for (int i = 0; i < 5 * kPerStep; ++i) crowd.add();
  Work worst;
  std::uint64_t ticks = 0;
  const auto run = [&](int steps) {
    for (int step = 0; step < steps; ++step) {
      for (int i = 0; i < kTicksPerStep; ++i) {
        const IslandCounters before = scene.site->islandCounters();
        EXPECT_EQ(scene.site->tick(static_cast<double>(ticks++) * kPeriod), kTickOk);
        worst.note(before, scene.site->islandCounters());
      }
      scene.rig.step(scene.settings.host_step);
      for (int i = 0; i < kPerStep; ++i) {
        crowd.remove();
        crowd.add();
      }
    }
  };
  run(20);
  const SiteCounters before = scene.site->counters();
  const std::uint64_t bounded = scene.site->islandCounters().rigid_bounded;
  run(180);
  const SiteCounters& after = scene.site->counters();
  EXPECT_GT(scene.site->force().norm(), 0.1) << "the hand was to touch the cube";
  EXPECT_GT(after.promoted - before.promoted, 100u) << "the crowd was to come near";
  EXPECT_EQ(after.ticks_made_up, 0u);
  EXPECT_EQ(after.host_clock_set, 0u);
  EXPECT_EQ(after.searches - before.searches, 180u) << "one for each host step";
  EXPECT_EQ(scene.site->islandCounters().rigid_bounded, bounded) << "no tick had too much work";
  // Measured: 44 rigid steps, 387 factorisations, 44 steps of the integrator, 4 searches.
  EXPECT_LE(worst.rigid_steps, 64u);
  EXPECT_LE(worst.factorisations, 512u);
  EXPECT_LE(worst.integrated_steps, 64u);
  EXPECT_LE(worst.searches, 8u);
}

// Packets that were due in a gap would all tell the same state.
TEST(BoundedWork, AGapOf600SecondsSendsNo76800Packets) {
  for (const Injection injection : {Injection::kHandoff, Injection::kImpulse}) {
    for (const bool thins : {false, true}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(injection) << ", thins " << thins);
      test::BulletRig rig;
      btRigidBody& cube = rig.addCube(0.2);
      test::FakeDevice device(Vec3(0.2, 0.0, 0.0));
      test::FakeLink link(10'000);
      SiteSettings settings;
      settings.injection = injection;
      settings.thins_when_idle = thins;
      settings.tick_source = TickSource::kCaller;
      Site site(settings, rig.world, device);
      (void)site.share(cube);
      site.connect(PeerId{2}, link, Vec3(0.5, 0.0, 0.0));
      std::uint64_t ticks = 0;
      const auto tick = [&] { site.tick(static_cast<double>(ticks++) * kPeriod); };
      for (int i = 0; i < 2000; ++i) tick();
      const SiteCounters before = site.counters();
      ticks += 600'000;
      tick();
      const SiteCounters& after = site.counters();
      EXPECT_LE(after.packets_sent - before.packets_sent, 8u);  // of the time that is made up
      EXPECT_LE(after.ticks_made_up - before.ticks_made_up, 51u);
      // Later ones are due as ever.
      for (int i = 1; i < 1000; ++i) tick();
      EXPECT_LE(after.packets_sent - before.packets_sent, 128u + 8u);
      EXPECT_GE(after.packets_sent - before.packets_sent, thins ? 15u : 127u);
      EXPECT_NEAR(link.sent.back().time, static_cast<double>(ticks) * kPeriod,
                  thins ? 0.07 : 0.009);
    }
  }
}

}  // namespace
}  // namespace tandem
