#include "arms/host_arm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem {
namespace {

/// Bullet's damping d also resists with d |v| v. Below this speed that counts as nothing [m/s or
/// rad/s].
constexpr double kDragSpeed = 1e-3;

/// Turn in a step of the host above which no drag acts over it [rad].
constexpr double kMostTurn = 0.5;

/// Change of a velocity that is rounding, beside it and in itself [m/s or rad/s].
constexpr double kRounding = 16.0 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());
constexpr double kNoSpeed = 1e-14;

/// How often the accelerations that are left are cancelled: a float's rounding needs two.
constexpr int kCancellations = 2;

bool isSameState(const RigidState& a, const RigidState& b) {
  return a.p_W == b.p_W && a.q_WB.coeffs() == b.q_WB.coeffs();
}

bool hasSamePose(const ArmCoordinates& a, const ArmCoordinates& b) {
  const auto same = [](const auto& x, const auto& y) { return x.q == y.q; };
  return isSameState(a.base, b.base) &&
         std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(), same);
}

bool hasSameVelocity(const ArmCoordinates& a, const ArmCoordinates& b) {
  const auto same = [](const auto& x, const auto& y) { return x.u == y.u; };
  return a.base.v_W == b.base.v_W && a.base.w_W == b.base.w_W &&
         std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(), same);
}

Vec3 turnMomentum(const Quat& q_WB, const Vec3& inertia, const Vec3& w_W) {
  return q_WB * inertia.cwiseProduct(q_WB.conjugate() * w_W);
}

}  // namespace

HostArm::HostArm(btDiscreteDynamicsWorld& world, btMultiBody& body)
    : world_(world),
      body_(body),
      model_(body),
      look_(body),
      dofs_(static_cast<std::size_t>(body.getNumDofs())) {
  const std::size_t count = model_.size();
  for (std::size_t place = 0; place < count; ++place)
    if (model_.links()[place].role == LinkRole::kBody)
      links_.push_back(std::make_unique<LinkBody>(*this, place));
  for (auto* states : {&states_, &known_states_, &start_states_}) states->resize(count);
  momenta_.resize(count);
  impulses_.resize(count);
  host_torques_.resize(count);
  const std::size_t all = 6 + dofs_;
  for (auto* list : {&expected_, &velocities_, &accelerations_, &unit_, &response_})
    list->resize(all);
  const std::size_t free = model_.isBaseFixed() ? dofs_ : all;
  mobility_.resize(static_cast<Eigen::Index>(free), static_cast<Eigen::Index>(free));
  load_.resize(static_cast<Eigen::Index>(free));
  solver_ = Eigen::LDLT<Eigen::MatrixXd>(static_cast<Eigen::Index>(free));
  for (ArmCoordinates* coordinates : {&known_, &start_, &end_, &mean_, &now_})
    ArmModel::read(body_, *coordinates);
  has_no_weight_ = !body_.isAwake();
  wake();
  show(known_);
  computeAccelerations();  // makes room in the working memory
  readMobility();
}

HostArm::~HostArm() {
  if (is_handed_ && isInWorld() && look_.isOf(body_)) giveForcesBack();
}

void HostArm::wake() noexcept {
  body_.wakeUp();
  for (const auto& link : links_)
    if (btCollisionObject* collider = link->collider(); collider && !collider->isActive())
      collider->activate(true);
}

Vec3 HostArm::worldGravity() const noexcept { return fromBullet(world_.getGravity()); }

RigidState HostArm::findState(std::size_t place) const noexcept {
  findStates(states_);
  return states_[place];
}

void HostArm::findStates(std::vector<RigidState>& states) const noexcept {
  ArmModel::read(body_, now_);
  model_.findLinks(now_, states);
}

void HostArm::remember() noexcept {
  ArmModel::read(body_, known_);
  model_.findLinks(known_, known_states_);
}

