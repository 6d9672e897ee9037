#include "site/grip_hold.h"

#include <algorithm>
#include <cmath>

#include "coordination/src/geometry/turn.h"
#include "site/shorten.h"

namespace tandem {
namespace {

/// An object comes to a hand that is far away no faster than this on average [m/s].
constexpr double kBlendSpeed = 0.5;
/// Part of the time to come to the hand that is left for a hand that is heard late.
constexpr double kLeastBlend = 0.25;

/// States of a user that are farther apart tell no rate [s].
constexpr double kLongestGap = 0.1;
/// A user's hand turns no faster [rad/s].
constexpr double kFastestTurn = 50.0;

double computeCritical(double stiffness, double inertia) noexcept {
  return 2.0 * std::sqrt(stiffness * inertia);
}

/// How firmly a hand holds.
ToolSettings chooseHold(const SiteSettings& settings, const SharedObject& object) noexcept {
  if (object.tool_of) return settings.tool;
  const GripSettings& grip = settings.grip;
  return {grip.stiffness, grip.damping_ratio, grip.radius, grip.max_force};
}

/// Gains of a hand's grip of a body.
CouplerSettings computeGains(const ToolSettings& hold, double hand, const IslandBody& body,
                             const Vec3& p_BG) noexcept {
  const double reduced = hand * body.mass / (hand + body.mass);
  // It turns about the grip.
  const double inertia = body.inertia_B.maxCoeff() + body.mass * p_BG.squaredNorm();
  const double turn = hold.stiffness * hold.radius * hold.radius;
  return {{hold.stiffness, hold.damping_ratio * computeCritical(hold.stiffness, reduced)},
          {turn, hold.damping_ratio * computeCritical(turn, inertia)}};
}

/// Rises from 0 to 1 without a jump of its rate.
double easeIn(double x) noexcept { return x * x * (3.0 - 2.0 * x); }

Quat turnBy(const Vec3& turn_W, const Quat& q_WB) noexcept {
  const double angle = turn_W.norm();
  if (angle == 0.0) return q_WB;
  return (Quat(Eigen::AngleAxisd(angle, turn_W / angle)) * q_WB).normalized();
}

}  // namespace

void GripHold::begin(const SharedObject& object, const std::optional<Vec3>& at_B) noexcept {
  GripState state;
  state.object = object.id;
  state.p_BG = at_B.value_or(Vec3::Zero());
  begin(state, object);
  finds_turn_ = true;
  finds_place_ = !at_B;
}

void GripHold::begin(const GripState& told, const SharedObject& object) noexcept {
  if (isOn() && hold_.body != object.body.index) drop();
  if (!isOn()) lift_ = 0.0;
  phase_ = Phase::kHolding;
  state_ = told;
  is_found_ = finds_turn_ = finds_place_ = false;
  at_limit_ = 0.0;
}

GripState GripHold::tell() const noexcept {
  GripState told = state_;
  told.q_BG = findWanted().conjugate();
  return told;
}

Quat GripHold::findWanted() const noexcept {
  return (wrist_.q_WH * state_.q_BG.conjugate()).normalized();
}

void GripHold::turn(const GripState& told, double time) noexcept {
  const double passed = time - told_at_;
  if (passed == 0.0) return;
  const Quat before = state_.q_BG.conjugate(), now = told.q_BG.conjugate();
  const Vec3 turn_W = computeTurn(before.coeffs().data(), now.coeffs().data()).toVec3();
  const bool is_next = passed > 0.0 && passed < kLongestGap;
  wrist_.w_W = is_next ? shortenTo(Vec3(turn_W / passed), kFastestTurn) : Vec3(Vec3::Zero());
  state_.q_BG = told.q_BG;
  told_at_ = time;
}

void GripHold::letGo() noexcept {
  if (phase_ != Phase::kHolding) return;
  if (!is_found_) return drop();
  phase_ = Phase::kFading;
  fade_left_ = settings_->grip.fade_time;
}

void GripHold::drop() noexcept {
  if (!isOn()) return;
  phase_ = Phase::kNone;
  island_->setGrip(index_, nullptr);
}

void GripHold::pause() noexcept {
  if (phase_ == Phase::kFading) return drop();
  if (phase_ != Phase::kHolding || !is_found_) return;
  is_found_ = false;
  lift_ = at_limit_ = 0.0;
  hold_.share = 0.0;
  island_->setGrip(index_, &hold_);
}

void GripHold::follow(const SharedObject& object, double period, double share,
                      double sites) noexcept {
  if (!isOn()) return;
  if (!is_found_) {
    find(object);
  } else {
    const bool is_limited = computePull().is_limited;
    at_limit_ = is_limited ? at_limit_ + period : 0.0;
    countWork(island_->state(object.body.index));
    if (phase_ == Phase::kHolding) lift(object, period, sites, is_limited);
    blend(period);
  }
  if (phase_ == Phase::kFading) {
    fade_left_ -= period;
    if (!(fade_left_ > 0.0)) return drop();
    share *= fade_left_ / settings_->grip.fade_time;
  }
  hold_.share = share;
  island_->setGrip(index_, &hold_);
}

/// The pull begins at nothing: the object is where the spring rests.
void GripHold::find(const SharedObject& object) noexcept {
  const GripSettings& grip = settings_->grip;
  const ToolSettings hold = chooseHold(*settings_, object);
  const RigidState& body = island_->state(object.body.index);
  is_found_ = true;
  if (finds_turn_) state_.q_BG = body.q_WB.conjugate() * wrist_.q_WH;
  if (finds_place_) state_.p_BG = body.q_WB.conjugate() * (island_->state(hand_).p_W - body.p_W);
  hold_.body = object.body.index;
  hold_.p_FG = state_.p_BG;
  hold_.gains = computeGains(hold, settings_->proxy.mass, object.settings, state_.p_BG);
  hold_.max_force = hold.max_force;
  hold_.max_torque = hold.max_force * hold.radius;
  hold_.is_tool = object.tool_of.has_value();
  hold_.offset_W.setZero();
  found_W_ = -findWay(body);
  const Quat wanted = findWanted();
  found_turn_W_ = computeTurn(wanted.coeffs().data(), body.q_WB.coeffs().data()).toVec3();
  p_before_W_ = body.p_W + body.q_WB * hold_.p_FG;
  blended_ = 0.0;
  blend_length_ = std::max(grip.blend_time, found_W_.norm() / kBlendSpeed);
  blend_length_ = std::max(blend_length_ - state_.age, kLeastBlend * blend_length_);
  blend(0.0);
}

void GripHold::countWork(const RigidState& body) noexcept {
  const Vec3 p_W = body.p_W + body.q_WB * hold_.p_FG;
  work_ += hold_.share * hold_.load_W.dot(p_W - p_before_W_);
  p_before_W_ = p_W;
}

/// From the place on the body to where the spring rests.
Vec3 GripHold::findWay(const RigidState& body) const noexcept {
  return island_->state(hand_).p_W + hold_.offset_W - body.p_W - body.q_WB * hold_.p_FG;
}

void GripHold::blend(double period) noexcept {
  blended_ = std::min(blended_ + period, blend_length_);
  const double done = blend_length_ > 0.0 ? easeIn(blended_ / blend_length_) : 1.0;
  hold_.offset_W = (1.0 - done) * found_W_;
  hold_.q_WF = turnBy((1.0 - done) * found_turn_W_, findWanted());
  hold_.w_W = wrist_.w_W;
}

/// The spring's force against the weight becomes lift, which takes over what hangs and never more.
/// A hand feels it as often as there are `sites` at which it holds a copy.
void GripHold::lift(const SharedObject& object, double period, double sites,
                    bool is_limited) noexcept {
  const Vec3& weight_W = object.body.load.f_gravity_W;
  const double weight = weight_W.norm();
  if (weight == 0.0 || settings_->grip.lift_time == 0.0) {
    lift_ = 0.0;
    hold_.lift_W.setZero();
    hold_.load_W.setZero();
    return;
  }
  const Vec3 up_W = weight_W / -weight;
  const double pull =
      hold_.gains.linear.stiffness * up_W.dot(findWay(island_->state(object.body.index)));
  const double change = period / settings_->grip.lift_time * pull;
  // Copies at other sites may hang on this one, with the weight of the whole object.
  if (!is_limited || change < 0.0)
    lift_ = std::clamp(lift_ + change, 0.0, weight / object.mass_share);
  hold_.lift_W = sites * lift_ * up_W;
  hold_.load_W = (1.0 - sites) * lift_ * up_W;
}

}  // namespace tandem
