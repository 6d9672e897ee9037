// More than two sites: each has links to all others, and each copy has couplers to all other
// copies.

#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;

constexpr double kMass = 0.8, kHalf = 0.02;  // mass [kg] and half edge [m] of the whole cube
constexpr double kPeriod = 1e-3, kHostStep = 4e-3, kPacketRate = 500.0;

/// N sites around a circle share a cube in its middle; no hand touches it.
class Party {
 public:
  Party(int agreed, int present, double delay, CoordinationMode mode = CoordinationMode::kSum) {
    for (int i = 0; i < present; ++i) {
      users_.push_back(std::make_unique<User>(startOf(i, agreed)));
      SiteSettings settings;
      settings.self = idOf(i);
      settings.peers = agreed;
      settings.coordination_mode = mode;
      settings.packet_rate = kPacketRate;
      settings.host_step = kHostStep;
      settings.tick_source = TickSource::kCaller;
      User& user = *users_.back();
      user.cube = &user.rig.addCube(kMass, kHalf);
      user.site = std::make_unique<Site>(settings, user.rig.world, user.device);
      user.site->share(*user.cube);
    }
    for (int i = 0; i < present; ++i) {
      for (int k = i + 1; k < present; ++k) {
        auto [one, other] = makeSimulatedLinks({delay});
        user(i).site->connect(idOf(k), *one, startOf(k, agreed));
        user(k).site->connect(idOf(i), *other, startOf(i, agreed));
        links_.push_back(std::move(one));
        links_.push_back(std::move(other));
      }
    }
  }

  /// Runs with `force_W` on the first site's copy, applied by its host.
  void run(double seconds, const Vec3& force_W) {
    for (int step = 0; step < std::lround(seconds / kHostStep); ++step) {
      for (int tick = 0; tick < 4; ++tick) {
        for (auto& user : users_)
          EXPECT_EQ(user->site->tick(static_cast<double>(ticks_) * kPeriod), kTickOk);
        ++ticks_;
      }
      user(0).cube->activate();
      user(0).cube->applyCentralForce(toBullet(force_W));
      for (auto& user : users_) user->rig.step(kHostStep);
    }
  }

  [[nodiscard]] const RigidState& copy(int i) const { return users_[i]->site->object(0); }
  [[nodiscard]] double computeSpread() const {
    double spread = 0.0;
    for (std::size_t i = 1; i < users_.size(); ++i)
      spread = std::max(spread, (copy(static_cast<int>(i)).p_W - copy(0).p_W).norm());
    return spread;
  }

 private:
  struct User {
    explicit User(const Vec3& start_W) : device(start_W) {}
    ~User() { site.reset(); }
    BulletRig rig;
    FakeDevice device;
    btRigidBody* cube = nullptr;
    std::unique_ptr<Site> site;
  };
  static PeerId idOf(int i) { return PeerId{static_cast<std::uint32_t>(i) + 1}; }
  static Vec3 startOf(int i, int count) {
    const double angle = 6.28318530717958648 * i / count;
    return {0.0, 0.5 * std::cos(angle), 0.5 * std::sin(angle)};
  }
  User& user(int i) { return *users_[static_cast<std::size_t>(i)]; }

  std::vector<std::unique_ptr<SimulatedLink>> links_;
  std::vector<std::unique_ptr<User>> users_;
  std::uint64_t ticks_ = 0;
};

class ManyPeers : public ::testing::TestWithParam<int> {};

/// Speed of all copies while the first is pushed: the delay of the couplers holds them back.
void expectSpeed(int n, CoordinationMode mode, double couplers) {
  constexpr double kForce = 0.4, kDelay = 0.02, kStiffness = 200.0;
  Party party(n, n, kDelay, mode);
  party.run(4.0, Vec3(kForce, 0, 0));
  const double age = kDelay + 0.5 / kPacketRate;
  const double speed = kForce / (couplers * kStiffness * age);
  for (int i = 0; i < n; ++i) EXPECT_NEAR(party.copy(i).v_W.x(), speed, 0.03 * speed) << i;
}

// Each of the N (N - 1) couplers pulls back by K v tau. Its target is as old as the delay plus half
// a packet period. A pushed cube reaches the speed at which the sum equals the push.
TEST_P(ManyPeers, MoveAtTheSpeedAtWhichDelayHoldsThemBack) {
  expectSpeed(GetParam(), CoordinationMode::kSum, GetParam() * (GetParam() - 1));
}

// By average, each coupler has 1/N of K.
TEST_P(ManyPeers, MoveNTimesAsFastByAverage) {
  expectSpeed(GetParam(), CoordinationMode::kAverage, GetParam() - 1);
}

// One copy is pushed for a while. All follow over the network and come to rest at one place.
TEST_P(ManyPeers, CopiesMeetAgain) {
  const int n = GetParam();
  Party party(n, n, 0.02);
  party.run(0.5, Vec3(0.4, 0, 0));
  EXPECT_GT(party.copy(n - 1).p_W.x(), 2e-4);
  party.run(3.0, Vec3::Zero());
  EXPECT_LT(party.computeSpread(), 1e-4);
  for (int i = 0; i < n; ++i) EXPECT_LT(party.copy(i).v_W.norm(), 0.02) << i;
}

// The mass of a copy does not depend on which peers are online.
TEST_P(ManyPeers, MassIsSharedByAllThatWereAgreedOn) {
  const int n = GetParam();
  Party alone(n, 1, 0.0);
  alone.run(0.1, Vec3(0.4, 0, 0));
  const double lag = 2.0 * kHostStep;  // largest delay of the host's force
  EXPECT_LE(alone.copy(0).v_W.x(), 0.4 * n / kMass * 0.1 + 1e-6);
  EXPECT_GE(alone.copy(0).v_W.x(), 0.4 * n / kMass * (0.1 - lag) - 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ManyPeers, ::testing::Values(2, 3, 4, 8));

}  // namespace
}  // namespace tandem
