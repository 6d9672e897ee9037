#include "arms/arm_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "tandem/bullet_bridge/convert.h"

#include "arms/arm_constraint.h"
#include "arms/constraint_fields.h"
#include "arms/link_frame.h"
#include "arms/tell_impulse.h"

namespace tandem {
namespace {

/// An impulse below this is rounding [N s, N m s].
constexpr double kNoImpulse = 1e-13;

constexpr btScalar btMultiBodyJointMotor::*kMotorFields[] = {
    MotorFields::kSpeed, MotorFields::kPlace, MotorFields::kP, MotorFields::kD, MotorFields::kMost};

double read(const btMultiBodyJointMotor& motor, btScalar btMultiBodyJointMotor::*field) {
  return static_cast<double>(motor.*field);
}

/// The axis of a joint that motors, limits and torques act along; none for several degrees.
JointAxis* findFreeAxis(LinkKind kind, JointSettings& settings) {
  if (kind == LinkKind::kRevolute) return &settings.axes[5];
  return kind == LinkKind::kPrismatic ? &settings.axes[0] : nullptr;
}

Eigen::Matrix3d makeAxes(const Vec3& main, int column) {
  Eigen::Matrix3d axes;
  const Vec3 side = main.unitOrthogonal();
  axes.col(column) = main.normalized();
  axes.col((column + 1) % 3) = side;
  axes.col((column + 2) % 3) = axes.col(column).cross(side);
  return axes;
}

/// Kind and locked axes. Frame a is of the link, b of the parent's body or of ground.
JointSettings makeSettings(const ArmModel& model, std::size_t place) {
  const ArmLink& link = model.links()[place];
  JointSettings joint;
  int main = 0;
  Vec3 axis = Vec3::UnitX();
  switch (link.kind) {
    case LinkKind::kRevolute:
      joint.kind = JointKind::kHinge;
      axis = link.turn[0];
      main = 2;
      for (const std::size_t i : {0U, 1U, 2U, 3U, 4U}) joint.axes[i].lock();
      break;
    case LinkKind::kSpherical:
      joint.kind = JointKind::kPoint;
      for (const std::size_t i : {0U, 1U, 2U}) joint.axes[i].lock();
      break;
    case LinkKind::kPrismatic:
      joint.kind = JointKind::kSlider;
      axis = link.slide[0];
      for (const std::size_t i : {1U, 2U, 3U, 4U, 5U}) joint.axes[i].lock();
      break;
    case LinkKind::kPlanar:
      joint.kind = JointKind::kSlider;
      axis = link.turn[0];
      for (const std::size_t i : {0U, 4U, 5U}) joint.axes[i].lock();
      break;
    case LinkKind::kFixed:
      joint.kind = JointKind::kSlider;
      for (JointAxis& each : joint.axes) each.lock();
      break;
  }
  const Eigen::Matrix3d axes = makeAxes(axis, main);
  joint.a = {-link.d, axes};
  joint.b = moveToCarrier(model, link.parent, {link.e, link.q_PZ.toRotationMatrix() * axes});
  return joint;
}

/// All but what an axis knows of whole turns.
bool isSameJoint(const JointSettings& before, JointSettings now) {
  for (std::size_t i = 0; i < now.axes.size(); ++i) now.axes[i].near = before.axes[i].near;
  return before == now;
}

}  // namespace

void ArmJoints::look(const std::vector<Member>& members) {
  next_.clear();
  std::size_t most_links = 0;
  for (const Member& member : members) {
    const LinkBody& link = *member.link;
    const ArmModel& model = link.arm().model();
    if (link.number() == 0 || next_.size() == kMaxJoints) continue;
    const std::size_t carrier = model.carrier(model.links()[link.number()].parent);
    BodyIndex parent = kStanding;
    for (const Member& other : members)
      if (&other.link->arm() == &link.arm() && other.link->number() == carrier)
        parent = other.index;
    const JointSettings settings = makeSettings(model, link.number());
    const LinkKind kind = model.links()[link.number()].kind;
    next_.push_back({&link, kind, {member.index, parent, &link}, settings, JointCopy(settings)});
    most_links = std::max(most_links, model.size());
  }
  has_next_ = !isAsWanted();
  if (!has_next_) return next_.clear();
  // The thread that ticks allocates nothing.
  acting_.reserve();
  if (states_.capacity() < most_links) states_.reserve(most_links);
}

/// True if the island has the joints that look() has found.
bool ArmJoints::isAsWanted() const noexcept {
  return std::equal(joints_.begin(), joints_.end(), next_.begin(), next_.end(),
                    [](const Joint& has, const Joint& wanted) {
                      return has.link == wanted.link && has.ends.a == wanted.ends.a &&
                             has.ends.b == wanted.ends.b && !has.is_gone;
                    });
}

/// The joint that a motor or limit of the host's world belongs to; null: the island does not hold
/// it, or holds the constraint as a joint of its own.
ArmJoints::Joint* ArmJoints::findJoint(btMultiBodyConstraint& constraint) noexcept {
  const ArmConstraintKind kind = findKind(constraint);
  if (kind != ArmConstraintKind::kJointMotor && kind != ArmConstraintKind::kJointLimit)
    return nullptr;
  const auto is_its = [&](const Joint& joint) {
    return !joint.is_gone && &joint.link->arm().body() == constraint.getMultiBodyA() &&
           static_cast<int>(joint.link->number()) - 1 == constraint.getLinkA();
  };
  const auto place = std::find_if(joints_.begin(), joints_.end(), is_its);
  return place == joints_.end() ? nullptr : &*place;
}

/// In Bullet a motor holds the velocity that was handed off, by what the island leaves of its
/// bound: what Bullet's contacts press onto the arm meets its motors.
void ArmJoints::switchOff() noexcept {
  off_.clear();
  if (joints_.empty() || !host_) return;
  for (int i = 0; i < host_->getNumMultiBodyConstraints(); ++i) {
    btMultiBodyConstraint& constraint = *host_->getMultiBodyConstraint(i);
    Joint* joint = findJoint(constraint);
    if (!joint) continue;
    Off off{&constraint, constraint.getMaxAppliedImpulse(), {}};
    double left = 0.0;
    if (joint->motor == &constraint) {
      auto& motor = static_cast<btMultiBodyJointMotor&>(constraint);
      for (std::size_t k = 0; k < off.motor.size(); ++k) off.motor[k] = motor.*kMotorFields[k];
      const double speed = joint->link->arm().expectedVelocity(joint->link->number());
      motor.setVelocityTarget(static_cast<btScalar>(speed), 1);
      motor.setPositionTarget(0, 0);
      motor.setRhsClamp(SIMD_INFINITY);
      const Given& told = joint->told;
      const double own = told.time > 0.0 ? joint->settings.host_dt / told.time * told.motor : 0.0;
      left = std::max(0.0, static_cast<double>(off.impulse) - std::abs(own));
    }
    constraint.setMaxAppliedImpulse(static_cast<btScalar>(left));
    off_.push_back(off);
  }
}

void ArmJoints::switchOn() noexcept {
  for (const Off& off : off_) {
    // Without a bound that is left Bullet made no row, and its impulse is an old one.
    const bool has_acted = off.constraint->getMaxAppliedImpulse() > 0;
    off.constraint->setMaxAppliedImpulse(off.impulse);
    Joint* joint = findJoint(*off.constraint);
    if (!joint || joint->motor != off.constraint) continue;
    auto& motor = static_cast<btMultiBodyJointMotor&>(*off.constraint);
    for (std::size_t k = 0; k < off.motor.size(); ++k) motor.*kMotorFields[k] = off.motor[k];
    joint->by_bullet = has_acted ? readImpulse(motor, 0) : 0.0;
  }
  off_.clear();
}

void ArmJoints::forgetWorld() noexcept {
  for (Joint& joint : joints_) joint.is_gone = true;
  next_.clear();
  has_next_ = false;
  off_.clear();
}

bool ArmJoints::take() noexcept {
  if (!has_next_) return false;
  has_next_ = false;
  // Joints that stay go on with what they have.
  for (Joint& joint : next_)
    for (const Joint& before : joints_)
      if (!before.is_gone && before.link == joint.link && before.ends.b == joint.ends.b)
        joint = before;
  joints_.swap(next_);
  acting_.list(joints_);
  return true;
}

bool ArmJoints::refresh(const PayWindow& window) noexcept {
  if (joints_.empty() || !host_) return false;
  for (Joint& joint : joints_) {
    if (joint.is_gone) continue;
    HostArm& arm = joint.link->arm();
    joint.motor = joint.limit = nullptr;
    joint.by_bullet = 0.0;
    const std::size_t place = joint.link->number();
    const ArmLink& link = arm.model().links()[place];
    joint.settings.host_dt = window.dt;
    if (joint.ends.b == kStanding) {
      states_.resize(arm.model().size());
      arm.findStates(states_);
      joint.ground = states_[arm.model().carrier(link.parent)];
    }
    JointAxis* axis = findFreeAxis(link.kind, joint.settings);
    if (!axis) continue;
    const int number = static_cast<int>(place) - 1;
    const double push = axis->push;
    *axis = {};
    axis->counts_turns = true;
    axis->near = static_cast<double>(arm.body().getJointPos(number));
    axis->push = push;
    if (!(window.pay_over > 0.0)) continue;
    const double torque = static_cast<double>(arm.body().getJointTorque(number));
    joint.owed = torque == 0.0 && std::abs(joint.owed) < kNoImpulse ? 0.0 : joint.owed;
    joint.owed += window.dt * torque;
    axis->push = window.findForce(torque, joint.owed);
  }
  for (int i = 0; i < host_->getNumMultiBodyConstraints(); ++i)
    readConstraint(*host_->getMultiBodyConstraint(i), window.dt);
  bool has_changed = false;
  for (Joint& joint : joints_) {
    if (joint.is_gone) continue;
    has_changed |= !isSameJoint(joint.copy.settings(), joint.settings);
    joint.copy = JointCopy(joint.settings);
  }
  return has_changed;
}

/// Reads a motor or limit of the host's world as it is now.
void ArmJoints::readConstraint(btMultiBodyConstraint& constraint, double dt) noexcept {
  Joint* joint = findJoint(constraint);
  JointAxis* axis = joint ? findFreeAxis(joint->kind, joint->settings) : nullptr;
  if (!axis || !(constraint.getMaxAppliedImpulse() > 0)) return;
  if (findKind(constraint) == ArmConstraintKind::kJointMotor) {
    const auto& motor = static_cast<const btMultiBodyJointMotor&>(constraint);
    joint->motor = &constraint;
    axis->motor = JointMotor::kDrive;
    axis->force = static_cast<double>(motor.getMaxAppliedImpulse()) / dt;
    axis->speed = read(motor, MotorFields::kSpeed);
    axis->target = read(motor, MotorFields::kPlace);
    axis->gain = read(motor, MotorFields::kP) * read(motor, MotorFields::kErp) / dt;
    axis->share = read(motor, MotorFields::kD);
    axis->most = read(motor, MotorFields::kMost);
    axis->mass = joint->link->arm().findMass(joint->link->number());
  } else {
    const auto& limit = static_cast<const btMultiBodyJointLimitConstraint&>(constraint);
    const double low = static_cast<double>(limit.getLowerBound());
    const double high = static_cast<double>(limit.getUpperBound());
    if (low > high) return;
    joint->limit = &constraint;
    const bool is_first = axis->isFree();
    axis->low = is_first ? low : std::max(axis->low, low);
    axis->high = is_first ? high : std::min(axis->high, high);
  }
}

void ArmJoints::note(std::size_t joint, const JointRow& row, double impulse, double h,
                     bool is_first) noexcept {
  Given& given = joints_[acting_.places()[joint]].given;
  if (is_first) given.time += h;
  const JointRowKind kind = JointCopy::kindOf(row);
  if (kind == JointRowKind::kDrive) {
    given.motor += impulse;
  } else if (row.law == JointLaw::kLimit) {
    given.limit[kind == JointRowKind::kHighLimit ? 1 : 0] += impulse;
  } else {
    // Bullet's feedback counts neither motors nor limits.
    given.linear_W += impulse * row.n_W;
    given.angular_W += impulse * row.turn_a_W;
    if (kind == JointRowKind::kElastic) joints_[acting_.places()[joint]].owed -= impulse;
  }
}

void ArmJoints::tell(double dt) noexcept {
  for (Joint& joint : joints_) {
    if (joint.is_gone || !turnToGiven(joint)) continue;
    const Given& given = joint.told;
    const double scale = dt / given.time;  // ticks do not end with the host's steps
    if (joint.motor) tellImpulse(*joint.motor, 0, scale * given.motor + joint.by_bullet);
    for (int row = 0; joint.limit && row < joint.limit->getNumRows(); ++row)
      tellImpulse(*joint.limit, row, scale * given.limit[row]);
    tellFeedback(joint);
  }
}

/// The force on the link, about its centre of mass, as Bullet's settings want it.
void ArmJoints::tellFeedback(const Joint& joint) noexcept {
  const HostArm& arm = joint.link->arm();
  const btMultibodyLink& link = arm.body().getLink(static_cast<int>(joint.link->number()) - 1);
  if (!link.m_jointFeedback) return;
  const btContactSolverInfo& info = host_->getSolverInfo();
  const double rate = 1.0 / joint.told.time;
  const Quat q_WB = fromBullet(link.m_cachedWorldTransform.getRotation());
  const Vec3 f_B = q_WB.conjugate() * (rate * joint.told.linear_W);
  Vec3 t_B = q_WB.conjugate() * (rate * joint.told.angular_W);
  if (info.m_jointFeedbackInJointFrame) t_B -= f_B.cross(fromBullet(link.m_dVector));
  const bool in_world = info.m_jointFeedbackInWorldSpace;
  btSpatialForceVector& reaction = link.m_jointFeedback->m_reactionForces;
  reaction.m_topVec = toBullet(in_world ? Vec3(q_WB * f_B) : f_B);
  reaction.m_bottomVec = toBullet(in_world ? Vec3(q_WB * t_B) : t_B);
}

void ArmJoints::endTorques() noexcept {
  for (Joint& joint : joints_) {
    joint.owed = 0.0;
    if (JointAxis* axis = findFreeAxis(joint.kind, joint.settings)) axis->push = 0.0;
    joint.copy = JointCopy(joint.settings);
  }
}

void ArmJoints::drop(BodyIndex body) noexcept {
  endJointsOf(body, joints_);
  acting_.list(joints_);
}

double ArmJoints::rounding() const noexcept {
  return std::numeric_limits<double>::epsilon();  // JointCopy measures in double
}

void ArmJoints::evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                         std::vector<JointRow>& rows) noexcept {
  const Joint& wanted = joints_[acting_.places()[joint]];
  wanted.copy.evaluate(a, wanted.ends.b == kStanding ? wanted.ground : b, rows);
}

}  // namespace tandem
