#include "bench/guest/guest_hand.h"

#include <algorithm>
#include <cmath>

namespace tandem::demos::bench {
namespace {

constexpr double kFastest = 0.5;      // of a hand that does not leap [m/s]
constexpr double kLeapPeriod = 0.05;  // [s]
constexpr double kGonePeriod = 0.06;  // [s]
constexpr double kMostForce = 30.0;   // of the device [N]

/// Energy that a leap may leave in a contact of a stiffness of 1000 N/m and 4 cm, and in the spring
/// of a proxy of 500 N/m and 0.4 m [J].
constexpr double kLeapEnergy = 0.8 + 40.0;

}  // namespace

GuestDevice::GuestDevice(GuestHand hand, std::uint64_t seed) : hand_(hand), draw_(seed, 1) {
  capabilities_.name = "guest";
  capabilities_.max_force = kMostForce;
  hip_.p_W = hand == GuestHand::kFar ? Vec3(0.0, 0.0, 3.0) : Vec3(0.0, 0.0, 0.25);
}

Vec3 GuestDevice::findGoal(double now) {
  switch (hand_) {
    case GuestHand::kFar:
      return {0.0, 0.0, 3.0};
    case GuestHand::kResting:
      return {0.02, 0.01, 0.05};
    case GuestHand::kPressing:
      return target_W_ + Vec3(0.0, 0.0, 0.005);
    case GuestHand::kFollowing:
    case GuestHand::kGone:
      return target_W_ + Vec3(0.02 * std::sin(9.0 * now), 0.0, 0.03 + 0.02 * std::cos(7.0 * now));
    case GuestHand::kJumping:
      break;
  }
  if (now < next_leap_) return hip_.p_W;
  next_leap_ = now + kLeapPeriod;
  work_ += kLeapEnergy;
  return hip_.p_W = Vec3(draw_.even(-0.15, 0.15), draw_.even(-0.15, 0.15), draw_.even(0.0, 0.15));
}

DeviceSample GuestDevice::read(double now) noexcept {
  const double dt = std::clamp(now - last_, 0.0, 0.1);
  last_ = now;
  const Vec3 goal = findGoal(now);
  const Vec3 way = goal - hip_.p_W;
  const double most = kFastest * dt;
  const Vec3 move = way.norm() > most ? Vec3(way * (most / way.norm())) : way;
  hip_.p_W += move;
  hip_.v_W = dt > 0.0 ? Vec3(move / dt) : Vec3::Zero();
  work_ += std::max(0.0, -f_W_.dot(move));
  const bool is_gone = hand_ == GuestHand::kGone && std::fmod(now, 2.0 * kGonePeriod) > kGonePeriod;
  return {hip_, !is_gone};
}

void GuestDevice::write(const Vec3& f_W) noexcept {
  is_force_sane_ = is_force_sane_ && f_W.allFinite() && f_W.norm() <= kMostForce * (1.0 + 1e-9);
  f_W_ = f_W.allFinite() ? f_W : Vec3::Zero();
}

}  // namespace tandem::demos::bench
