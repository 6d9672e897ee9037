#include "site/local_hand.h"

#include <algorithm>

#include "site/peers.h"

namespace tandem {

LocalHand::LocalHand(HapticDevice& device, const SiteSettings& settings, Island& island,
                     bool island_moves)
    : device_(device),
      island_(island),
      period_(1.0 / settings.haptic_rate),
      guard_(device.capabilities().max_force,
             std::min(settings.max_slew, device.capabilities().max_slew) / settings.haptic_rate,
             settings.fault_slew / settings.haptic_rate),
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
  if (p_before_W_ && force_W_ != Vec3::Zero())
    energy_.countHand(force_W_, hand_.p_W - *p_before_W_);
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

void LocalHand::render(const Vec3& contact_W, const Peers& peers, bool fault) noexcept {
  contact_W_ = contact_W;
  if (energy_.isKept()) energy_.receive(period_, peers.keepAccounts());
  if (contact_W_ == Vec3::Zero() && force_W_ == Vec3::Zero()) return;
  force_W_ = guard_.follow(guard_.clamp(contact_W_), fault || fades_);
  if (energy_.isKept())
    force_W_ = energy_.limit(force_W_, v_known_W_, v_known_W_ - v_before_W_, period_);
  guard_.note(force_W_);
}

PointState LocalHand::pointAt(double time, double tick_start) noexcept {
  if (time > tick_start && device_.capabilities().is_continuous) {
    const DeviceSample between = device_.read(time);
    if (between.valid && isFinite(between.hip)) return frame_.toWorld(between.hip);
  }
  return island_.state(hip_).point();
}

}  // namespace tandem
