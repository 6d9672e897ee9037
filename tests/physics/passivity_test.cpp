// The energy account of a site, and its effect on the force.

#include <cmath>

#include <gtest/gtest.h>

#include "tandem/coordination/passivity_observer.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "demos/program/run/virtual_run.h"
#include "demos/program/scenario/scenario.h"
#include "support/checkout.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::FakeDevice;
using test::FakeLink;
using test::makePacket;

constexpr PeerId kRemote{2};
constexpr double kPeriod = 1e-3;
const Vec3 kFarAway(10.0, 0.0, 0.0);

struct Row {
  const char* file;
  const char* scheme;
  std::vector<std::string> overrides;
};

class GuardsOfTheExperiments : public ::testing::TestWithParam<Row> {};

// Correct forces are not reduced, neither in steady nor in intermittent runs.
TEST_P(GuardsOfTheExperiments, InterveneNowhereInAMinute) {
  std::vector<std::string> overrides = GetParam().overrides;
  overrides.push_back(std::string("experiment.scheme=") + GetParam().scheme);
  overrides.push_back("experiment.duration=60");
  demos::VirtualRun run(
      demos::loadScenario(test::inCheckout("demos/scenarios/") + GetParam().file, overrides));
  run.run();
  for (const demos::SiteSummary& site : run.summary().sites) {
    EXPECT_EQ(site.counters.force_clamped, 0u);
    EXPECT_EQ(site.counters.force_slewed, 0u);
    EXPECT_EQ(site.counters.energy_limited, 0u);
    EXPECT_GT(site.passivity.lowest(), PassivitySettings{}.band);
  }
  // A pushed user receives energy all the same: an account of one port would have run dry.
  if (run.summary().sites[1].force_mean > 0.5) {
    EXPECT_LT(run.summary().sites[1].passivity.own(), -3.0 * PassivitySettings{}.tank);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rows, GuardsOfTheExperiments,
    ::testing::Values(
        Row{"experiment1.toml", "virtual_coupling", {}},
        Row{"experiment1.toml", "kinematic_proxy", {}},
        Row{"experiment1.toml", "remote_dynamic_proxy", {}},
        Row{"experiment2.toml", "kinematic_proxy", {}},
        Row{"experiment2.toml", "kinematic_proxy", {"network.delay=0.2"}},
        Row{"experiment2.toml", "kinematic_proxy", {"contact.stiffness=4000"}},
        Row{"experiment2.toml", "remote_dynamic_proxy", {}},
        Row{"experiment2.toml", "remote_dynamic_proxy", {"network.delay=0.2"}},
        Row{"experiment2.toml", "remote_dynamic_proxy", {"contact.stiffness=4000"}},
        // Devices without friction, and with much.
        Row{"experiment1.toml", "kinematic_proxy", {"device.damping=0"}},
        Row{"experiment2.toml", "kinematic_proxy", {"network.delay=0.2", "device.damping=0"}},
        Row{"experiment2.toml", "kinematic_proxy", {"contact.stiffness=4000", "device.damping=2"}},
        Row{"experiment2.toml", "remote_dynamic_proxy", {"device.damping=2"}}));

/// A passive hand, and a remote user who shakes at it and reports the energy that the test gives.
struct ShakenHand {
  BulletRig rig;
  FakeDevice device{Vec3(0.019, 0.0, 0.0)};
  FakeLink link;
  std::unique_ptr<Site> site;
  double got = 0.0;           ///< energy received by the hand [J]
  double largest_step = 0.0;  ///< largest change of the force between ticks [N]
  double lowest = 1.0;        ///< lowest energy that was available [J]

  explicit ShakenHand(const PassivitySettings& passivity) {
    SiteSettings settings;
    settings.tick_source = TickSource::kCaller;
    settings.guide = Vec3(1, 0, 0);
    settings.passivity = passivity;
    site = std::make_unique<Site>(settings, rig.world, device);
    site->connect(kRemote, link, Vec3::Zero());
  }

  /// `granted(t)` is the energy that the peer has granted by time t; it keeps the rest.
  template <typename Granted>
  void run(double duration, Granted granted, double start = 0.0) {
    Vec3 force_W = Vec3::Zero();
    const auto first = std::lround(start / kPeriod);
    for (auto tick = first; tick < first + std::lround(duration / kPeriod); ++tick) {
      const double now = static_cast<double>(tick) * kPeriod;
      if (tick % 8 == 0) {
        StatePacket packet = makePacket(kRemote, static_cast<std::uint64_t>(tick / 8),
                                        Vec3(0.03 * std::sin(20.0 * now), 0.0, 0.0));
        packet.user.v_W.x() = 0.6 * std::cos(20.0 * now);
        const std::optional<double> energy = granted(now);
        if (energy) packet.energy = {*energy, 1e6};
        link.arrivals.push_back({packet, now});
      }
      site->tick(now);
      largest_step = std::max(largest_step, (site->force() - force_W).norm());
      force_W = site->force();
      lowest = std::min(lowest, site->passivity().available());
      // A device of 0.1 kg on a soft spring that brings it back.
      PointState& hip = device.sample.hip;
      hip.v_W += kPeriod / 0.1 * (force_W - 50.0 * (hip.p_W - Vec3(0.019, 0, 0)) - 3.0 * hip.v_W);
      got += kPeriod * force_W.dot(hip.v_W);
      hip.p_W += kPeriod * hip.v_W;
      if (tick % 4 == 3) rig.step(4.0 * kPeriod);
    }
  }
};

TEST(Passivity, APeerThatGrantsNothingGivesNoMoreThanTheTank) {
  const PassivitySettings settings;
  ShakenHand hand(settings);
  hand.run(20.0, [](double) { return 0.0; });
  EXPECT_LT(hand.got, settings.tank + 1e-4);
  EXPECT_GT(hand.got, 0.5 * settings.tank);
  EXPECT_GT(hand.lowest, -1e-4);
  EXPECT_GT(hand.site->counters().energy_limited, 1000u);
  // The force fades: there is no kick that an unwatched hand would not feel.
  ShakenHand unwatched(PassivitySettings{.enabled = false});
  unwatched.run(20.0, [](double) { return 0.0; });
  EXPECT_LE(hand.largest_step, unwatched.largest_step);
  EXPECT_GT(unwatched.got, 10.0 * settings.tank);
}

TEST(Passivity, APeerThatGrantsItMayGiveIt) {
  ShakenHand hand(PassivitySettings{});
  hand.run(20.0, [](double t) { return t > 0.0 ? 0.1 + t : 0.0; });
  EXPECT_GT(hand.got, 10.0 * PassivitySettings{}.tank);
  EXPECT_EQ(hand.site->counters().energy_limited, 0u);
  EXPECT_NEAR(hand.site->passivity().own(), -hand.got, 0.01 * hand.got);
}

// Grants of a peer before it was heard are of another time.
TEST(Passivity, OnlyWhatAPeerGrantsWhileItIsHeardCounts) {
  ShakenHand hand(PassivitySettings{});
  hand.run(0.1, [](double) { return 5.0; });
  const PassivityObserver& passivity = hand.site->passivity();
  EXPECT_NEAR(passivity.available(), PassivitySettings{}.tank + passivity.own(), 1e-12);
}

// A single bad reading costs the force of its own tick, and nothing later.
TEST(Passivity, AReadingThatIsNoNumberLeavesTheAccountAlone) {
  ShakenHand hand(PassivitySettings{});
  const auto giving = [](double t) { return t > 0.0 ? 0.1 + t : 0.0; };
  hand.run(0.5, giving);
  hand.link = FakeLink(1000);
  const PointState good = hand.device.sample.hip;
  hand.device.sample.hip.p_W.x() = std::nan("");
  (void)hand.site->tick(0.5);
  hand.device.sample.hip = good;
  hand.run(0.5, giving, 0.501);
  EXPECT_TRUE(std::isfinite(hand.site->passivity().own()));
  ASSERT_FALSE(hand.link.sent.empty());
  ASSERT_TRUE(hand.link.sent.back().energy);
  EXPECT_TRUE(std::isfinite(hand.link.sent.back().energy->holdings));
  EXPECT_EQ(hand.site->counters().energy_limited, 0u);
  EXPECT_GT(hand.largest_step, 0.1);
}

// A peer that keeps no account, and one that lies, give no more than the power that is allowed.
TEST(Passivity, APeerGivesNoMoreThanThePower) {
  PassivitySettings settings;
  settings.power = 2e-3;
  for (const bool keeps_account : {false, true}) {
    SCOPED_TRACE(keeps_account);
    ShakenHand hand(settings);
    hand.run(20.0, [&](double t) { return keeps_account ? std::optional(1e6 * t) : std::nullopt; });
    EXPECT_LT(hand.got, settings.tank + settings.power * 20.0 + 1e-4);
    EXPECT_GT(hand.got, 0.5 * settings.power * 20.0);
  }
}

TEST(Passivity, SwitchedOffItSaysSoInPackets) {
  PassivitySettings settings;
  settings.enabled = false;
  ShakenHand hand(settings);
  hand.link = FakeLink(10);
  hand.run(1.0, [](double) { return 0.0; });
  ASSERT_FALSE(hand.link.sent.empty());
  EXPECT_FALSE(hand.link.sent.back().energy);
  EXPECT_GT(hand.got, 0.0);
  EXPECT_EQ(hand.site->counters().energy_limited, 0u);
}

/// A cube without contact whose couplers do not pull.
struct LoneCube {
  static constexpr double kMass = 0.4, kShare = 0.2;
  BulletRig rig;
  FakeDevice device{kFarAway};
  FakeLink link{1000};
  btRigidBody& cube;
  std::unique_ptr<Site> site;

  explicit LoneCube(const Vec3& g_W) : rig(g_W), cube(rig.addCube(kMass)) {
    SiteSettings settings;
    settings.coordination = {0.0, 0.0};
    site = std::make_unique<Site>(settings, rig.world, device);
    site->share(cube);
    site->connect(kRemote, link, Vec3(5, 0, 0));
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) rig.step(1.0 / 250.0);
  }
  [[nodiscard]] double own() const { return site->passivity().own(); }
};

