#include "device/emulated_user.h"

#include <cmath>
#include <numbers>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/falcon/simulated_device.h"

namespace tandem::demos {
namespace {

constexpr double kDamping = 12.0;      // damping of the hand [N s/m]
constexpr double kHomingPeriod = 1.6;  // one motion out and in [s]
constexpr double kOut = 0.045,
                 kIn = -0.02;      // ends of the motion from the middle, towards the user [m]
constexpr double kReturn = 0.8;    // way back to the middle [s]
constexpr double kFirstDip = 1.5;  // after homing [s]

/// A smooth wave: 0 at the beginning of a period, 1 in its middle.
double wave(double t, double period) {
  return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * t / period);
}

double homingWay(double t) { return kIn + (kOut - kIn) * wave(t, kHomingPeriod); }

}  // namespace

/// The hand. It uses the monotonic clock, as the emulator does.
class EmulatedUser::Helper final : public Hand {
 public:
  Helper(const std::atomic<double>& homed_at, UserWish wish) : homed_at_(homed_at), wish_(wish) {}

  Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    return kStiffness * (computeGoal(t) - handle.p_W) - kDamping * handle.v_W;
  }

 private:
  [[nodiscard]] Vec3 computeGoal(double t) const noexcept {
    const double homed_at = homed_at_.load(std::memory_order_relaxed);
    if (homed_at < 0.0) return {0.0, 0.0, homingWay(t)};
    const double since = t - homed_at;
    if (since < kReturn)
      return {0.0, 0.0, homingWay(homed_at) * (1.0 - wave(std::max(since, 0.0), 2.0 * kReturn))};
    if (wish_ == UserWish::kRest || since < kFirstDip) return Vec3::Zero();
    const double way = -kDip * wave(since - kFirstDip, kDipPeriod);
    return wish_ == UserWish::kDip ? Vec3(0.0, way, 0.0) : Vec3(0.0, 0.0, way);
  }

  const std::atomic<double>& homed_at_;
  UserWish wish_;
};

EmulatedUser::EmulatedUser(UserWish wish)
    : port_(std::make_unique<EmulatedFalconPort>(std::make_unique<Helper>(homed_at_, wish))) {}

EmulatedUser::~EmulatedUser() = default;

void EmulatedUser::tellHomed() noexcept {
  if (homed_at_.load(std::memory_order_relaxed) < 0.0)
    homed_at_.store(readMonotonicClock(), std::memory_order_relaxed);
}

Vec3 EmulatedUser::pushNow() { return port_->readForce(); }

double EmulatedUser::mostFelt() { return port_->readMostForce(); }

}  // namespace tandem::demos
