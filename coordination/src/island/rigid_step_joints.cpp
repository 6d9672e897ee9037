#include <algorithm>
#include <cmath>

#include "island/rigid_step.h"

// Joints in a step: their rows at its end, their modes, and blows on joined bodies.

namespace tandem {
namespace {

/// Way that is left to a limit that is reached [m].
constexpr double kReached = 1e-9;
/// Speed along a row that locks, above which the body got a blow [m/s].
constexpr double kBlow = 1e-6;
/// Speed along a row that may stay [m/s]: far below the errors of smooth motion.
constexpr double kSlowest = 1e-8;

}  // namespace

void RigidStep::answerBlows(const IslandModel& model, States& states) noexcept {
  for (RigidMover& mover : movers_) mover.ready = false;
  points_.clear();
  setUpJoints(model, states, states, 0.0);
  double fastest = 0.0;
  for (JointHold& hold : holds_) {
    const double u = hold.reach * hold.speed();
    hold.is_impact = hold.isLimit() && hold.reach * hold.row.way <= kReached;
    hold.startBlow();
    if (hold.isLocked()) fastest = std::max(fastest, std::abs(u));
    if (hold.is_impact) fastest = std::max(fastest, -u);
  }
  if (fastest < kBlow) return;
  groups_.make(points_, holds_, movers_, [](const ContactPoint&) { return true; });
  solver_.beginImpacts();
  for (const ContactGroups::Group& group : groups_.groups()) (void)solve(group);
  writeBack(states);
}

/// Asks for the rows of all joints at the end of the step.
void RigidStep::setUpJoints(const IslandModel& model, const States& before, const States& after,
                            double h) noexcept {
  static const RigidState kNowhere;
  holds_.clear();
  const auto stateOf = [&](BodyIndex body) -> const RigidState& {
    return body == kStanding ? kNowhere : after[static_cast<std::size_t>(body)];
  };
  const auto moverOf = [&](BodyIndex body) -> RigidMover* {
    if (body == kStanding) return nullptr;
    RigidMover& made = mover(body);
    if (!made.ready) made = RigidMover(model.bodies[static_cast<std::size_t>(body)], stateOf(body));
    return &made;
  };
  for (const JointForces::Joint& joint : joints_->joints()) {
    RigidMover *const a = moverOf(joint.a), *const b = moverOf(joint.b);
    joint_rows_.clear();
    model.joints->evaluate(joint.index, stateOf(joint.a), stateOf(joint.b), joint_rows_);
    for (const JointRow& row : joint_rows_) {
      if (holds_.size() == holds_.capacity()) return;
      holds_.emplace_back();
      JointHold& hold = holds_.back();
      hold.joint = joint.index;
      hold.body_a = joint.a;
      hold.body_b = joint.b;
      hold.row = row;
      hold.a = a;
      hold.b = b;
      hold.setUp(joints_->memory().mode(joint.index, row), joints_->force(joint.index, row), h);
      if (!(hold.inverse > 0.0)) {
        holds_.pop_back();
        continue;
      }
      const auto speedBefore = [&](BodyIndex body, double sign, const Vec3& turn_W) {
        if (body == kStanding) return 0.0;
        const RigidState& state = before[static_cast<std::size_t>(body)];
        return sign * row.n_W.dot(state.v_W) + turn_W.dot(state.w_W);
      };
      hold.opening =
          speedBefore(joint.a, 1.0, row.turn_a_W) + speedBefore(joint.b, -1.0, row.turn_b_W);
      hold.at_start = row.way - 0.5 * h * (hold.opening + hold.speed());
    }
  }
}

/// True if the smooth motion has answered all, as it mostly does where only joints act.
bool RigidStep::isAnswered(const ContactGroups::Group& group) const noexcept {
  const auto is_answered = [](const JointHold* hold) {
    return hold->isAnswered(kSlowest) &&
           !(hold->keepsPlace() && hold->reach * std::abs(hold->row.way) > kClosed);
  };
  return group.row_count == 0 &&
         std::all_of(group.holds, group.holds + group.hold_count, is_answered);
}

bool RigidStep::haveJointModesChanged() const noexcept {
  return std::any_of(holds_.begin(), holds_.end(),
                     [](const JointHold& hold) { return hold.findMode() != hold.mode; });
}

void RigidStep::learnJointModes() noexcept {
  for (const JointHold& hold : holds_)
    joints_->memory().setMode(hold.joint, hold.row.number, hold.findMode());
}

}  // namespace tandem
