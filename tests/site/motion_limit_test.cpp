// Private header of the plugin: how far a peer's state may move.
#include "plugin/src/site/motion_limit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "plugin/src/site/shorten.h"

namespace tandem {
namespace {

constexpr double kFastest = 20.0;        // [m/s]
constexpr double kPacket = 1.0 / 128.0;  // [s]

TEST(MotionLimit, LetsAHandMoveHoweverPacketsCome) {
  MotionLimit limit;
  // 0.5 m at 3 Hz: 9.4 m/s and 178 m/s^2. Packets come late and in bunches.
  for (int i = 0; i < 2000; ++i) {
    if (i % 7 == 3) continue;  // lost
    const double t = i * kPacket, w = 2.0 * M_PI * 3.0;
    const Vec3 p_W(0.5 * std::sin(w * t), 0, 0), v_W(0.5 * w * std::cos(w * t), 0, 0);
    ASSERT_FALSE(limit.isJump(p_W, v_W, t, std::ceil(t / 0.1) * 0.1, kFastest)) << i;
  }
}

TEST(MotionLimit, AMoveThatTheVelocityDoesNotExplainIsAJump) {
  MotionLimit limit;
  EXPECT_FALSE(limit.isJump(Vec3(5, 0, 0), Vec3::Zero(), 0.0, 0.0, kFastest));  // nothing before
  EXPECT_FALSE(limit.isJump(Vec3(5.01, 0, 0), Vec3::Zero(), kPacket, kPacket, kFastest));
  EXPECT_TRUE(limit.isJump(Vec3(6, 0, 0), Vec3::Zero(), 2 * kPacket, 2 * kPacket, kFastest));
  EXPECT_FALSE(limit.isJump(Vec3(6, 0, 0), Vec3::Zero(), 3 * kPacket, 3 * kPacket, kFastest));
}

TEST(MotionLimit, NeitherASpeedNorAClockExcusesIt) {
  MotionLimit fast;
  EXPECT_FALSE(fast.isJump(Vec3::Zero(), Vec3(1e9, 0, 0), 0.0, 0.0, kFastest));
  EXPECT_TRUE(fast.isJump(Vec3(1, 0, 0), Vec3(1e9, 0, 0), kPacket, kPacket, kFastest));
  MotionLimit late;
  EXPECT_FALSE(late.isJump(Vec3::Zero(), Vec3::Zero(), 0.0, 0.0, kFastest));
  EXPECT_TRUE(late.isJump(Vec3(10, 0, 0), Vec3::Zero(), 1e6, kPacket, kFastest));
  EXPECT_TRUE(late.isJump(Vec3(20, 0, 0), Vec3::Zero(), -1e6, 1.0, kFastest));  // back in time
}

TEST(MotionLimit, ShorteningKeepsTheBitsOfWhatIsAllowed) {
  const Vec3 v(0.1, -0.2, 0.3);
  EXPECT_EQ(shortenTo(v, 1.0), v);
  EXPECT_NEAR(shortenTo(1e6 * v, 20.0).norm(), 20.0, 1e-12);
}

}  // namespace
}  // namespace tandem
