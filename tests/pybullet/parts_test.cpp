// Parts of the plugin that need no server.

#include <gtest/gtest.h>

#include "plugin/doors/pybullet/gyroscope.h"
#include "plugin/doors/pybullet/packet_doubles.h"
#include "plugin/doors/pybullet/refusal.h"
#include "plugin/doors/pybullet/words.h"
#include "support/random.h"

namespace tandem::pybullet {
namespace {

TEST(WordsOfACommand, ReadWhatStandsThere) {
  Words words("  site  name=\"two words\" at=1,-2.5e-3,3 on=1 n=7 ");
  EXPECT_EQ(words.name(), "site");
  EXPECT_EQ(words.text("name"), "two words");
  double at[3]{};
  words.numbers("at", at, 3);
  EXPECT_EQ(at[1], -2.5e-3);
  EXPECT_TRUE(words.flag("on", false));
  EXPECT_EQ(words.integer("n"), 7);
  EXPECT_EQ(words.number("none", 4.0), 4.0);
  words.finish();
}

TEST(WordsOfACommand, KeepAllDigits) {
  Words words("a x=0.1 y=0.30000000000000004 z=5e-324");
  EXPECT_EQ(words.number("x"), 0.1);
  EXPECT_EQ(words.number("y"), 0.1 + 0.2);
  EXPECT_EQ(words.number("z"), 5e-324);
}

class Gyro : public ::testing::TestWithParam<GyroLaw> {};

TEST_P(Gyro, VelocityBeforeBecomesTheTarget) {
  constexpr std::uint64_t kSeed = 7;
  test::Random random(kSeed);
  for (int i = 0; i < 200; ++i) {
    const Vec3 inertia(random.logUniform(1e-5, 1e-3), random.logUniform(1e-5, 1e-3), 5e-4);
    // A real body: no moment is larger than the sum of the others.
    const Vec3 real = (inertia.sum() - inertia.array()).matrix();
    const Quat R_WB = random.rotation();
    const Vec3 target = random.inCube(10.0);
    const double dt = 1.0 / 60.0;
    const Vec3 before = computeVelocityBefore(GetParam(), real, R_WB, target, dt);
    const Vec3 after = applyGyroLaw(GetParam(), real, R_WB, before, dt);
    EXPECT_LT((after - target).norm(), 1e-9 * target.norm()) << "seed " << kSeed << ", case " << i;
  }
}

// Euler's equation; both laws differ from it by order dt^2.
TEST_P(Gyro, IsEulersEquation) {
  const Vec3 inertia(5e-5, 2.6e-4, 2.9e-4), w(3, 5, 7);
  const Vec3 acceleration = -w.cross(Vec3(inertia.cwiseProduct(w))).cwiseQuotient(inertia);
  const double dt = 1e-5;
  const Vec3 change = applyGyroLaw(GetParam(), inertia, Quat::Identity(), w, dt) - w;
  EXPECT_LT((change / dt - acceleration).norm(), 1e-3 * acceleration.norm());
}

TEST_P(Gyro, LeavesACubeAlone) {
  const Vec3 w(3, 5, 7);
  EXPECT_EQ(computeVelocityBefore(GetParam(), Vec3::Constant(1e-4), Quat::Identity(), w, 0.01), w);
}
INSTANTIATE_TEST_SUITE_P(Laws, Gyro, ::testing::Values(GyroLaw::kExplicit, GyroLaw::kImplicit));

TEST(PacketDoubles, GiveThePacketBack) {
  TandemPacket packet{};
  packet.sender = 4294967295U;
  packet.sequence = 1ULL << 50U;
  packet.time = 0.1;
  packet.energy_granted = 3.0;
  packet.energy_holdings = -2.0;
  packet.object_count = TANDEM_MAX_OBJECTS_PER_PACKET;
  for (std::uint32_t i = 0; i < packet.object_count; ++i) {
    packet.object_ids[i] = 100 + i;
    packet.objects[i].orientation[3] = 1.0;
    packet.objects[i].angular_velocity[2] = i;
    packet.object_epochs[i] = 4294967295U - i;
    packet.object_epoch_authors[i] = i;
  }
  const TandemPacket back = toPacket(toDoubles(packet));
  EXPECT_EQ(toDoubles(back), toDoubles(packet));
  EXPECT_EQ(back.objects[7].angular_velocity[2], 7.0);
  EXPECT_EQ(back.object_epochs[0], 4294967295U);
  EXPECT_EQ(back.object_epoch_authors[7], 7U);
}

TEST(PacketDoubles, GiveARollBack) {
  for (const int has_grip : {0, 1}) {
    TandemPacket packet{};
    packet.has_grip = has_grip;
    packet.roll_heard = 0x8000000100000003U;
    packet.roll_members = 1U;
    packet.roll_age = 0.25;
    const TandemPacket back = toPacket(toDoubles(packet));
    EXPECT_EQ(back.has_grip, has_grip);
    EXPECT_EQ(back.roll_heard, packet.roll_heard);
    EXPECT_EQ(back.roll_members, packet.roll_members);
    EXPECT_EQ(back.roll_age, 0.25);
  }
}

TEST(PacketDoubles, RefuseWhatIsNone) {
  const std::vector<double> good = toDoubles(TandemPacket{});
  for (const auto& [at, value] : {std::pair{0, -1.0},
                                  {0, 0.5},
                                  {0, 1e10},
                                  {2, 1e17},
                                  {12, 9.0},
                                  {12, 1.0},
                                  {12, std::numeric_limits<double>::quiet_NaN()}}) {
    std::vector<double> bad = good;
    bad[static_cast<std::size_t>(at)] = value;
    EXPECT_THROW((void)toPacket(bad), Refusal) << at << " " << value;
  }
  EXPECT_THROW((void)toPacket({}), Refusal);
}

}  // namespace
}  // namespace tandem::pybullet