void HostArm::shiftOrigin(const Vec3& offset_W) noexcept {
  for (ArmCoordinates* coordinates : {&known_, &start_, &end_}) coordinates->base.p_W += offset_W;
  for (RigidState& state : known_states_) state.p_W += offset_W;
}

/// Reads what the host did to the multi-body, and its forces in the coming step.
void HostArm::look(double dt) noexcept {
  wake();
  ArmModel::read(body_, now_);
  const bool is_moved = !hasSamePose(now_, known_), is_pushed = !hasSameVelocity(now_, known_);
  model_.findLinks(now_, states_);
  for (const auto& link : links_) {
    HostChange& change = link->change_;
    change = {};
    if (!is_moved) continue;
    const RigidState &now = states_[link->number_], &known = known_states_[link->number_];
    change.moved = true;
    change.offset_W = now.p_W - known.p_W;
    change.rotation_W = now.q_WB * known.q_WB.conjugate();
  }
  noteForces(dt);
  for (const auto& link : links_) {
    if (!is_moved && !is_pushed) break;
    // A move turns the velocities of what hangs on its joints, too.
    const RigidState &now = states_[link->number_], &known = known_states_[link->number_];
    link->change_.impulse_W += link->mass() * (now.v_W - known.v_W);
    link->change_.angular_impulse_W += turnMomentum(now.q_WB, link->inertia(), now.w_W - known.w_W);
  }
  for (const auto& link : links_)
    if (!isFinite(link->change_)) link->change_ = {};
  remember();
}

/// Reads forces on links and torques of joints with several axes. Those of single axes are rows of
/// the joints.
void HostArm::noteForces(double dt) noexcept {
  const btVector3 gravity = world_.getGravity();
  bool is_any = false;
  for (const auto& link : links_) {
    const int i = static_cast<int>(link->number_) - 1;
    is_any |= !(i < 0 ? body_.getBaseForce() : body_.getLinkForce(i)).isZero();
  }
  // Bullet gives weight when stepSimulation() begins, and only to those who are awake then.
  if (has_no_weight_ && !is_any) {
    body_.addBaseForce(gravity * body_.getBaseMass());
    for (int i = 0; i < body_.getNumLinks(); ++i)
      body_.addLinkForce(i, gravity * body_.getLinkMass(i));
  }
  has_no_weight_ = false;
  for (const auto& link : links_) {
    const int i = static_cast<int>(link->number_) - 1;
    HostChange& change = link->change_;
    const btVector3 weight = gravity * (i < 0 ? body_.getBaseMass() : body_.getLinkMass(i));
    change.f_W = fromBullet((i < 0 ? body_.getBaseForce() : body_.getLinkForce(i)) - weight);
    change.t_W = fromBullet(i < 0 ? body_.getBaseTorque() : body_.getLinkTorque(i));
    addDrag(*link, states_[link->number_], dt);
  }
  for (const auto& link : links_) {
    const ArmLink& joint = model_.links()[link->number_];
    if (joint.dofs < 2) continue;
    const btScalar* torque = body_.getJointTorqueMultiDof(static_cast<int>(link->number_) - 1);
    const Quat& q_WB = states_[link->number_].q_WB;
    Vec3 f_W = Vec3::Zero(), t_W = Vec3::Zero();
    for (std::size_t k = 0; k < joint.dofs; ++k) {
      const double part = static_cast<double>(torque[k]);
      if (part == 0.0) continue;
      // The joint gives a torque: the way of the centre about its pivot follows.
      t_W += part * (q_WB * joint.turn[k]);
      if (joint.kind == LinkKind::kPlanar) f_W += part * (q_WB * joint.slide[k]);
    }
    link->change_.f_W += f_W;
    link->change_.t_W += t_W;
    const std::size_t carrier = model_.carrier(joint.parent);
    for (const auto& other : links_) {
      if (other->number_ != carrier) continue;
      const Vec3 arm_W = states_[link->number_].p_W - states_[carrier].p_W;
      other->change_.f_W -= f_W;
      other->change_.t_W -= t_W + arm_W.cross(f_W);
    }
  }
}

