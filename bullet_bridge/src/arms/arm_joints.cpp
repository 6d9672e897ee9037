#include "arms/arm_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <typeinfo>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem {
namespace {

/// Bullet shows these of a motor to classes derived from it only.
struct MotorFields : btMultiBodyJointMotor {
  static constexpr auto kSpeed = &MotorFields::m_desiredVelocity;
  static constexpr auto kPlace = &MotorFields::m_desiredPosition;
  static constexpr auto kP = &MotorFields::m_kp;
  static constexpr auto kD = &MotorFields::m_kd;
  static constexpr auto kErp = &MotorFields::m_erp;
  static constexpr auto kMost = &MotorFields::m_rhsClamp;
};

struct ConstraintFields : btMultiBodyConstraint {
  static constexpr auto kData = &ConstraintFields::m_data;
};

/// Tells the host an impulse, if Bullet has made room for it: it does so in its first step with it.
void tellImpulse(btMultiBodyConstraint& constraint, int row, double impulse) {
  if ((constraint.*ConstraintFields::kData).size() > row)
    constraint.internalSetAppliedImpulse(row, static_cast<btScalar>(impulse));
}

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
  joint.b = {link.e, link.q_PZ.toRotationMatrix() * axes};
  // Frames without mass are parts of what carries them.
  for (std::size_t at = link.parent; model.links()[at].role == LinkRole::kFrame;
       at = model.links()[at].parent) {
    const ArmLink& frame = model.links()[at];
    joint.b.p = frame.e + frame.q_PZ * (frame.d + joint.b.p);
    joint.b.axes = frame.q_PZ.toRotationMatrix() * joint.b.axes;
  }
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
    next_.push_back({&link, {member.index, parent, &link}, settings, JointCopy(settings)});
    most_links = std::max(most_links, model.size());
  }
  has_next_ = !isAsWanted();
  if (!has_next_) return next_.clear();
  // The thread that ticks allocates nothing.
  ends_.reserve(kMaxJoints);
  acting_.reserve(kMaxJoints);
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

/// True for a motor or limit of an arm that the island holds.
bool ArmJoints::isHeld(const btMultiBodyConstraint& constraint) const noexcept {
  auto& of = const_cast<btMultiBodyConstraint&>(constraint);
  return std::any_of(joints_.begin(), joints_.end(), [&](const Joint& joint) {
    return !joint.is_gone && &joint.link->arm().body() == of.getMultiBodyA();
  });
}

void ArmJoints::switchOff() noexcept {
  off_.clear();
  if (joints_.empty() || !host_) return;
  for (int i = 0; i < host_->getNumMultiBodyConstraints(); ++i) {
    btMultiBodyConstraint& constraint = *host_->getMultiBodyConstraint(i);
    if (!isHeld(constraint)) continue;
    off_.push_back({&constraint, constraint.getMaxAppliedImpulse()});
    constraint.setMaxAppliedImpulse(0);
  }
}

void ArmJoints::switchOn() noexcept {
  for (const Off& off : off_) off.constraint->setMaxAppliedImpulse(off.impulse);
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
  joints_.swap(next_);
  listActing();
  return true;
}

