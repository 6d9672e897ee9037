#include "arms/arm_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "arms/arm_watch.h"
#include "arms/constraint_fields.h"
#include "arms/link_frame.h"
#include "arms/tell_impulse.h"
#include "world/world_access.h"

namespace tandem {
namespace {

std::size_t placeOfLink(const ArmConstraintEnd& end) {
  return static_cast<std::size_t>(end.link + 1);
}

/// Pose of an end that stands.
RigidState readPose(const ArmConstraintEnd& end) {
  RigidState pose;
  if (!end.arm) return pose;
  pose.p_W = fromBullet(end.arm->localPosToWorld(end.link, btVector3(0, 0, 0)));
  btQuaternion turn;
  end.arm->localFrameToWorld(end.link, btMatrix3x3::getIdentity()).getRotation(turn);
  pose.q_WB = fromBullet(turn);
  return pose;
}

/// A turn of which Bullet's motor of a spherical joint finds these angles left.
btQuaternion makeTurn(const std::array<double, 3>& angles) {
  const auto about = [&](int axis, double angle) {
    btVector3 unit(0, 0, 0);
    unit[axis] = 1;
    return btQuaternion(unit, static_cast<btScalar>(angle));
  };
  return about(2, -angles[2]) * about(1, -angles[1]) * about(0, -angles[0]);
}

/// All but masses, which change with each pose.
bool isSameButForMasses(const JointSettings& before, JointSettings now) {
  for (std::size_t i = 0; i < now.axes.size(); ++i) now.axes[i].mass = before.axes[i].mass;
  return before == now;
}

}  // namespace

void ArmConstraints::look(const HostJoints::Find& find,
                          const std::vector<ArmJoints::Member>& members) {
  if (!host_) return;
  next_.clear();
  for (int i = 0; i < host_->getNumMultiBodyConstraints() && next_.size() < kMaxJoints; ++i) {
    btMultiBodyConstraint& host = *host_->getMultiBodyConstraint(i);
    const ArmConstraintKind kind = findKind(host);
    if (!isJointOfItsOwn(kind)) continue;
    const ArmConstraintEnds host_ends = findEnds(host);
    const auto a = findEnd(host_ends.a, find, members), b = findEnd(host_ends.b, find, members);
    if (!a || !b || a->index == b->index) continue;
    next_.push_back({&host, kind, host_ends, *a, *b, {a->index, b->index, &host}});
  }
  has_next_ = !isAsWanted();
  if (!has_next_) return next_.clear();
  // The thread that ticks allocates nothing.
  acting_.reserve();
  off_.reserve(kMaxJoints);
  reserveRows();
}

/// Rows are compared once take() has brought what look() has found.
void ArmConstraints::reserveRows() {
  next_held_ = {};
  arms_.clear();
  bodies_.clear();
  const auto note = [](auto& list, const auto* one) {
    if (one && std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
  };
  for (const Joint& joint : next_)
    for (const End* end : {&joint.a, &joint.b}) {
      note(arms_, end->link ? &end->link->arm() : nullptr);
      const ArmConstraintEnd& host = end == &joint.a ? joint.host_ends.a : joint.host_ends.b;
      note(bodies_, host.rigid && end->index != kStanding ? host.rigid : nullptr);
    }
  next_held_.reserve(next_.size(), arms_, bodies_);
  rows_.reserve(kMostJointRows);
}

/// None: it moves, and the island does not hold it.
std::optional<ArmConstraints::End> ArmConstraints::findEnd(
    const ArmConstraintEnd& end, const HostJoints::Find& find,
    const std::vector<ArmJoints::Member>& members) {
  if (end.rigid) {
    const std::optional<BodyIndex> index = find(*end.rigid);
    return index ? std::optional(End{*index}) : std::nullopt;
  }
  if (!end.arm || isGround(*end.arm, end.link)) return End{};
  for (const ArmJoints::Member& member : members) {
    const HostArm& arm = member.link->arm();
    if (&arm.body() == end.arm && arm.model().carrier(placeOfLink(end)) == member.link->number())
      return End{member.index, member.link};
  }
  return std::nullopt;
}

/// True if the island has the constraints that look() has found.
bool ArmConstraints::isAsWanted() const noexcept {
  return std::equal(joints_.begin(), joints_.end(), next_.begin(), next_.end(),
                    [](const Joint& has, const Joint& wanted) {
                      return has.host == wanted.host && has.kind == wanted.kind &&
                             has.host_ends == wanted.host_ends && has.ends.a == wanted.ends.a &&
                             has.ends.b == wanted.ends.b && !has.is_gone;
                    });
}

void ArmConstraints::findGone() noexcept {
  if (!host_) return;
  for (Joint& joint : joints_) {
    // Compares addresses first: it may have been deleted.
    bool is_there = false;
    for (int i = 0; i < host_->getNumMultiBodyConstraints() && !is_there; ++i)
      is_there = host_->getMultiBodyConstraint(i) == joint.host;
    joint.is_gone |= !is_there || findKind(*joint.host) != joint.kind ||
                     !(findEnds(*joint.host) == joint.host_ends);
  }
}

void ArmConstraints::switchOff() noexcept {
  off_.clear();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    if (joint.is_gone) continue;
    off_.push_back({i, joint.host->getMaxAppliedImpulse(), {}, {}, {}, {}, false});
    joint.host->setMaxAppliedImpulse(0);
    if (joint.kind == ArmConstraintKind::kSphericalMotor && off_.back().impulse > 0)
      holdSpeed(joint, off_.back());
  }
}

/// Bullet's motor of a spherical joint has no speed: a target that is one step ahead stands for it.
void ArmConstraints::holdSpeed(const Joint& joint, Off& off) noexcept {
  auto& motor = static_cast<btMultiBodySphericalJointMotor&>(*joint.host);
  off.target = motor.*SphericalMotorFields::kTarget;
  off.gain = motor.*SphericalMotorFields::kP;
  off.damping = motor.*SphericalMotorFields::kDamping;
  off.impulse_of_each = motor.*SphericalMotorFields::kMostOfEach;
  off.is_each = motor.*SphericalMotorFields::kIsEach;
  const HostSolver solver = readSolver(joint.settings.host_dt);
  if (!(solver.erp > 0.0)) return;
  const btMultiBody& arm = *joint.host_ends.a.arm;
  const btScalar* at = const_cast<btMultiBody&>(arm).getJointPosMultiDof(joint.host_ends.a.link);
  const double scale = joint.told.time > 0.0 ? solver.dt / joint.told.time : 0.0;
  std::array<double, 3> behind{};
  btVector3 most(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const double speed = joint.a.link->arm().expectedVelocity(joint.a.link->number(), k);
    behind[k] = -speed * solver.dt;
    const JointAxis& axis = joint.settings.axes[3 + k];
    const double own = scale * joint.told.impulse[JointCopy::numberOf(JointRowKind::kDrive, 3 + k)];
    most[static_cast<int>(k)] =
        static_cast<btScalar>(std::max(0.0, axis.force * solver.dt - std::abs(own)));
  }
  const btQuaternion now(at[0], at[1], at[2], at[3]);
  const auto whole = static_cast<btScalar>(1.0 / solver.erp);
  motor.setPositionTargetMultiDof(now * makeTurn(behind), btVector3(whole, whole, whole));
  motor.setDamping(btVector3(1, 1, 1));
  motor.setMaxAppliedImpulse(off.impulse);
  motor.setMaxAppliedImpulseMultiDof(most);
}

void ArmConstraints::giveSettingsBack(const Joint& joint, const Off& off) noexcept {
  joint.host->setMaxAppliedImpulse(off.impulse);
  if (joint.kind != ArmConstraintKind::kSphericalMotor || !(off.impulse > 0)) return;
  auto& motor = static_cast<btMultiBodySphericalJointMotor&>(*joint.host);
  motor.*SphericalMotorFields::kTarget = off.target;
  motor.*SphericalMotorFields::kP = off.gain;
  motor.*SphericalMotorFields::kDamping = off.damping;
  motor.*SphericalMotorFields::kMostOfEach = off.impulse_of_each;
  motor.*SphericalMotorFields::kIsEach = off.is_each;
}

void ArmConstraints::switchOn() noexcept {
  for (const Off& off : off_) {
    Joint& joint = joints_[off.joint];
    if (joint.kind == ArmConstraintKind::kSphericalMotor && joint.host->getMaxAppliedImpulse() > 0)
      for (int k = 0; k < 3; ++k)
        joint.by_bullet[static_cast<std::size_t>(k)] = readImpulse(*joint.host, k);
    giveSettingsBack(joint, off);
  }
  off_.clear();
}

void ArmConstraints::forgetWorld() noexcept {
  for (Joint& joint : joints_) joint.is_gone = true;
  next_.clear();
  has_next_ = false;
  off_.clear();
}

bool ArmConstraints::take() noexcept {
  if (!has_next_) return false;
  has_next_ = false;
  // Joints that stay go on with what they have.
  for (Joint& joint : next_)
    for (const Joint& before : joints_)
      if (!before.is_gone && before.host == joint.host && before.host_ends == joint.host_ends &&
          before.ends.a == joint.ends.a && before.ends.b == joint.ends.b)
        joint = before;
  joints_.swap(next_);
  std::swap(held_, next_held_);
  acting_.list(joints_);
  return true;
}

HostSolver ArmConstraints::readSolver(double dt) const noexcept {
  const btContactSolverInfo& info = host_->getSolverInfo();
  return {dt, static_cast<double>(info.m_erp), info.m_numIterations};
}

bool ArmConstraints::refresh(double dt) noexcept {
  bool has_changed = false;
  for (Joint& joint : joints_) {
    if (joint.is_gone) continue;
    read(joint, readSolver(dt));
    has_changed |= !isSameButForMasses(joint.copy.settings(), joint.settings);
    joint.copy = JointCopy(joint.settings);
  }
  leaveOutHeld();
  return has_changed;
}

/// Finds rows that say nothing new beside others, where the host's world is.
void ArmConstraints::leaveOutHeld() noexcept {
  const auto forEachRow = [&](auto visit) {
    for (Joint& joint : joints_) {
      if (joint.is_gone || !isTie(joint.kind)) continue;
      HeldEnd a, b;
      evaluateAtHost(joint, a, b);
      for (const JointRow& row : rows_) visit(joint, row, a, b);
    }
  };
  held_.begin();
  forEachRow([&](const Joint&, JointRow row, const HeldEnd& a, const HeldEnd& b) {
    held_.add(row, row.high, a, b);
  });
  held_.compare();
  std::size_t next = 0;
  forEachRow([&](Joint& joint, const JointRow& row, const HeldEnd&, const HeldEnd&) {
    const auto number = static_cast<std::size_t>(row.number);
    joint.is_left_out[number] = held_.isHeld(next);
    joint.force[number] = held_.greatestForce(next);
    joint.open[number] = held_.openWay(next++);
  });
}

/// Writes the rows of a constraint to `rows_`, where Bullet has its ends.
void ArmConstraints::evaluateAtHost(const Joint& joint, HeldEnd& a, HeldEnd& b) noexcept {
  const auto look = [](const End& end, const ArmConstraintEnd& host, HeldEnd& held) {
    if (end.link) {
      held.arm = &end.link->arm();
      held.place = end.link->number();
      return held.arm->findState(held.place);
    }
    if (end.index == kStanding) return end.standing;
    held.rigid = host.rigid;
    return readState(*host.rigid);
  };
  const RigidState at_a = look(joint.a, joint.host_ends.a, a);
  const RigidState at_b = look(joint.b, joint.host_ends.b, b);
  rows_.clear();
  joint.copy.evaluate(at_a, at_b, rows_);
}

/// Reads a constraint of the host's world as it is now, between bodies of the island.
void ArmConstraints::read(Joint& joint, const HostSolver& solver) noexcept {
  joint.by_bullet = {};
  joint.settings = readConstraint(*joint.host, solver);
  joint.mend = joint.settings.axes[1].erp / solver.dt;
  const auto place = [&](End& end, const ArmConstraintEnd& host_end, JointFrame& frame) {
    if (end.link)
      frame = moveToCarrier(end.link->arm().model(), placeOfLink(host_end), frame);
    else if (end.index == kStanding)
      end.standing = readPose(host_end);
  };
  place(joint.a, joint.host_ends.a, joint.settings.a);
  place(joint.b, joint.host_ends.b, joint.settings.b);
  if (joint.kind != ArmConstraintKind::kSphericalMotor) return;
  for (std::size_t k = 0; k < 3; ++k)
    joint.settings.axes[3 + k].mass = joint.a.link->arm().findMass(joint.a.link->number(), k);
}

void ArmConstraints::note(std::size_t joint, const JointRow& row, double impulse, double h,
                          bool is_first) noexcept {
  Given& given = joints_[acting_.places()[joint]].given;
  if (is_first) given.time += h;
  given.impulse[row.number] += impulse;
}

void ArmConstraints::tell(double dt) noexcept {
  for (Joint& joint : joints_)
    if (!joint.is_gone && turnToGiven(joint)) tellHost(joint, dt);
}

/// Impulses of Bullet's rows, by those of the island's.
void ArmConstraints::tellHost(Joint& joint, double dt) noexcept {
  const double scale = dt / joint.told.time;  // ticks do not end with the host's steps
  const auto given = [&](JointRowKind kind, std::size_t axis) {
    return scale * joint.told.impulse[JointCopy::numberOf(kind, axis)];
  };
  const auto held = [&](std::size_t axis) { return given(JointRowKind::kHold, axis); };
  const auto tell = [&](std::size_t row, double impulse) {
    tellImpulse(*joint.host, static_cast<int>(row), impulse);
  };
  switch (joint.kind) {
    case ArmConstraintKind::kUnknown:
    case ArmConstraintKind::kGear:
    case ArmConstraintKind::kJointMotor:
    case ArmConstraintKind::kJointLimit:
      break;
    case ArmConstraintKind::kSphericalMotor:
      for (std::size_t k = 0; k < 3; ++k)
        tell(k, given(JointRowKind::kDrive, 3 + k) + joint.by_bullet[k]);
      break;
    case ArmConstraintKind::kSphericalLimit:
      for (std::size_t k = 0; k < 3; ++k)
        tell(k, held(3 + k) - given(JointRowKind::kHighLimit, 3 + k));
      break;
    case ArmConstraintKind::kPoint:
      // Bullet's rows point against the axes of the world.
      for (std::size_t k = 0; k < 3; ++k) tell(k, -held(k));
      break;
    case ArmConstraintKind::kFixed:
      for (std::size_t k = 0; k < 6; ++k) tell(k, held(k));
      break;
    case ArmConstraintKind::kSlider: {
      for (std::size_t k = 0; k < 2; ++k) tell(k, held(1 + k));
      const Vec3 turn = turnToFrame(*joint.host, Vec3(held(3), held(4), held(5)));
      for (std::size_t k = 2; k < 5; ++k) tell(k, turn[static_cast<int>(k % 3)]);
      break;
    }
  }
}

bool ArmConstraints::dropGone() noexcept {
  if (!acting_.hasGone(joints_)) return false;
  acting_.list(joints_);
  return true;
}

void ArmConstraints::drop(BodyIndex body) noexcept {
  endJointsOf(body, joints_);
  acting_.list(joints_);
}

double ArmConstraints::rounding() const noexcept {
  return std::numeric_limits<double>::epsilon();  // JointCopy measures in double
}

void ArmConstraints::evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                              std::vector<JointRow>& rows) noexcept {
  const Joint& wanted = joints_[acting_.places()[joint]];
  const auto first = static_cast<std::ptrdiff_t>(rows.size());
  wanted.copy.evaluate(wanted.ends.a == kStanding ? wanted.a.standing : a,
                       wanted.ends.b == kStanding ? wanted.b.standing : b, rows);
  if (!isTie(wanted.kind)) return;
  const auto isLeftOut = [&](const JointRow& row) {
    return wanted.is_left_out[static_cast<std::size_t>(row.number)];
  };
  rows.erase(std::remove_if(rows.begin() + first, rows.end(), isLeftOut), rows.end());
  for (std::size_t i = static_cast<std::size_t>(first); i < rows.size(); ++i) {
    const auto number = static_cast<std::size_t>(rows[i].number);
    rows[i].speed += wanted.mend * wanted.open[number];
    rows[i].high = wanted.force[number];
    rows[i].low = -rows[i].high;
  }
}

}  // namespace tandem