/// Bullet's damping is -d (1 + |v|) v. The island has the part without |v|. The other is a force
/// over the step, unless the link turns so far in it that the force would push.
void HostArm::addDrag(LinkBody& link, const RigidState& state, double dt) const noexcept {
  const double v = state.v_W.norm(), w = state.w_W.norm();
  if (w * dt > kMostTurn) return;
  if (v > kDragSpeed)
    link.change_.f_W -= static_cast<double>(body_.getLinearDamping()) * link.mass() * v * state.v_W;
  if (w > kDragSpeed)
    link.change_.t_W -= static_cast<double>(body_.getAngularDamping()) * w *
                        turnMomentum(state.q_WB, link.inertia(), state.w_W);
}

/// Coordinates by what the island told of the links, `dt` [s] after those in `into`.
void HostArm::takeEnds(ArmCoordinates& into, double dt) noexcept {
  for (const auto& link : links_) states_[link->number_] = link->end_;
  model_.findCoordinates(states_, into, dt);
}

void HostArm::show(const ArmCoordinates& coordinates) noexcept {
  model_.write(coordinates, body_);
  body_.forwardKinematics(turns_, origins_);
  body_.updateCollisionObjectWorldTransforms(turns_, origins_);
}

void HostArm::handOff(double dt) noexcept {
  if (!(dt > 0.0)) return;
  wake();
  if (has_put_) putLinks();
  ArmModel::read(body_, start_);
  model_.findLinks(start_, start_states_);
  end_ = start_;
  takeEnds(end_, dt);
  mean_ = start_;
  model_.findMeanVelocity(start_, end_, dt, mean_);
  readMobility();
  addMomenta(mean_);
  is_handed_ = true;
  most_velocity_ = body_.getMaxCoordinateVelocity();
  body_.setMaxCoordinateVelocity(std::numeric_limits<btScalar>::max());
  model_.write(mean_, body_);
  cancelAccelerations(dt);
}

/// Puts all links elsewhere at once.
void HostArm::putLinks() noexcept {
  has_put_ = false;
  ArmModel::read(body_, end_);
  for (const auto& link : links_) states_[link->number_] = link->put_;
  model_.findCoordinates(states_, end_);
  show(end_);
}

/// Velocities by unit impulses. Bullet's cache is that of the present pose.
void HostArm::readMobility() noexcept {
  computeAccelerations();
  const std::size_t free = static_cast<std::size_t>(load_.size()), skipped = 6 + dofs_ - free;
  for (std::size_t j = 0; j < free; ++j) {
    std::fill(unit_.begin(), unit_.end(), btScalar(0));
    unit_[skipped + j] = 1;
    body_.calcAccelerationDeltasMultiDof(unit_.data(), response_.data(), scratch_r_, scratch_v_);
    for (std::size_t i = 0; i < free; ++i)
      mobility_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          static_cast<double>(response_[skipped + i]);
  }
}

void HostArm::readDamping(double& linear, double& angular) const noexcept {
  linear = static_cast<double>(body_.getLinearDamping());
  angular = static_cast<double>(body_.getAngularDamping());
}

std::size_t HostArm::findDof(std::size_t place) const noexcept {
  std::size_t dof = 0;
  for (std::size_t i = 1; i < place; ++i) dof += model_.links()[i].dofs;
  return dof;
}

double HostArm::findMass(std::size_t place, std::size_t dof) const noexcept {
  const std::size_t row = (model_.isBaseFixed() ? 0 : 6) + findDof(place) + dof;
  const double mobility = mobility_(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(row));
  return mobility > 0.0 ? 1.0 / mobility : 0.0;
}

/// Takes impulses that Bullet's solver will find out of the velocities that it starts with.
void HostArm::addMomenta(ArmCoordinates& to) noexcept {
  bool is_any = false;
  std::fill(momenta_.begin(), momenta_.end(), Momentum{});
  for (const auto& link : links_) {
    momenta_[link->number_] = -1.0 * link->foreseen_;
    is_any |= !link->foreseen_.isZero();
  }
  if (is_any) applyMomenta(start_states_, to);
}

