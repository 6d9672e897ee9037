// Bodies in joints for a minute, at sites 50 ms apart: no energy comes or goes, no pin opens.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "physics/joint_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::JointHost;

constexpr double kDelay = 0.05;  // [s]
/// A copy carries half of the mass, and has half of the energy [J].
constexpr double kUnit = 0.5 * JointHost::kUnit;
constexpr double kSpeed = 2.0;  // of a door [rad/s]
constexpr double kMotion = 0.5 * kSpeed * kSpeed *
                           (0.5 * JointHost::kMass * JointHost::kLength * JointHost::kLength / 3.0);
const Vec3 kPin_B(-0.5 * JointHost::kLength, 0.0, 0.0);

/// Two hosts with a copy of one link on a hinge.
class DistantLinks {
 public:
  /// A hinge along y makes a pendulum, one along z a door. They start at `speed` [rad/s].
  DistantLinks(const Vec3& axis_W, double speed, const CouplerGains& coordination) {
    for (std::size_t i = 0; i < 2; ++i) {
      btRigidBody& link = hosts_[i].addLink(-kPin_B);
      hosts_[i].join<btHingeConstraint>(link, toBullet(kPin_B), toBullet(axis_W));
      link.setAngularVelocity(toBullet(Vec3(speed * axis_W)));
      link.setLinearVelocity(toBullet(Vec3(speed * axis_W.cross(-kPin_B))));
      SiteSettings settings;
      settings.self = PeerId{static_cast<std::uint32_t>(i) + 1};
      hosts_[i].share(link, settings, coordination);
      hosts_[i].site->connect(PeerId{static_cast<std::uint32_t>(2 - i)}, links_[i], Vec3(0, 15, 5));
    }
    before_ = hosts_[0].energy();
  }

  void run(double duration, double rate) {
    for (int step = 0; step < static_cast<int>(duration * rate); ++step)
      for (std::size_t i = 0; i < 2; ++i) {
        hosts_[i].rig.step(1.0 / rate);
        for (const StatePacket& packet : links_[i].sent)
          links_[1 - i].arrivals.push_back({packet, packet.time + kDelay});
        links_[i].sent.clear();
        most = std::max(most, hosts_[i].energy() - before_);
        least = std::min(least, hosts_[i].energy() - before_);
        off = std::max(off, JointHost::gap(*hosts_[i].links[0], kPin_B, Vec3::Zero()));
      }
  }
  [[nodiscard]] std::uint64_t packetsTaken() const {
    return hosts_[0].site->counters().packets_taken;
  }

  double most = 0.0, least = 0.0;  ///< energy beyond that of the start [J]
  double off = 0.0;                ///< of the pin [m]

 private:
  JointHost hosts_[2];
  test::FakeLink links_[2] = {test::FakeLink(4096), test::FakeLink(4096)};
  double before_ = 0.0;
};

class JointsForAMinute : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(HostRates, JointsForAMinute, ::testing::Values(60.0, 240.0, 1000.0));

// Without coordination nothing takes energy out: it stays within 1e-4, up and down.
TEST_P(JointsForAMinute, ADistantPendulumKeepsItsEnergy) {
  DistantLinks pendulums(Vec3::UnitY(), 0.0, {});
  pendulums.run(60.0, GetParam());
  EXPECT_GT(pendulums.packetsTaken(), 5000u);
  EXPECT_LT(pendulums.most, 1e-4 * kUnit);
  EXPECT_GT(pendulums.least, -1e-4 * kUnit);
  EXPECT_LT(pendulums.off, 1e-6);
}

TEST_P(JointsForAMinute, ADistantDoorKeepsItsEnergy) {
  DistantLinks doors(Vec3::UnitZ(), kSpeed, {});
  doors.run(60.0, GetParam());
  EXPECT_LT(doors.most, 1e-4 * kMotion);
  EXPECT_GT(doors.least, -1e-4 * kMotion);
  EXPECT_LT(doors.off, 1e-6);
}

// With coordination the copies pull each other to where they were: it may only take energy out.
TEST_P(JointsForAMinute, CoordinatedPendulumsGainNoEnergy) {
  DistantLinks pendulums(Vec3::UnitY(), 0.0, {50.0, 3.0});
  pendulums.run(60.0, GetParam());
  EXPECT_LT(pendulums.most, 1e-4 * kUnit);
  EXPECT_LT(pendulums.off, 1e-6);
}

TEST_P(JointsForAMinute, CoordinatedDoorsGainNoEnergy) {
  DistantLinks doors(Vec3::UnitZ(), kSpeed, {50.0, 3.0});
  doors.run(60.0, GetParam());
  EXPECT_LT(doors.most, 1e-4 * kMotion);
  EXPECT_LT(doors.off, 1e-6);
}

}  // namespace
}  // namespace tandem
