#include "contact_solver.h"

#include <algorithm>
#include <utility>

#include "tandem/bullet_bridge/convert.h"

#include "rotation_vector.h"

// One inner step. Bullet finds most contacts only where shapes overlap already (two boxes at any
// gap have none), which is too late: a body would sink in by v dt at each impact and be pushed out
// again. So
//
//   1. bodies are put at the END of their predicted motion and contacts are found there: an overlap
//      of d there is a contact that closes within the step;
//   2. each contact's distance is moved back to the START: d - v_n dt, positive for a body still
//      clear of the obstacle. Bullet's rows then let it close the gap and no more;
//   3. Bullet solves normal and friction rows for velocities;
//   4. the velocity change goes to the island's double state, and the pose follows from it.
//
// A resting body overlaps by g dt^2 at the end of each prediction, so its contacts are found afresh
// in each step and never flicker.

namespace tandem {
namespace {

constexpr btScalar kPushErp = btScalar(0.2);  // part of an overlap that is pushed out per step
constexpr int kIterations = 50;
/// Rows are solved to this velocity [m/s]; a sticking body creeps by less.
constexpr btScalar kResidual = sizeof(btScalar) == 8 ? btScalar(1e-9) : btScalar(1e-7);
/// Changes by less than these are Bullet's rounding, relative to the sizes that enter.
constexpr btScalar kRounding = 8 * SIMD_EPSILON;

btDefaultCollisionConstructionInfo makePools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 256;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 256;
  return info;
}

bool differs(const btVector3& a, const btVector3& b) {
  const btScalar size = a.length() + b.length();
  return (a - b).length() > kRounding * size;
}

}  // namespace

ContactSolver::ContactSolver(btScalar restitution_threshold)
    : configuration_(makePools()), dispatcher_(&configuration_) {
  // A body lying flat gets all its corners at once, instead of one per step while it rocks on the
  // others.
  configuration_.setPlaneConvexMultipointIterations(8, 4);
  settings_.m_numIterations = kIterations;
  settings_.m_leastSquaresResidualThreshold = kResidual * kResidual;
  // No warm start: what stopped an impact would push on in the next step, and not be taken back in
  // full.
  settings_.m_solverMode = SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
  // Overlap that is less deep than the threshold, counted negative, would be pushed out by
  // velocity, which stays: a bounce. None is.
  settings_.m_splitImpulse = 1;
  settings_.m_splitImpulsePenetrationThreshold = btScalar(1);
  settings_.m_erp2 = kPushErp;
  settings_.m_restitutionVelocityThreshold = restitution_threshold;
}

ContactSolver::~ContactSolver() {
  for (const auto& obstacle : obstacles_) removeAlgorithms(*obstacle);
}

std::size_t ContactSolver::addBody(const btRigidBody& original) {
  while (!obstacles_.empty()) removeObstacle(obstacles_.back()->original);
  Body body;
  body.copy = copyBody(original);
  bodies_.push_back(std::move(body));
  moving_.reserve(static_cast<int>(bodies_.size()));
  return bodies_.size() - 1;
}

ObstacleCopy& ContactSolver::addObstacle(btCollisionObject& original, std::vector<bool> meets) {
  obstacles_.push_back(std::make_unique<ObstacleCopy>(original));
  ObstacleCopy& obstacle = *obstacles_.back();
  obstacle.meets = std::move(meets);
  obstacle.algorithms.assign(bodies_.size(), nullptr);
  obstacle.place(origin_W_);
  return obstacle;
}

void ContactSolver::removeObstacle(const btCollisionObject* original) {
  const auto found = std::find_if(obstacles_.begin(), obstacles_.end(), [&](const auto& obstacle) {
    return obstacle->original == original;
  });
  if (found == obstacles_.end()) return;
  removeAlgorithms(**found);
  obstacles_.erase(found);
}

btTransform ContactSolver::toPrivate(const RigidState& state) const {
  return toBullet(Vec3(state.p_W - origin_W_), state.q_WB);
}