/// Adds to velocities what `momenta_`, given to links at poses `links`, lead to.
void HostArm::applyMomenta(const std::vector<RigidState>& links, ArmCoordinates& to) noexcept {
  model_.findJointImpulses(links, momenta_, impulses_);
  Eigen::Index next = 0;
  if (!model_.isBaseFixed()) {
    load_.segment<3>(0) = momenta_[0].angular_W;
    load_.segment<3>(3) = momenta_[0].linear_W;
    next = 6;
  }
  for (std::size_t place = 1; place < model_.size(); ++place)
    for (std::size_t i = 0; i < model_.links()[place].dofs; ++i)
      load_[next++] = impulses_[place][i];
  const Eigen::Index size = load_.size();
  const auto part = [&](Eigen::Index row) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < size; ++k) sum += mobility_(row, k) * load_[k];
    return sum;
  };
  next = 0;
  if (!model_.isBaseFixed()) {
    to.base.w_W += Vec3(part(0), part(1), part(2));
    to.base.v_W += Vec3(part(3), part(4), part(5));
    next = 6;
  }
  for (std::size_t place = 1; place < model_.size(); ++place)
    for (std::size_t i = 0; i < model_.links()[place].dofs; ++i)
      to.joints[place].u[i] += part(next++);
}

/// Accelerations by all forces at the present state, without a step.
void HostArm::computeAccelerations() noexcept {
  body_.computeAccelerationsArticulatedBodyAlgorithmMultiDof(0, scratch_r_, scratch_v_, scratch_m_,
                                                             false, false, false);
  for (std::size_t i = 0; i < accelerations_.size(); ++i)
    accelerations_[i] = scratch_r_[static_cast<int>(dofs_ + i)];
}

/// Adds forces to the host's that leave no acceleration. restore() takes them off again.
void HostArm::cancelAccelerations(double dt) noexcept {
  for (int k = 0; k < 3; ++k) {
    host_base_[static_cast<std::size_t>(k)] = body_.getBaseTorque()[k];
    host_base_[static_cast<std::size_t>(k) + 3] = body_.getBaseForce()[k];
  }
  for (std::size_t place = 1; place < model_.size(); ++place)
    for (std::size_t k = 0; k < model_.links()[place].dofs; ++k)
      host_torques_[place][k] = body_.getJointTorqueMultiDof(static_cast<int>(place) - 1)[k];
  factorise();
  for (int round = 0; round < kCancellations; ++round) {
    computeAccelerations();
    const std::size_t free = static_cast<std::size_t>(load_.size()), skipped = 6 + dofs_ - free;
    for (std::size_t i = 0; i < free; ++i)
      load_[static_cast<Eigen::Index>(i)] = -static_cast<double>(accelerations_[skipped + i]);
    solver_.solveInPlace(load_);
    Eigen::Index next = 0;
    if (!model_.isBaseFixed()) {
      body_.addBaseTorque(toBullet(Vec3(load_.segment<3>(0))));
      body_.addBaseForce(toBullet(Vec3(load_.segment<3>(3))));
      next = 6;
    }
    for (std::size_t place = 1; place < model_.size(); ++place)
      for (std::size_t k = 0; k < model_.links()[place].dofs; ++k)
        body_.addJointTorqueMultiDof(static_cast<int>(place) - 1, static_cast<int>(k),
                                     static_cast<btScalar>(load_[next++]));
  }
  computeAccelerations();
  readVelocities(expected_);
  for (std::size_t i = 0; i < expected_.size(); ++i)
    expected_[i] += accelerations_[i] * static_cast<btScalar>(dt);
}

void HostArm::readVelocities(std::vector<btScalar>& into) const noexcept {
  const btScalar* velocities = body_.getVelocityVector();
  std::copy(velocities, velocities + into.size(), into.begin());
}