TEST(EnergyAccount, CountsTheWeightOfWhatFalls) {
  LoneCube scene(Vec3(0, 0, -9.81));
  scene.step(100);
  const double height = -scene.site->object(0).p_W.z();
  EXPECT_GT(height, 0.7);
  EXPECT_NEAR(scene.own(), LoneCube::kShare * 9.81 * height, 1e-6);
  ASSERT_TRUE(scene.link.sent.back().energy);
  EXPECT_NEAR(scene.link.sent.back().energy->holdings, scene.own(), 0.1);
}

TEST(EnergyAccount, CountsTheHostsImpulses) {
  LoneCube scene(Vec3::Zero());
  scene.step(10);
  scene.cube.applyCentralImpulse(btVector3(btScalar(0.1), 0, 0));
  scene.step(10);
  // The host's impulse acts on the whole mass of the copy, m/N.
  const double v = scene.site->object(0).v_W.x();
  EXPECT_GT(v, 0.1);
  EXPECT_NEAR(scene.own(), 0.5 * LoneCube::kShare * v * v, byWidth(1e-12, 1e-8));
}

TEST(EnergyAccount, CountsTheHostsForces) {
  LoneCube scene(Vec3::Zero());
  for (int i = 0; i < 50; ++i) {
    scene.cube.applyCentralForce(btVector3(0, btScalar(0.5), 0));
    scene.step(1);
  }
  scene.step(5);
  const double v = scene.site->object(0).v_W.y();
  EXPECT_GT(v, 0.2);
  EXPECT_NEAR(scene.own(), 0.5 * LoneCube::kShare * v * v, 0.03 * scene.own());
}

}  // namespace
}  // namespace tandem
