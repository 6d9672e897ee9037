#include "site/local_hand.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "site/peers.h"

namespace tandem {
namespace {

/// A torque rises and fades between zero and the device's limit within this time [s].
constexpr double kTorqueRise = 0.02;

/// No hand is faster, nor its wrist [m/s], [rad/s]: a reading that says so is wrong.
constexpr double kFastestHand = 10.0, kFastestWrist = 100.0;

Vec3 limit(const Vec3& velocity, double most) noexcept {
  const double square = velocity.squaredNorm();
  return square > most * most ? Vec3(most / std::sqrt(square) * velocity) : velocity;
}

/// The point with a velocity that a hand can have.
PointState limit(const PointState& hip) noexcept { return {hip.p_W, limit(hip.v_W, kFastestHand)}; }

/// A device's orientation may have seven digits.
bool isUsable(const WristState& wrist) noexcept {
  return isFinite(wrist) && std::abs(wrist.q_WH.norm() - 1.0) < 1e-3;
}

}  // namespace

LocalHand::LocalHand(HapticDevice& device, const SiteSettings& settings, Island& island,
                     bool island_moves)
    : device_(device),
      island_(island),
      period_(1.0 / settings.haptic_rate),
      most_torque_(device.capabilities().max_torque),
      guard_(device.capabilities().max_force,
             std::min(settings.max_slew, device.capabilities().max_slew) / settings.haptic_rate,
             settings.fault_slew / settings.haptic_rate),
      torque_guard_(most_torque_, most_torque_ * period_ / kTorqueRise,
                    most_torque_ * period_ / kTorqueRise),
      energy_(settings.passivity, island_moves) {
  read(0.0);
  if (!isThere())
    throw Error("the device gives no position; check its cable, or wait until it is homed");
  IslandBody body;
  body.shape = Sphere{settings.hip_radius};
  body.motion = Motion::kPrescribed;
  body.feels_obstacles = true;
  body.filter = {settings.hand_group, settings.hand_mask};
  body.start.p_W = hand_.p_W;
  hip_ = island.addBody(body);
}

void LocalHand::read(double now) noexcept {
  sample_ = device_.read(now);
  is_there_ = sample_.valid && isFinite(sample_.hip);
  if (is_there_) elapsed_ = now - std::exchange(read_at_, now);
  sample_.hip = limit(sample_.hip);
  hand_ = frame_.toWorld(sample_.hip);
  const bool is_turning = is_there_ && sample_.wrist && isUsable(*sample_.wrist);
  if (is_turning) {
    wrist_ = sample_.wrist;
    wrist_->q_WH.normalize();
    wrist_->w_W = limit(wrist_->w_W, kFastestWrist);
  } else if (wrist_) {
    wrist_->w_W.setZero();
  }
}

void LocalHand::shiftOrigin(const Vec3& offset_W) noexcept {
  frame_.shiftOrigin(offset_W);
  hand_.p_W += offset_W;
  if (p_before_W_) *p_before_W_ += offset_W;
}

void LocalHand::place() noexcept {
  RigidState state = island_.state(hip_);
  // The hand went on while the device was away.
  if (isThere() && !was_there_) island_.noteArrival(hip_);
  was_there_ = isThere();
  if (isThere()) {
    state.p_W = hand_.p_W;
    state.v_W = hand_.v_W;
  } else {
    state.v_W.setZero();
  }
  island_.setState(hip_, state);
}

void LocalHand::lead(double duration) noexcept {
  if (!isThere()) return;
  RigidState state = island_.state(hip_);
  state.v_W = (hand_.p_W - state.p_W) / duration;
  island_.setState(hip_, state);
}

void LocalHand::countWork() noexcept {
  if (!isThere()) {
    // The hand is taken to move on, for the fading force: p_before follows it.
    if (!p_before_W_) return;
    const Vec3 way_W = period_ * v_known_W_;
    energy_.countHand(force_W_, way_W);
    *p_before_W_ += way_W;
    return;
  }
  if (p_before_W_ && force_W_ != Vec3::Zero()) {
    const Vec3 way_W = hand_.p_W - *p_before_W_;
    // A position that leaps is a wrong reading, or ends one: nobody has worked along that way.
    const double longest = kFastestHand * std::max(period_, elapsed_);
    if (way_W.squaredNorm() <= longest * longest) energy_.countHand(force_W_, way_W);
  }
  if (wrist_ && torque_W_ != Vec3::Zero()) energy_.countHand(torque_W_, period_ * wrist_->w_W);
  p_before_W_ = hand_.p_W;
  v_before_W_ = v_known_W_;
  v_known_W_ = hand_.v_W;
}

const Vec3& LocalHand::computeContactForce() noexcept {
  if (!contact_rest_.holds(island_)) {
    contact_W_ = island_.computeContactForce(hip_);
    contact_rest_.set(island_);
  }
  return contact_W_;
}

void LocalHand::render(const Vec3& contact_W, const Vec3& torque_W, const Peers& peers,
                       bool fault) noexcept {
  contact_W_ = contact_W;
  if (energy_.isKept()) energy_.receive(period_, peers.keepAccounts());
  const bool has_torque = torque_W != Vec3::Zero() || torque_W_ != Vec3::Zero();
  if (contact_W_ == Vec3::Zero() && force_W_ == Vec3::Zero() && !has_torque) return;
  force_W_ = guard_.follow(guard_.clamp(contact_W_), fault || fades_);
  if (has_torque) torque_W_ = torque_guard_.follow(torque_guard_.clamp(torque_W), fault || fades_);
  if (energy_.isKept()) {
    const double turning = wrist_ ? torque_W_.dot(wrist_->w_W) : 0.0;
    const double share =
        energy_.computeShare(force_W_, turning, v_known_W_, v_known_W_ - v_before_W_, period_);
    if (share != 1.0) force_W_ *= share;
    if (share != 1.0) torque_W_ *= share;
  }
  guard_.note(force_W_);
  torque_guard_.note(torque_W_);
}

void LocalHand::write() noexcept {
  device_.write(force_W_);
  if (feelsTorque()) device_.writeTorque(torque_W_);
}

void LocalHand::letGo() noexcept {
  device_.write(Vec3::Zero());
  if (feelsTorque()) device_.writeTorque(Vec3::Zero());
}

PointState LocalHand::pointAt(double time, double tick_start) noexcept {
  if (time > tick_start && device_.capabilities().is_continuous) {
    const DeviceSample between = device_.read(time);
    if (between.valid && isFinite(between.hip)) return frame_.toWorld(limit(between.hip));
  }
  return island_.state(hip_).point();
}

}  // namespace tandem