void HostArm::restore() noexcept {
  for (const auto& link : links_) link->change_ = {};
  if (!is_handed_) return;
  is_handed_ = false;
  giveForcesBack();
  findSolverChange();
  takeEnds(end_);
  show(end_);
  remember();
}

void HostArm::giveForcesBack() noexcept {
  body_.setMaxCoordinateVelocity(most_velocity_);
  btVector3 torque, force;
  for (int k = 0; k < 3; ++k) {
    torque[k] = host_base_[static_cast<std::size_t>(k)];
    force[k] = host_base_[static_cast<std::size_t>(k) + 3];
  }
  body_.addBaseTorque(torque - body_.getBaseTorque());
  body_.addBaseForce(force - body_.getBaseForce());
  for (std::size_t place = 1; place < model_.size(); ++place)
    for (std::size_t k = 0; k < model_.links()[place].dofs; ++k)
      body_.getJointTorqueMultiDof(static_cast<int>(place) - 1)[k] = host_torques_[place][k];
}

/// Reads what Bullet's solver gave, and the pose that it led to.
void HostArm::findSolverChange() noexcept {
  readVelocities(velocities_);
  bool is_pushed = false;
  for (const auto& link : links_) is_pushed |= !link->foreseen_.isZero();
  for (std::size_t i = model_.isBaseFixed() ? 6 : 0; i < velocities_.size(); ++i) {
    const double expected = static_cast<double>(expected_[i]);
    const double by = static_cast<double>(velocities_[i]) - expected;
    velocities_[i] = std::abs(by) > kNoSpeed + kRounding * std::abs(expected)
                         ? velocities_[i] - expected_[i]
                         : btScalar(0);
    is_pushed |= velocities_[i] != 0;
  }
  if (!is_pushed) return;
  ArmModel::read(body_, now_);
  model_.findLinks(now_, states_);
  setVelocities(start_);
  model_.findLinks(start_, start_states_);
  for (const auto& link : links_) {
    HostChange& change = link->change_;
    const RigidState &by = start_states_[link->number_], &met = states_[link->number_];
    change.impulse_W = link->mass() * by.v_W;
    change.angular_impulse_W = turnMomentum(by.q_WB, link->inertia(), by.w_W);
    change.moved = true;
    change.offset_W = met.p_W - link->end_.p_W;
    change.rotation_W = met.q_WB * link->end_.q_WB.conjugate();
    if (!isFinite(change)) change = {};
  }
}

/// Takes velocities from `velocities_`.
void HostArm::setVelocities(ArmCoordinates& into) const noexcept {
  const auto at = [&](std::size_t i) { return static_cast<double>(velocities_[i]); };
  into.base.v_W = into.base.w_W = Vec3::Zero();
  if (!model_.isBaseFixed()) {
    into.base.w_W = Vec3(at(0), at(1), at(2));
    into.base.v_W = Vec3(at(3), at(4), at(5));
  }
  std::size_t next = 6;
  for (std::size_t place = 1; place < model_.size(); ++place)
    for (std::size_t i = 0; i < model_.links()[place].dofs; ++i)
      into.joints[place].u[i] = at(next++);
}

void HostArm::place() noexcept {
  if (!has_place_) return;
  has_place_ = false;
  takeEnds(end_);
  show(end_);
  remember();
}

void HostArm::addMomentum(std::size_t place, const Momentum& momentum) noexcept {
  if (momentum.isZero()) return;
  std::fill(momenta_.begin(), momenta_.end(), Momentum{});
  momenta_[place] = momentum;
  ArmModel::read(body_, now_);
  model_.findLinks(now_, states_);
  readMobility();
  applyMomenta(states_, now_);
  model_.write(now_, body_);
}

/// Mobility is symmetric but for Bullet's rounding.
void HostArm::factorise() noexcept { solver_.compute(mobility_); }

}  // namespace tandem
