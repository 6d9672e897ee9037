
#include <algorithm>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_world.h"

// Things that a host does to its world as a whole.

namespace tandem::demos::bench {
namespace {

constexpr int kThrong = 40;  // bodies that come at once

/// Pushes a body in each step, by Bullet's way for vehicles and characters.
class PushingAction final : public btActionInterface {
 public:
  PushingAction(btRigidBody& body, const btVector3& force) : body_(body), force_(force) {}
  void updateAction(btCollisionWorld* world, btScalar) override {
    const btCollisionObjectArray& objects = world->getCollisionObjectArray();
    if (objects.findLinearSearch(&body_) < objects.size()) body_.applyCentralForce(force_);
  }
  void debugDraw(btIDebugDraw*) override {}

 private:
  btRigidBody& body_;
  btVector3 force_;
};

}  // namespace

void GuestWorld::toggleFloor() {
  if (has_floor_) {
    world().removeRigidBody(floor_.get());
    for (const auto& body : bodies_) body->may_fall = true;
  } else {
    world().addRigidBody(floor_.get());
  }
  has_floor_ = !has_floor_;
}

void GuestWorld::moveFloor(btScalar up) {
  btTransform pose = floor_->getWorldTransform();
  pose.getOrigin() += btVector3(0, 0, up);
  floor_->setWorldTransform(pose);
  if (has_floor_) world().updateSingleAabb(floor_.get());
}

/// Puts back all that the host took out.
void GuestWorld::putBack() {
  if (!has_floor_) toggleFloor();
  for (const auto& body : bodies_) add(*body);
  for (const auto& arm : arms_) addArm(*arm);
}

void GuestWorld::toggleThrong() {
  if (!throng_.empty()) {
    for (const auto& body : throng_) world().removeRigidBody(body.get());
    throng_.clear();
    return;
  }
  auto& shape = makeShape(GuestShape::kBox, 0.01, 1);
  btVector3 inertia;
  shape.calculateLocalInertia(btScalar(0.05), inertia);
  for (int i = 0; i < kThrong; ++i) {
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(0.05), nullptr, &shape, inertia);
    info.m_startWorldTransform =
        toBullet(Vec3(0.05 * (i % 6) - 0.15, 0.05 * (i / 6) - 0.15, 0.2), Quat::Identity());
    throng_.push_back(std::make_unique<btRigidBody>(info));
    world().addRigidBody(throng_.back().get());
  }
}

void GuestWorld::toggleGhost() {
  if (ghost_) {
    world().removeCollisionObject(ghost_.get());
    ghost_.reset();
    return;
  }
  ghost_ = std::make_unique<btGhostObject>();
  ghost_->setCollisionShape(&makeShape(GuestShape::kBox, 0.2, 2));
  ghost_->setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
  world().addCollisionObject(ghost_.get());
}

void GuestWorld::toggleAction(Draw& draw) {
  btRigidBody& body = *drawDynamicBody(draw).rigid;
  const auto force = static_cast<btScalar>(draw.even(-3.0, 3.0));
  if (action_) {
    world().removeAction(action_.get());
    action_.reset();
    return;
  }
  action_ = std::make_unique<PushingAction>(body, btVector3(force, 0, 0));
  world().addAction(action_.get());
}

void GuestWorld::toggleSpring(Draw& draw) {
  constexpr double kPace = 20.0;  // [rad/s]
  const GuestBody& body = drawDynamicBody(draw);
  const double stiffness = body.plan.mass * kPace * kPace;
  const auto own = std::find_if(springs_.begin(), springs_.end(),
                                [&](const Spring& spring) { return spring.body == &body; });
  if (own != springs_.end()) {
    springs_.erase(own);
  } else {
    springs_.push_back({&body, toBullet(Vec3(body.plan.p_W + Vec3(0.0, 0.0, 0.05))),
                        static_cast<btScalar>(stiffness)});
  }
}

void GuestWorld::pullBySprings() {
  for (const Spring& spring : springs_) {
    btRigidBody& rigid = *spring.body->rigid;
    if (!spring.body->is_in_world || rigid.isStaticOrKinematicObject()) continue;
    rigid.activate();
    const btVector3 way = spring.at - rigid.getWorldTransform().getOrigin();
    rigid.applyCentralForce(spring.stiffness * way);
  }
}

void GuestWorld::replaceSolver() {
  old_solvers_.push_back(makeSolver());
  world().setConstraintSolver(old_solvers_.back().get());
}

void GuestWorld::save() {
  saved_.clear();
  for (const auto& body : bodies_)
    saved_.push_back({body->rigid->getWorldTransform(), body->rigid->getLinearVelocity(),
                      body->rigid->getAngularVelocity()});
}

void GuestWorld::restore() {
  for (std::size_t b = 0; b < saved_.size(); ++b) place(*bodies_[b], saved_[b]);
}

void GuestWorld::reset() {
  for (const auto& body : bodies_)
    place(*body,
          {toBullet(body->plan.p_W, body->plan.q_WB), btVector3(0, 0, 0), btVector3(0, 0, 0)});
  for (const auto& body : bodies_) renewPairs(*body);
  for (const auto& arm : arms_) arm->reset();
  world().getConstraintSolver()->reset();
  world().clearForces();
}

GuestWorld::Saved GuestWorld::motionOf(std::size_t body) const {
  const btRigidBody& rigid = *bodies_[body]->rigid;
  return {rigid.getWorldTransform(), rigid.getLinearVelocity(), rigid.getAngularVelocity()};
}

/// Puts a body elsewhere, as hosts do that restore a state.
void GuestWorld::place(GuestBody& body, const Saved& state) {
  btRigidBody& rigid = *body.rigid;
  if (body.plan.role == GuestRole::kMover || body.plan.role == GuestRole::kRamp) return;
  rigid.setWorldTransform(state.pose);
  rigid.setInterpolationWorldTransform(state.pose);
  rigid.setLinearVelocity(state.v);
  rigid.setAngularVelocity(state.w);
  rigid.setInterpolationLinearVelocity(state.v);
  rigid.setInterpolationAngularVelocity(state.w);
  rigid.updateInertiaTensor();
  rigid.activate(true);
}

}  // namespace tandem::demos::bench
