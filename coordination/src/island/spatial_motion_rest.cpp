#include <algorithm>

#include "island/spatial_motion.h"

// Bodies near something rigid, and those of them that rest.

namespace tandem {
namespace {

/// Rigid counterpart of `kWatchDistance` (touch.h) [m]; bodies at rest may start under any force.
constexpr double kRigidWatchDistance = 5e-4;

/// A body held by a rigid contact is at rest after this time below this speed [m/s], [s].
constexpr double kStillSpeed = 1e-6;
constexpr double kTimeToRest = 0.05;

}  // namespace

/// Finds the bodies that joints hold; they are never left alone.
void SpatialMotion::findJoined(const IslandModel& model) noexcept {
  if (!model.joints) return;
  were_joined_pushed_ = false;
  std::fill(joined_.begin(), joined_.end(), char{0});
  joints_.memory().follow(model.joints->joints());
  for (const JointEnds& joint : model.joints->joints()) {
    if (!model.isJoinedNow(joint.a, joint.b)) continue;
    for (const BodyIndex b : {joint.a, joint.b})
      if (b != kStanding) {
        joined_[static_cast<std::size_t>(b)] = 1;
        were_joined_pushed_ |= model.bodies[static_cast<std::size_t>(b)].disturbed;
      }
  }
}

void SpatialMotion::answerJoints(const IslandModel& model, States& states) noexcept {
  findJoined(model);
  if (!were_joined_pushed_) return;
  for (std::size_t b = 0; b < states.size(); ++b) together_[b] = model.bodies[b].isDynamic();
  joints_.choose(model, together_);
  rigid_step_.startAdvance();
  rigid_step_.answerBlows(model, states);
}

/// Finds the bodies that may touch something rigid. Wakes those at rest that an awake one may
/// touch.
void SpatialMotion::lookAround(IslandModel& model) noexcept {
  std::fill(rigid_near_.begin(), rigid_near_.end(), char{0});
  if (!model.finder) return;
  for (const Touch& touch : touches_)
    for (const BodyIndex b : {touch.sphere, touch.other}) resting_[b] = 0;
  for (const int g : model.present_grips) resting_[model.grips[g].hold.body] = 0;
  for (const BodyIndex b : model.present) {
    ModelBody& body = model.bodies[b];
    const bool is_rigid = body.is_active && body.settings.is_rigid;
    const bool moves = body.isDynamic() || body.disturbed || body.state.v_W != Vec3::Zero() ||
                       body.state.w_W != Vec3::Zero();
    if (body.disturbed || !is_rigid) {
      resting_[b] = 0;
      still_[b] = 0.0;  // or a tiny first step would let it rest again, against any force
    }
    body.disturbed = false;
    moves_[b] = moves;
  }
  restTogether(model, true);
  for (const BodyIndex b : model.present) {
    const bool is_rigid = model.bodies[b].is_active && model.bodies[b].settings.is_rigid;
    awake_[b] = is_rigid && moves_[b] && !resting_[b];
    reach_[b] = is_rigid ? allowance_[b] + kRigidWatchDistance : -1.0;
  }
  model.finder->lookAround(states_, reach_, awake_, rigid_near_);
  for (std::size_t b = 0; b < awake_.size(); ++b) {
    if (!awake_[b]) continue;
    model.wake(static_cast<BodyIndex>(b));
    if (resting_[b]) still_[b] = 0.0;
    resting_[b] = 0;
  }
  restTogether(model, true);
  if (!model.is_listed) model.listPresent();
}

/// Bodies of a chain rest together or not at all; a moving end that is led lets none rest.
void SpatialMotion::restTogether(const IslandModel& model, bool begins_anew) noexcept {
  if (!model.joints) return;
  for (bool is_new = true; is_new;) {
    is_new = false;
    for (const JointEnds& joint : model.joints->joints()) {
      if (joint.a == kStanding || joint.b == kStanding || !model.isJoinedNow(joint.a, joint.b))
        continue;
      const auto isAwake = [&](BodyIndex b) {
        const ModelBody& body = model.bodies[static_cast<std::size_t>(b)];
        return body.isDynamic() ? !resting_[static_cast<std::size_t>(b)]
                                : body.state.v_W != Vec3::Zero() || body.state.w_W != Vec3::Zero();
      };
      const auto wake = [&](BodyIndex b) {
        char& is_resting = resting_[static_cast<std::size_t>(b)];
        if (!is_resting) return;
        is_resting = 0;
        if (begins_anew) still_[static_cast<std::size_t>(b)] = 0.0;
        is_new = true;
      };
      if (isAwake(joint.a)) wake(joint.b);
      if (isAwake(joint.b)) wake(joint.a);
    }
  }
}

/// Freezes a body that a rigid contact or a joint holds still for a while, until it is touched or
/// disturbed.
void SpatialMotion::letRest(const IslandModel& model, double dt) noexcept {
  for (const BodyIndex b : model.present) {
    if (resting_[b]) continue;
    const RigidState& state = states_[b];
    const ModelBody& body = model.bodies[b];
    if (!body.isDynamic()) continue;
    const double speed = state.v_W.norm() + state.w_W.norm() * body.bounding_radius;
    // Moving out of overlap changes the position without a velocity.
    const double way = (state.p_W - body.state.p_W).norm();
    const bool is_held = rigid_near_[b] || joined_[b];
    const bool is_still = is_held && speed < kStillSpeed && way < kStillSpeed * dt;
    still_[b] = is_still ? still_[b] + dt : 0.0;
    resting_[b] = still_[b] >= kTimeToRest;
  }
  restTogether(model, false);
  for (const BodyIndex b : model.present) {
    if (!resting_[b]) continue;
    states_[b].v_W.setZero();
    states_[b].w_W.setZero();
  }
}

void SpatialMotion::letSleep(IslandModel& model, BodyIndex b) noexcept {
  sleepers_.letSleep(model, states_, allowance_, b);
  if (!model.bodies[b].is_asleep) return;
  // Until it wakes, a sleeping body counts as resting.
  alone_[b] = turns_[b] = together_[b] = awake_[b] = 0;
  resting_[b] = model.bodies[b].settings.is_rigid;
}

}  // namespace tandem
