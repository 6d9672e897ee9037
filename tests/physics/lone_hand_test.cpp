// A hand alone at a fixed wall, with nobody connected, must not get energy from nowhere.

#include <cmath>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/metered_device.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::MeteredDevice;

constexpr double kPeriod = 1e-3;
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kTank = PassivitySettings{}.tank;

/// A strong hand that swings along x and holds the handle by a spring and damper.
class SwingingHand final : public Hand {
 public:
  SwingingHand(double amplitude, double frequency)
      : amplitude_(amplitude), w_(2.0 * M_PI * frequency) {}
  Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    const Vec3 p_W(amplitude_ * std::sin(w_ * t), 0, 0);
    const Vec3 v_W(amplitude_ * w_ * std::cos(w_ * t), 0, 0);
    return 400.0 * (p_W - handle.p_W) + 5.0 * (v_W - handle.v_W);
  }

 private:
  double amplitude_, w_;
};

/// A site alone with a wall, whose face is at x = 0.
struct LoneHand {
  double amplitude = 0.5;  ///< of the swing [m]
  double frequency = 0.5;  ///< [Hz]
  CouplerGains contact{500.0, 1.0};
  double max_slew = SiteSettings{}.max_slew;
  double max_force = kInf;  ///< of the device [N]
  bool keeps_account = true;

  std::string text() const {
    std::ostringstream text;
    text << "swing " << amplitude << " m at " << frequency << " Hz, K " << contact.stiffness
         << ", b " << contact.damping << ", slew " << max_slew << ", limit " << max_force;
    return text.str();
  }

  /// The most energy that the hand ever had from the wall in `duration` [J].
  double run(double duration) const {
    BulletRig rig;
    rig.addCube(0.0, 2.0, Vec3(2.0, 0, 0));
    SimulatedDeviceSettings handle;
    handle.max_force = max_force;
    handle.start_W = Vec3(-0.05, 0, 0);
    SimulatedDevice simulated(handle, std::make_unique<SwingingHand>(amplitude, frequency));
    MeteredDevice device(simulated);
    SiteSettings settings;
    settings.tick_source = TickSource::kCaller;
    settings.contact = contact;
    settings.max_slew = max_slew;
    settings.passivity.enabled = keeps_account;
    Site site(settings, rig.world, device);
    double most = 0.0;
    const long ticks = std::lround(duration / kPeriod);
    for (long tick = 0; tick < ticks; ++tick) {
      site.tick(static_cast<double>(tick) * kPeriod);
      most = std::max(most, -device.putIn());
      if (tick % 4 == 3) rig.step(4.0 * kPeriod);
    }
    return most;
  }
};

// The case of the report: 5674 J in 20 s.
TEST(LoneHandAtAWall, GetsNothingFromASlewLimit) {
  LoneHand hand{.amplitude = 1.0};
  EXPECT_LE(hand.run(20.0), kTank);
}

// K T / 2 > b: the sampled wall itself gives energy, 11 to 21 J in 20 s without an account.
TEST(LoneHandAtAWall, GetsNoMoreThanTheTankFromSampling) {
  LoneHand hand{.amplitude = 1.0, .contact = {4000.0, 1.0}, .max_slew = kInf};
  EXPECT_LE(hand.run(20.0), kTank);
  hand.keeps_account = false;
  EXPECT_GT(hand.run(20.0), 10.0 * kTank);
}

TEST(LoneHandAtAWall, GetsNoMoreThanTheTankWhateverIsSet) {
  constexpr std::uint64_t kSeed = 44;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const auto draw = [&](double low, double high) {
    return low * std::pow(high / low, random.uniform(0.0, 1.0));
  };
  for (int i = 0; i < 60; ++i) {
    LoneHand hand;
    hand.amplitude = draw(0.1, 1.0);
    hand.frequency = draw(0.2, 3.0);
    hand.contact = {draw(500.0, 8000.0), draw(0.5, 10.0)};
    hand.max_slew = random.below(4) == 0 ? kInf : draw(500.0, 1e5);
    hand.max_force = random.below(3) == 0 ? kInf : draw(2.0, 60.0);
    SCOPED_TRACE(hand.text());
    EXPECT_LE(hand.run(60.0), kTank);
  }
}

}  // namespace
}  // namespace tandem
