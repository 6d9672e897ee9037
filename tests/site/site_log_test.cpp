// Private header of the plugin: status bits and the hash of a site.
#include "plugin/src/site/site_log.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "site/parts_rig.h"

namespace tandem {
namespace {

using test::kPeriod;
using test::PartsRig;

constexpr double kInf = std::numeric_limits<double>::infinity();

std::uint32_t runTick(SiteLog& log, std::uint32_t raised) {
  log.startTick();
  log.raise(raised);
  return log.endTick();
}

TEST(SiteLog, KeepsOnlyBitsThatStopTheIsland) {
  for (const std::uint32_t bit : {std::uint32_t{kDeviceInvalid}, std::uint32_t{kPacketRefused}}) {
    SiteLog log;
    EXPECT_EQ(runTick(log, bit), bit);
    EXPECT_EQ(runTick(log, kTickOk), std::uint32_t{kTickOk});
    EXPECT_FALSE(log.hasStopped());
    EXPECT_EQ(log.status(), bit);  // it was raised once
  }
  SiteLog log;
  runTick(log, kStateNotFinite);
  EXPECT_EQ(runTick(log, kDeviceInvalid), kStateNotFinite | kDeviceInvalid);
  EXPECT_EQ(runTick(log, kTickOk), std::uint32_t{kStateNotFinite});
  EXPECT_TRUE(log.hasStopped());
}

TEST(SiteLog, TakesBitsOfTheHostFromTheNextTickOn) {
  for (const std::uint32_t bit : {std::uint32_t{kBodyMissing}, std::uint32_t{kWorldGone}}) {
    SiteLog log;
    log.startTick();
    log.stop(bit);
    EXPECT_EQ(log.endTick(), std::uint32_t{kTickOk});
    EXPECT_EQ(log.status(), bit);
    EXPECT_EQ(log.isWorldGone(), bit == kWorldGone);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(runTick(log, kTickOk), bit);
    EXPECT_TRUE(log.hasStopped());
  }
  // A wrong step of the host stops nothing.
  SiteLog log;
  log.raiseFromHost(kHostStepWrong);
  EXPECT_EQ(runTick(log, kTickOk), std::uint32_t{kTickOk});
  EXPECT_EQ(log.status(), std::uint32_t{kHostStepWrong});
}

TEST(SiteLog, ReportsAMissingBodyWhileItIsMissing) {
  SiteLog log;
  log.setMissing(true);
  EXPECT_EQ(runTick(log, kTickOk), std::uint32_t{kBodyMissing});
  EXPECT_FALSE(log.hasFault());
  log.setMissing(false);
  EXPECT_EQ(runTick(log, kTickOk), std::uint32_t{kTickOk});
  EXPECT_EQ(log.status(), std::uint32_t{kBodyMissing});
}

TEST(SiteLog, HasAFaultWhileThereIsNoUsableForce) {
  const std::uint32_t faults[] = {kDeviceInvalid, kStateNotFinite, kWorldGone};
  for (const std::uint32_t bit : faults) {
    SiteLog log;
    log.startTick();
    EXPECT_FALSE(log.hasFault());
    log.raise(bit);
    EXPECT_TRUE(log.hasFault()) << bit;
  }
  SiteLog log;
  log.startTick();
  log.raise(kPacketRefused);
  EXPECT_FALSE(log.hasFault());
}

TEST(SiteLog, FindsEveryNonFiniteNumber) {
  for (const double wrong : {std::nan(""), kInf, -kInf}) {
    for (int place = 0; place < 13; ++place) {
      PartsRig rig(2);
      rig.setVelocity(0, Vec3(1, 0, 0));
      rig.setVelocity(1, Vec3(1, 0, 0));
      rig.island.advance(kPeriod);
      ASSERT_TRUE(areAwakeFinite(rig.island));
      RigidState state = rig.island.state(rig.index(1));
      double* numbers[] = {&state.p_W.x(), &state.p_W.y(),  &state.p_W.z(),  &state.v_W.x(),
                           &state.v_W.y(), &state.v_W.z(),  &state.w_W.x(),  &state.w_W.y(),
                           &state.w_W.z(), &state.q_WB.x(), &state.q_WB.y(), &state.q_WB.z(),
                           &state.q_WB.w()};
      *numbers[place] = wrong;
      rig.island.setState(rig.index(1), state);
      EXPECT_FALSE(areAwakeFinite(rig.island)) << place << " " << wrong;
    }
  }
  // Infinities that would cancel.
  PartsRig rig(1);
  rig.setVelocity(0, Vec3(kInf, -kInf, 0));
  EXPECT_FALSE(areAwakeFinite(rig.island));
}

/// Hash after ticks of a body at rest or in motion, whose x is changed by `change`.
std::uint64_t hashAfter(int ticks, double change, const Vec3& force_W = Vec3::Zero()) {
  PartsRig rig(1);
  RigidState state = rig.island.state(rig.index(0));
  state.p_W.x() += change;
  rig.island.setState(rig.index(0), state);
  for (int i = 0; i < ticks; ++i) {
    rig.log.addToHash(i * kPeriod, force_W, rig.island);
    rig.island.advance(kPeriod);
  }
  return rig.log.hash();
}

TEST(SiteLog, HashesTimeForceAndStatesToTheBit) {
  EXPECT_EQ(hashAfter(5, 0.0), hashAfter(5, 0.0));
  EXPECT_NE(hashAfter(5, 0.0), hashAfter(5, 0x1p-52));
  EXPECT_NE(hashAfter(5, 0.0), hashAfter(6, 0.0));
  EXPECT_NE(hashAfter(5, 0.0), hashAfter(5, 0.0, Vec3(0, 1e-300, 0)));
}

}  // namespace
}  // namespace tandem
