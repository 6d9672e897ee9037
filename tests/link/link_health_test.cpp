#include "coordination/src/link/link_health.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/refusal.h"

namespace tandem {
namespace {

constexpr double kPacket = 1.0 / 128.0;
constexpr double kTick = 1e-3;

/// Health of a peer that was last heard at time 0, checked once at `age`.
LinkHealth silentFor(double age, double packet_period = kPacket, bool is_idle = false) {
  LinkHealth health({}, packet_period);
  health.hear(0.0, is_idle);
  health.update(age, true);
  return health;
}

/// Checks at each tick from `from` to `until`, while packets arrive in time.
void keepAlive(LinkHealth& health, double from, double until, bool place_is_free = true) {
  double next_packet = from;
  for (double t = from; t < until; t += kTick) {
    if (t >= next_packet) health.hear(t, false), next_packet += kPacket;
    health.update(t, place_is_free);
  }
}

TEST(LinkHealth, EachRowOfTheTable) {
  for (const double age : {0.0, 0.01, 0.0249}) {
    const LinkHealth live = silentFor(age);
    EXPECT_EQ(live.state(), LinkState::kLive);
    EXPECT_EQ(live.objectShare(), 1.0);
    EXPECT_EQ(live.proxyShare(), 1.0);
    EXPECT_EQ(live.velocityShare(), 1.0);
    EXPECT_EQ(live.silence(), 0.0);
    EXPECT_FALSE(live.isProxyOut());
  }
  for (const double age : {0.03, 0.06, 0.0999}) {
    const LinkHealth stale = silentFor(age);
    EXPECT_EQ(stale.state(), LinkState::kStale);
    EXPECT_EQ(stale.objectShare(), 1.0);
    EXPECT_EQ(stale.proxyShare(), 1.0);
    EXPECT_NEAR(stale.velocityShare(), std::exp(-(age - 0.025) / 0.02), 1e-15);
  }
  for (const double age : {0.13, 0.175, 0.24}) {
    const LinkHealth fading = silentFor(age);
    EXPECT_EQ(fading.state(), LinkState::kFading);
    EXPECT_NEAR(fading.objectShare(), (0.25 - age) / 0.15, 1e-15);
    EXPECT_EQ(fading.proxyShare(), fading.objectShare());
    EXPECT_NEAR(fading.silence(), 1.0 - fading.proxyShare(), 1e-15);
    EXPECT_FALSE(fading.isProxyOut());
  }
  for (const double age : {0.2501, 1.0, 1e6}) {
    const LinkHealth lost = silentFor(age);
    EXPECT_EQ(lost.state(), LinkState::kLost);
    EXPECT_EQ(lost.objectShare(), 0.0);
    EXPECT_EQ(lost.proxyShare(), 0.0);
    EXPECT_EQ(lost.velocityShare(), 0.0);
    EXPECT_TRUE(lost.isProxyOut());
  }
}

TEST(LinkHealth, BoundariesBelongToTheLaterRowUntilTheGainsAreZero) {
  EXPECT_EQ(silentFor(std::nextafter(0.025, 0.0)).state(), LinkState::kLive);
  EXPECT_EQ(silentFor(0.025).state(), LinkState::kStale);
  EXPECT_EQ(silentFor(0.025).velocityShare(), 1.0);
  EXPECT_EQ(silentFor(std::nextafter(0.1, 0.0)).state(), LinkState::kStale);
  EXPECT_EQ(silentFor(0.1).state(), LinkState::kFading);
  EXPECT_EQ(silentFor(0.1).proxyShare(), 1.0);
  EXPECT_EQ(silentFor(0.25).state(), LinkState::kFading);
  EXPECT_EQ(silentFor(0.25).proxyShare(), 0.0);
  EXPECT_EQ(silentFor(std::nextafter(0.25, 1.0)).state(), LinkState::kLost);
}

TEST(LinkHealth, AgesAreLongerForSlowAndIdleSenders) {
  // At 30 Hz three packets take 100 ms, four times as long as usual.
  EXPECT_EQ(silentFor(0.09, 1.0 / 30.0).state(), LinkState::kLive);
  EXPECT_EQ(silentFor(0.39, 1.0 / 30.0).state(), LinkState::kStale);
  EXPECT_EQ(silentFor(0.7, 1.0 / 30.0).state(), LinkState::kFading);
  EXPECT_NEAR(silentFor(0.7, 1.0 / 30.0).proxyShare(), 0.5, 1e-12);
  EXPECT_EQ(silentFor(1.01, 1.0 / 30.0).state(), LinkState::kLost);
  // An idle peer sends every 1/16 s, so the limit is 7.5 times longer.
  EXPECT_EQ(silentFor(0.187, kPacket, true).state(), LinkState::kLive);
  EXPECT_EQ(silentFor(0.188, kPacket, true).state(), LinkState::kStale);
  EXPECT_EQ(silentFor(1.875, kPacket, true).state(), LinkState::kFading);
  EXPECT_EQ(silentFor(1.876, kPacket, true).state(), LinkState::kLost);
  // A faster sender gets the same limit, not a shorter one.
  EXPECT_EQ(silentFor(0.0249, 1e-3).state(), LinkState::kLive);
}

TEST(LinkHealth, SaysSinceWhenItIsNotIdleAnyMore) {
  LinkHealth health({}, kPacket);
  health.hear(0.0, true);
  health.hear(0.1, false);
  health.update(0.13, true);
  EXPECT_EQ(health.state(), LinkState::kStale);
}

TEST(LinkHealth, CountsAsLiveBeforeTheFirstPacketOrWaitsForIt) {
  LinkHealth live({}, kPacket);
  live.update(100.0, true);
  EXPECT_EQ(live.state(), LinkState::kLive);
  EXPECT_EQ(live.proxyShare(), 1.0);
  EXPECT_FALSE(live.hear(100.0, false));
  live.update(100.001, true);
  EXPECT_EQ(live.state(), LinkState::kLive);

  LinkLossSettings settings;
  settings.start_live = false;
  LinkHealth waiting(settings, kPacket);
  for (const double t : {0.0, 0.1, 10.0}) {
    waiting.update(t, true);
    EXPECT_EQ(waiting.state(), LinkState::kWaiting);
    EXPECT_TRUE(waiting.isProxyOut());
    EXPECT_EQ(waiting.objectShare() + waiting.proxyShare(), 0.0);
  }
  EXPECT_TRUE(waiting.hear(10.0, false));
  EXPECT_EQ(waiting.state(), LinkState::kRejoining);
  EXPECT_EQ(waiting.proxyShare(), 0.0);
  EXPECT_EQ(waiting.counters().rejoined, 1u);
  EXPECT_EQ(waiting.counters().lost, 0u);
}

TEST(LinkHealth, AwaitsAPeerThatIsForgotten) {
  LinkHealth health({}, kPacket);
  EXPECT_FALSE(health.hear(1.0, false));
  health.await();
  health.update(1.001, true);
  EXPECT_EQ(health.state(), LinkState::kWaiting);
  EXPECT_TRUE(health.isProxyOut());
  EXPECT_EQ(health.objectShare() + health.proxyShare(), 0.0);
  EXPECT_TRUE(health.hear(1.1, false));
  EXPECT_EQ(health.state(), LinkState::kRejoining);
}

TEST(LinkHealth, RampsInOverHalfASecondAfterALoss) {
  LinkHealth health = silentFor(2.0);
  EXPECT_TRUE(health.hear(2.0, false));
  health.update(2.0, true);
  EXPECT_EQ(health.state(), LinkState::kRejoining);
  EXPECT_FALSE(health.isProxyOut());
  EXPECT_EQ(health.proxyShare(), 0.0);
  keepAlive(health, 2.0, 2.25);
  EXPECT_NEAR(health.proxyShare(), 0.5, 1.01 * kTick / 0.5);  // accurate to the last tick
  EXPECT_EQ(health.objectShare(), health.proxyShare());
  EXPECT_EQ(health.state(), LinkState::kRejoining);
  keepAlive(health, 2.25, 2.51);
  EXPECT_EQ(health.state(), LinkState::kLive);
  EXPECT_EQ(health.proxyShare(), 1.0);
}

TEST(LinkHealth, ProxyIsNotLetInWhereSomethingIs) {
  LinkHealth health = silentFor(2.0);
  health.hear(2.0, false);
  keepAlive(health, 2.0, 5.0, false);
  EXPECT_EQ(health.state(), LinkState::kRejoining);
  EXPECT_TRUE(health.isProxyOut());
  EXPECT_EQ(health.proxyShare(), 0.0);
  EXPECT_EQ(health.objectShare(), 1.0);  // objects do not block each other
  keepAlive(health, 5.0, 5.1, true);
  EXPECT_FALSE(health.isProxyOut());
  EXPECT_NEAR(health.proxyShare(), 0.2, 5e-3);
  // A user who came in stays in. Walking into something then meets gains that are still small.
  keepAlive(health, 5.1, 5.6, false);
  EXPECT_EQ(health.state(), LinkState::kLive);
}

TEST(LinkHealth, RampWaitsWhileNothingIsHeard) {
  LinkHealth health = silentFor(2.0);
  health.hear(2.0, false);
  health.update(2.0, true);
  health.update(2.09, true);
  EXPECT_EQ(health.state(), LinkState::kStale);
  EXPECT_NEAR(health.proxyShare(), 0.05, 1e-12);  // 25 ms of 500
  EXPECT_FALSE(health.hear(2.09, false));
  health.update(2.1, true);
  EXPECT_NEAR(health.proxyShare(), 0.07, 1e-12);
}

TEST(LinkHealth, ComesBackFromFadingWhereItWas) {
  LinkHealth health = silentFor(0.19);
  const double share = health.proxyShare();
  EXPECT_NEAR(share, 0.4, 1e-12);
  EXPECT_FALSE(health.hear(0.19, false));
  EXPECT_EQ(health.proxyShare(), share);
  EXPECT_EQ(health.state(), LinkState::kRejoining);
  EXPECT_EQ(health.silence(), 0.0);
  EXPECT_FALSE(health.isProxyOut());
  keepAlive(health, 0.19, 0.5);
  EXPECT_EQ(health.state(), LinkState::kLive);  // after 0.3 s
  EXPECT_EQ(health.counters().rejoined, 0u);
}

TEST(LinkHealth, CountsOnceEach) {
  LinkHealth health({}, kPacket);
  double t = 0.0;
  for (int i = 0; i < 3; ++i) {
    health.hear(t, false);
    for (int k = 0; k < 400; ++k) health.update(t += kTick, true);
  }
  EXPECT_EQ(health.counters().faded, 3u);
  EXPECT_EQ(health.counters().lost, 3u);
  EXPECT_EQ(health.counters().rejoined, 2u);
}

TEST(LinkHealth, OverdueFromStaleOn) {
  LinkHealth health({}, kPacket);
  EXPECT_FALSE(health.isOverdue(10.0));  // nothing was ever heard, so nothing is overdue
  health.hear(1.0, false);
  EXPECT_FALSE(health.isOverdue(1.02));
  EXPECT_TRUE(health.isOverdue(1.03));
  EXPECT_NEAR(health.computeAge(1.03), 0.03, 1e-15);
  EXPECT_EQ(health.computeAge(0.5), 0.0);
}

TEST(LinkHealth, OffIsLiveForEver) {
  LinkLossSettings settings;
  settings.enabled = false;
  settings.start_live = false;
  LinkHealth health(settings, kPacket);
  EXPECT_FALSE(health.hear(0.0, false));
  health.update(1e6, false);
  EXPECT_EQ(health.state(), LinkState::kLive);
  EXPECT_EQ(health.objectShare(), 1.0);
  EXPECT_EQ(health.proxyShare(), 1.0);
  EXPECT_FALSE(health.isOverdue(1e6));
}

TEST(LinkHealth, SharesNeverJumpAndStayBetween0And1) {
  constexpr std::uint64_t kSeed = 17;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  LinkHealth health({}, kPacket);
  health.hear(0.0, false);
  double next = 0.0, proxy = 1.0, object = 1.0;
  // Falling is the fastest change: from 1 to 0 in 150 ms.
  const double most = kTick / 0.15 + 1e-9;
  for (int i = 1; i < 60'000; ++i) {
    const double t = i * kTick;
    if (t >= next) {
      health.hear(t, false);
      next = t + random.logUniform(0.005, 1.0);
    }
    health.update(t, random.uniform(0, 1) < 0.1);
    EXPECT_LE(std::abs(health.proxyShare() - proxy), most) << t;
    EXPECT_LE(std::abs(health.objectShare() - object), most) << t;
    proxy = health.proxyShare(), object = health.objectShare();
    ASSERT_TRUE(proxy >= 0.0 && proxy <= 1.0 && object >= 0.0 && object <= 1.0) << t;
    if (health.isProxyOut()) {
      EXPECT_EQ(proxy, 0.0);
    }
  }
  EXPECT_GT(health.counters().rejoined, 3u);
}

TEST(LinkHealth, RestDampingKeepsTheDampingRatio) {
  const CouplerGains weak{200.0, 1.0}, strong{200.0, 30.0}, none{0.0, 0.0};
  EXPECT_EQ(computeRestDamping(strong, 0.1, 0.02), 30.0);
  EXPECT_NEAR(computeRestDamping(weak, 0.1, 0.02), 2.0 * std::sqrt(20.0), 1e-12);
  EXPECT_EQ(computeRestDamping(none, 0.1, 0.02), 5.0);
  for (const CouplerGains& gains : {weak, strong}) {
    const double rest = computeRestDamping(gains, 0.1, 0.02);
    const auto ratio = [&](double s) {
      return (s * gains.damping + (1.0 - s) * rest) / (2.0 * std::sqrt(s * gains.stiffness * 0.1));
    };
    for (double s = 0.01; s <= 1.0; s += 0.01)
      EXPECT_GE(ratio(s), std::min(1.0, ratio(1.0)) - 1e-9);
  }
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(LinkHealth, RefusesSettingsByName) {
  const auto refuses = [](auto spoil, const char* name) {
    const std::string refusal = test::refusalOf(&checkLinkLossSettings, spoil);
    EXPECT_NE(refusal.find(name), std::string::npos) << name << ": " << refusal;
  };
  EXPECT_NO_THROW(checkLinkLossSettings({}));
  refuses([](auto& s) { s.stale_after = 0.0; }, "stale_after");
  refuses([](auto& s) { s.fade_after = 0.02; }, "fade_after");
  refuses([](auto& s) { s.lost_after = 0.1; }, "lost_after");
  refuses([](auto& s) { s.lost_after = kInfinite; }, "lost_after");
  refuses([](auto& s) { s.hold_decay = -1.0; }, "hold_decay");
  refuses([](auto& s) { s.ramp_in = std::nan(""); }, "ramp_in");
  refuses([](auto& s) { s.rejoin_overlap = -1e-3; }, "rejoin_overlap");
}

TEST(LinkHealth, StatesHaveNames) {
  EXPECT_EQ(nameOf(LinkState::kWaiting), "waiting");
  EXPECT_EQ(nameOf(LinkState::kLive), "live");
  EXPECT_EQ(nameOf(LinkState::kStale), "stale");
  EXPECT_EQ(nameOf(LinkState::kFading), "fading");
  EXPECT_EQ(nameOf(LinkState::kLost), "lost");
  EXPECT_EQ(nameOf(LinkState::kRejoining), "rejoining");
}

}  // namespace
}  // namespace tandem
