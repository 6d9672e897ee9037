#include "joints/host_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/body_look.h"
#include "joints/held_ways.h"
#include "world/world_access.h"

namespace tandem {
namespace {

HostSolver readSolver(btDiscreteDynamicsWorld& host, double dt) noexcept {
  const btContactSolverInfo& info = host.getSolverInfo();
  return {dt, static_cast<double>(info.m_erp), info.m_numIterations};
}

}  // namespace

void HostJoints::look(const Find& find) {
  next_.clear();
  looked_at_ = host_.getNumConstraints();
  for (int i = 0; i < host_.getNumConstraints() && next_.size() < kMaxJoints; ++i) {
    btTypedConstraint& host = *host_.getConstraint(i);
    if (!host.isEnabled() || !JointCopy::isKnown(host) || moved_.isMoving(host)) continue;
    const btRigidBody &a = host.getRigidBodyA(), &b = host.getRigidBodyB();
    const auto in_a = isFixed(a) ? kStanding : find(a), in_b = isFixed(b) ? kStanding : find(b);
    if (!in_a || !in_b || (*in_a == kStanding && *in_b == kStanding)) continue;
    next_.push_back({&host, &a, &b, {*in_a, *in_b, &host}, nullptr});
  }
  has_next_ = !isAsWanted();
  if (!has_next_) return next_.clear();
  for (Joint& joint : next_)
    joint.copy = std::make_unique<JointCopy>(*joint.host, readSolver(host_, HostSolver().dt));
  // The thread that ticks allocates nothing.
  acting_.reserve();
  elder_.reserve(kMaxJoints);
  elders_rows_.reserve(kMostJointRows);
}

/// True if the island has the joints that look() has found.
bool HostJoints::isAsWanted() const noexcept {
  return std::equal(joints_.begin(), joints_.end(), next_.begin(), next_.end(),
                    [](const Joint& has, const Joint& wanted) {
                      return has.host == wanted.host && has.a == wanted.a && has.b == wanted.b &&
                             has.ends.a == wanted.ends.a && has.ends.b == wanted.ends.b &&
                             !has.is_gone;
                    });
}

void HostJoints::findGone() noexcept {
  int place = 0;
  const int count = host_.getNumConstraints();
  for (Joint& joint : joints_) {
    // Compares addresses first: it may have been deleted. The order hardly ever changes.
    int looked = 0;
    while (looked < count && host_.getConstraint(place % count) != joint.host) ++place, ++looked;
    // A joint that went with a body stays gone: look() takes it anew.
    joint.is_gone |= looked == count || !joint.host->isEnabled() ||
                     &joint.host->getRigidBodyA() != joint.a ||
                     &joint.host->getRigidBodyB() != joint.b || moved_.isMoving(*joint.host);
  }
}

bool HostJoints::hasNews() noexcept {
  findGone();
  if (looked_at_ != host_.getNumConstraints()) return true;
  return std::any_of(joints_.begin(), joints_.end(), [&](const Joint& joint) {
    if (joint.is_gone) return true;
    const JointSettings& known = joint.copy->settings();
    return !(JointCopy(*joint.host, readSolver(host_, known.host_dt)).settings() == known);
  });
}

void HostJoints::switchOff() noexcept {
  for (Joint& joint : joints_) {
    if (joint.is_gone) continue;
    joint.host->setEnabled(false);
    joint.is_off = true;
  }
}

void HostJoints::switchOn() noexcept {
  for (Joint& joint : joints_) {
    if (!joint.is_off) continue;
    joint.is_off = false;
    joint.host->setEnabled(true);
  }
}

void HostJoints::forgetWorld() noexcept {
  for (Joint& joint : joints_) joint.is_gone = true;
  next_.clear();
  has_next_ = false;
}

bool HostJoints::take() noexcept {
  if (!has_next_) return false;
  has_next_ = false;
  joints_.swap(next_);
  listActing();
  return true;
}

bool HostJoints::refresh(double dt) noexcept {
  const HostSolver solver = readSolver(host_, dt);
  bool has_changed = false;
  for (Joint& joint : joints_) {
    if (joint.is_gone) continue;
    JointSettings before = joint.copy->settings();
    joint.copy->refresh(*joint.host, solver);
    before.host_dt = joint.copy->settings().host_dt;
    has_changed |= !(before == joint.copy->settings());
    if (joint.ends.a == kStanding) joint.fixed_a = readState(*joint.a);
    if (joint.ends.b == kStanding) joint.fixed_b = readState(*joint.b);
  }
  return has_changed;
}

void HostJoints::note(std::size_t joint, const JointRow& row, double impulse, double h,
                      bool is_first) noexcept {
  Given& given = joints_[acting_.places()[joint]].given;
  if (is_first) given.time += h;
  given.impulse[row.number] += impulse;
  given.last = row.number;
  given.linear_W += impulse * row.n_W;
  given.angular_a_W += impulse * row.turn_a_W;
  given.angular_b_W += impulse * row.turn_b_W;
}

bool HostJoints::tell(double dt) noexcept {
  bool is_any_broken = false;
  for (Joint& joint : joints_) {
    if (joint.is_gone || !turnToGiven(joint)) continue;
    const Given& given = joint.told;
    const double scale = dt / given.time;  // ticks do not end with the host's steps
    joint.host->internalSetAppliedImpulse(static_cast<btScalar>(scale * given.impulse[given.last]));
    if (btJointFeedback* feedback = joint.host->getJointFeedback()) {
      const double rate = 1.0 / given.time;
      feedback->m_appliedForceBodyA = toBullet(Vec3(rate * given.linear_W));
      feedback->m_appliedTorqueBodyA = toBullet(Vec3(rate * given.angular_a_W));
      feedback->m_appliedForceBodyB = toBullet(Vec3(-rate * given.linear_W));
      feedback->m_appliedTorqueBodyB = toBullet(Vec3(rate * given.angular_b_W));
    }
    const double most = static_cast<double>(joint.host->getBreakingImpulseThreshold());
    for (const double impulse : given.impulse) joint.is_gone |= scale * std::abs(impulse) >= most;
    if (!joint.is_gone) continue;
    joint.host->setEnabled(false);
    is_any_broken = true;
  }
  if (is_any_broken) static_cast<void>(dropGone());
  return is_any_broken;
}

bool HostJoints::dropGone() noexcept {
  if (!acting_.hasGone(joints_)) return false;
  listActing();
  return true;
}

void HostJoints::drop(BodyIndex body) noexcept {
  endJointsOf(body, joints_);
  static_cast<void>(dropGone());
}

void HostJoints::listActing() noexcept {
  acting_.list(joints_);
  const std::vector<std::size_t>& places = acting_.places();
  elder_.clear();
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::size_t elder = i;
    for (std::size_t j = 0; j < i; ++j)
      if (haveSameEnds(joints_[places[j]], joints_[places[i]])) elder = j;
    elder_.push_back(elder);
  }
}

