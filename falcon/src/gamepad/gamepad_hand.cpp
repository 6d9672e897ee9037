#include "gamepad/gamepad_hand.h"

#include <cmath>

#include "guard/force_limit.h"
#include "guard/settings_check.h"

namespace tandem {
namespace {

constexpr double kLongestStep = 0.02;  // after a longer pause the target goes on without a jump [s]
// The hand is weaker than the site's force, so that no wall gives way to it.
constexpr double kHandShare = 0.75;

RateControlSettings makeMotion(const GamepadSettings& settings) {
  RateControlSettings motion;
  motion.speed = settings.speed;
  motion.turn_speed = 0.0;
  motion.dead_zone = settings.dead_zone;
  motion.smoothing = settings.smoothing;
  motion.start_W = settings.start_W;
  motion.workspace = settings.workspace;
  motion.q_WD = settings.q_WD;
  return motion;
}

/// The box lies within the sphere in which a mouse takes targets.
MouseSettings makeMouse(const GamepadSettings& settings) {
  falcon_detail::require(std::isfinite(settings.max_force) && settings.max_force > 0.0,
                         "max_force of the gamepad", settings.max_force, "finite and above 0 [N]");
  falcon_detail::require(std::isfinite(settings.travel) && settings.travel > 0.0,
                         "travel of the gamepad", settings.travel, "finite and above 0 [m]");
  MouseSettings mouse;
  mouse.hand_force = kHandShare * settings.max_force;
  mouse.max_force = settings.max_force;
  mouse.start_W = settings.start_W;
  mouse.workspace = 1.01 * settings.workspace.norm();
  return mouse;
}

}  // namespace

GamepadHand::GamepadHand(const GamepadSettings& settings)
    : settings_(settings),
      motion_(makeMotion(settings)),
      mouse_(makeMouse(settings)),
      longest_stretch_(kHandShare * settings.max_force / MouseSettings().stiffness),
      time_(kLongestStep),
      handle_{settings.start_W, Vec3::Zero()} {
  settings_.q_WD.normalize();
}

DeviceSample GamepadHand::advance(double now, const GamepadState& state, bool is_held) noexcept {
  const double step = time_.pass(now);
  (void)mouse_.moveTo(moveTarget(state, is_held, step), time_.sum());
  const DeviceSample sample = mouse_.read(time_.sum());
  handle_ = sample.hip;
  keepTargetNear(handle_.p_W, is_held);
  return {sample.hip, sample.valid, {}, state.buttons};
}

DeviceSample GamepadHand::stand(double now) noexcept {
  time_.pass(now);
  motion_.stop();
  handle_.v_W.setZero();
  return {handle_, false, {}, 0};
}

Vec3 GamepadHand::moveTarget(const GamepadState& state, bool is_held, double step) noexcept {
  const auto [right, up, back] = state.sticks;
  motion_.setDisplacement(is_held ? Vec3(0.0, up, 0.0) : Vec3(right, up, back));
  motion_.advance(step);
  if (!is_held) return motion_.point().p_W;
  const Vec3 raised_W = motion_.point().p_W - settings_.start_W;
  const Vec3 place_W = settings_.q_WD * Vec3(right, 0.0, back);
  const Vec3 way_W = raised_W + settings_.travel * place_W;
  return settings_.start_W + way_W.cwiseMax(-settings_.workspace).cwiseMin(settings_.workspace);
}

/// A target far within a wall would take as long to come back as it went in. Only what the sticks'
/// velocity moves is kept near: a held stick's place is the user's own.
void GamepadHand::keepTargetNear(const Vec3& handle_W, bool is_held) noexcept {
  Vec3 stretch_W = motion_.point().p_W - handle_W;
  const Vec3 up_W = settings_.q_WD * Vec3::UnitY();
  if (is_held) stretch_W = up_W.dot(stretch_W) * up_W;
  const Vec3 excess_W = stretch_W - falcon_detail::shorten(stretch_W, longest_stretch_);
  motion_.putPoint(motion_.point().p_W - excess_W);
}

}  // namespace tandem