bool ContactSolver::isNear(std::size_t slot, const RigidState& state, double reach) const noexcept {
  const btCollisionShape& shape = *bodies_[slot].copy->getCollisionShape();
  const Region region =
      growRegion(computeRegion(shape, toPrivate(state)), static_cast<btScalar>(reach));
  for (const auto& obstacle : obstacles_) {
    if (obstacle->meets[slot] &&
        mayReach(*obstacle->object.getCollisionShape(), obstacle->object.getWorldTransform(),
                 obstacle->bounds, region)) {
      return true;
    }
  }
  return false;
}

void ContactSolver::predict(std::size_t slot, const RigidState& before,
                            const RigidState& after) noexcept {
  Body& body = bodies_[slot];
  body.before = before;
  body.after = after;
  body.predicted = true;
}

void ContactSolver::solve(double dt) noexcept {
  step_ = dt;
  moving_.resize(0);
  manifolds_.resize(0);
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    Body& body = bodies_[slot];
    body.touched = false;
    if (!body.predicted) continue;
    placeAtEnd(body, dt);
    findContacts(slot);
    moving_.push_back(body.copy.get());
  }
  const auto step = static_cast<btScalar>(dt);
  int points = 0;
  for (int i = 0; i < manifolds_.size(); ++i) points += manifolds_[i]->getNumContacts();
  if (points > 0) {
    for (Body& body : bodies_) {
      for (int i = 0; i < manifolds_.size() && body.predicted; ++i) {
        moveContactsToStart(*manifolds_[i], body, step);
      }
    }
    settings_.m_timeStep = step;
    solver_.solveGroup(&moving_[0], moving_.size(), &manifolds_[0], manifolds_.size(), nullptr, 0,
                       settings_, nullptr, &dispatcher_);
  }
  for (Body& body : bodies_) {
    if (body.predicted && points > 0) readBack(body);
    body.predicted = false;
  }
}

bool ContactSolver::correct(std::size_t slot, RigidState& after) const noexcept {
  const Body& body = bodies_[slot];
  if (!body.touched) return false;
  after.v_W += body.dv_W;
  after.w_W += body.dw_W;
  after.p_W = body.before.p_W + step_ * after.v_W + body.push_W;
  after.q_WB = (body.turn_W * makeRotation(step_ * after.w_W) * body.before.q_WB).normalized();
  return true;
}

void ContactSolver::placeAtEnd(Body& body, double dt) {
  RigidState end = body.after;
  end.p_W = body.before.p_W + dt * body.after.v_W;
  end.q_WB = makeRotation(dt * body.after.w_W) * body.before.q_WB;
  body.given_pose = toPrivate(end);
  body.given_v = toBullet(body.after.v_W);
  body.given_w = toBullet(body.after.w_W);
  body.copy->setLinearVelocity(body.given_v);
  body.copy->setAngularVelocity(body.given_w);
  body.copy->setCenterOfMassTransform(body.given_pose);
}

void ContactSolver::readBack(Body& body) const {
  const btVector3& v = body.copy->getLinearVelocity();
  const btVector3& w = body.copy->getAngularVelocity();
  body.dv_W = fromBullet(v) - fromBullet(body.given_v);
  body.dw_W = fromBullet(w) - fromBullet(body.given_w);
  body.push_W.setZero();
  body.turn_W.setIdentity();
  const btTransform& pose = body.copy->getWorldTransform();
  // Bullet shifts the pose only out of an overlap; smaller shifts are the rounding of the pose
  // itself.
  const btVector3 push = pose.getOrigin() - body.given_pose.getOrigin();
  const bool pushed = push.length() > kRounding * pose.getOrigin().length();
  if (pushed) body.push_W = fromBullet(push);
  const Quat turn =
      fromBullet(pose.getRotation()) * fromBullet(body.given_pose.getRotation()).conjugate();
  const bool turned = turn.vec().norm() > static_cast<double>(kRounding);
  if (turned) body.turn_W = turn;
  body.touched = pushed || turned || differs(v, body.given_v) || differs(w, body.given_w);
}

}  // namespace tandem