bool HostJoints::haveSameEnds(const Joint& one, const Joint& other) noexcept {
  return (one.a == other.a && one.b == other.b) || (one.a == other.b && one.b == other.a);
}

double HostJoints::rounding() const noexcept {
  return std::numeric_limits<double>::epsilon();  // JointCopy measures in double
}

void HostJoints::evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                          std::vector<JointRow>& rows) noexcept {
  const std::size_t first = rows.size();
  ask(joint, a, b, rows);
  if (elder_[joint] != joint) leaveOutHeld(joint, a, b, first, rows);
}

void HostJoints::ask(std::size_t joint, const RigidState& a, const RigidState& b,
                     std::vector<JointRow>& rows) const noexcept {
  const Joint& asked = joints_[acting_.places()[joint]];
  asked.copy->evaluate(asked.ends.a == kStanding ? asked.fixed_a : a,
                       asked.ends.b == kStanding ? asked.fixed_b : b, rows);
}

/// Leaves out rows, from `first` on, of what joints before this one hold rigidly.
void HostJoints::leaveOutHeld(std::size_t joint, const RigidState& a, const RigidState& b,
                              std::size_t first, std::vector<JointRow>& rows) noexcept {
  const auto isRigid = [](const JointRow& row) {
    return row.law == JointLaw::kLocked && row.stiffness == 0.0 && row.damping == 0.0;
  };
  const Joint& own = joints_[acting_.places()[joint]];
  // One body is enough, and it must be one that moves.
  const btRigidBody* const looked_at = own.ends.a == kStanding ? own.b : own.a;
  HeldWays held;
  for (std::size_t j = joint; elder_[j] != j;) {
    j = elder_[j];
    const Joint& other = joints_[acting_.places()[j]];
    const bool is_turned = other.a != own.a;
    elders_rows_.clear();
    ask(j, is_turned ? b : a, is_turned ? a : b, elders_rows_);
    for (const JointRow& row : elders_rows_)
      if (isRigid(row)) static_cast<void>(held.add(row, other.a == looked_at));
  }
  const auto isHeld = [&](const JointRow& row) {
    return isRigid(row) && !held.add(row, own.a == looked_at);
  };
  const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first);
  rows.erase(std::remove_if(begin, rows.end(), isHeld), rows.end());
}

}  // namespace tandem