bool ArmJoints::refresh(double dt) noexcept {
  if (joints_.empty() || !host_) return false;
  for (Joint& joint : joints_) {
    if (joint.is_gone) continue;
    HostArm& arm = joint.link->arm();
    joint.motor = joint.limit = nullptr;
    const std::size_t place = joint.link->number();
    const ArmLink& link = arm.model().links()[place];
    joint.settings.host_dt = dt;
    if (joint.ends.b == kStanding) {
      states_.resize(arm.model().size());
      arm.findStates(states_);
      joint.ground = states_[arm.model().carrier(link.parent)];
    }
    JointAxis* axis = findFreeAxis(link.kind, joint.settings);
    if (!axis) continue;
    const int number = static_cast<int>(place) - 1;
    *axis = {};
    axis->counts_turns = true;
    axis->near = static_cast<double>(arm.body().getJointPos(number));
    axis->push = static_cast<double>(arm.body().getJointTorque(number));
  }
  for (int i = 0; i < host_->getNumMultiBodyConstraints(); ++i)
    readConstraint(*host_->getMultiBodyConstraint(i), dt);
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
  for (Joint& joint : joints_) {
    const HostArm& arm = joint.link->arm();
    const std::size_t place = joint.link->number();
    if (joint.is_gone || &arm.body() != constraint.getMultiBodyA() ||
        static_cast<int>(place) - 1 != constraint.getLinkA())
      continue;
    JointAxis* axis = findFreeAxis(arm.model().links()[place].kind, joint.settings);
    if (!axis) return;
    if (typeid(constraint) == typeid(btMultiBodyJointMotor)) {
      const auto& motor = static_cast<const btMultiBodyJointMotor&>(constraint);
      const double impulse = static_cast<double>(motor.getMaxAppliedImpulse());
      if (!(impulse > 0.0)) return;
      joint.motor = &constraint;
      axis->motor = JointMotor::kDrive;
      axis->force = impulse / dt;
      axis->speed = read(motor, MotorFields::kSpeed);
      axis->target = read(motor, MotorFields::kPlace);
      axis->gain = read(motor, MotorFields::kP) * read(motor, MotorFields::kErp) / dt;
      axis->share = read(motor, MotorFields::kD);
      axis->most = read(motor, MotorFields::kMost);
      axis->mass = arm.findMass(place);
    } else {
      const auto& limit = static_cast<const btMultiBodyJointLimitConstraint&>(constraint);
      const double low = static_cast<double>(limit.getLowerBound());
      const double high = static_cast<double>(limit.getUpperBound());
      if (low > high || !(constraint.getMaxAppliedImpulse() > 0)) return;
      joint.limit = &constraint;
      const bool is_first = axis->isFree();
      axis->low = is_first ? low : std::max(axis->low, low);
      axis->high = is_first ? high : std::min(axis->high, high);
    }
    return;
  }
}

void ArmJoints::note(std::size_t joint, const JointRow& row, double impulse, double h,
                     bool is_first) noexcept {
  Given& given = joints_[acting_[joint]].given;
  if (is_first) given.time += h;
  given.linear_W += impulse * row.n_W;
  given.angular_W += impulse * row.turn_a_W;
  switch (JointCopy::kindOf(row)) {
    case JointRowKind::kDrive:
      given.motor += impulse;
      break;
    case JointRowKind::kHold:
      if (row.law == JointLaw::kLimit) given.limit[0] += impulse;
      break;
    case JointRowKind::kHighLimit:
      given.limit[1] += impulse;
      break;
    case JointRowKind::kElastic:
      break;
  }
}

void ArmJoints::tell(double dt) noexcept {
  for (Joint& joint : joints_) {
    if (joint.is_gone) continue;
    // A joint at rest goes on with its last forces.
    if (joint.given.time > 0.0) joint.told = joint.given;
    joint.given = {};
    const Given& given = joint.told;
    if (!(given.time > 0.0)) continue;
    const double scale = dt / given.time;  // ticks do not end with the host's steps
    if (joint.motor) tellImpulse(*joint.motor, 0, scale * given.motor);
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

void ArmJoints::drop(BodyIndex body) noexcept {
  for (Joint& joint : joints_) joint.is_gone |= joint.ends.a == body || joint.ends.b == body;
  listActing();
}

void ArmJoints::listActing() noexcept {
  ends_.clear();
  acting_.clear();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].is_gone) continue;
    ends_.push_back(joints_[i].ends);
    acting_.push_back(i);
  }
}

double ArmJoints::rounding() const noexcept {
  return std::numeric_limits<double>::epsilon();  // JointCopy measures in double
}

void ArmJoints::evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                         std::vector<JointRow>& rows) noexcept {
  const Joint& wanted = joints_[acting_[joint]];
  wanted.copy.evaluate(a, wanted.ends.b == kStanding ? wanted.ground : b, rows);
}

}  // namespace tandem
