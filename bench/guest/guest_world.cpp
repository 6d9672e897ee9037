#include "bench/guest/guest_world.h"

#include <cmath>
#include <new>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::demos::bench {
namespace {

constexpr double kGravity = 9.81;      // [m/s^2]
constexpr double kMoverWay = 0.08;     // [m]
constexpr double kMoverPace = 8.0;     // [rad/s]
constexpr double kWalkingSpeed = 0.3;  // of characters [m/s]
constexpr int kStepsOfAStride = 5;     // steps between two of a character's commands

}  // namespace

GuestWorld::GuestWorld(const GuestCase& one)
    : case_(one), physics_(std::make_unique<Physics>(one)) {
  world().setGravity(toBullet(Vec3(0.0, 0.0, -kGravity)));
  world().setInternalTickCallback(inPreTick, this, true);
  world().setWorldUserInfo(this);
  makeFloor();
  for (const GuestPlan& plan : one.bodies) {
    bodies_.push_back(std::make_unique<GuestBody>());
    GuestBody& body = *bodies_.back();
    body.plan = plan;
    body.mass = plan.role == GuestRole::kMover || plan.role == GuestRole::kRamp ? 0.0 : plan.mass;
    if (plan.role == GuestRole::kRamp) {
      shapes_.push_back(std::make_unique<btBoxShape>(toBullet(Vec3(0.1, 0.1, 0.02))));
      body.shape = shapes_.back().get();
    } else if (plan.shares_shape_with >= 0) {
      body.shape = bodies_[static_cast<std::size_t>(plan.shares_shape_with)]->shape;
    } else {
      body.shape = &makeShape(plan.shape, plan.size, plan.seed);
    }
    make(body);
    add(body);
  }
  Draw draw(one.seed ^ 0x6a6f696e74U, one.index);
  for (int j = 0; j < one.joints; ++j) addJoint(draw);
  makeArms();
}

GuestWorld::~GuestWorld() {
  if (hasWorld()) endWorld();
  for (const auto& body : bodies_)
    if (body->rigid) destroy(*body);
}

GuestBody& GuestWorld::drawBody(Draw& draw) {
  return *bodies_[static_cast<std::size_t>(draw.count(0, static_cast<int>(bodies_.size()) - 1))];
}

GuestBody& GuestWorld::drawDynamicBody(Draw& draw) {
  GuestBody* body = nullptr;
  do body = &drawBody(draw);
  while (body->mass == 0.0);
  return *body;
}

void GuestWorld::make(GuestBody& body) {
  btVector3 inertia(0, 0, 0);
  const auto mass = static_cast<btScalar>(body.mass);
  if (body.mass > 0.0) body.shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, body.shape, inertia);
  info.m_startWorldTransform = toBullet(body.plan.p_W, body.plan.q_WB);
  body.rigid = new (static_cast<void*>(body.memory)) btRigidBody(info);
  btRigidBody& rigid = *body.rigid;
  if (case_.is_planar && body.mass > 0.0) {
    rigid.setLinearFactor(btVector3(1, 0, 1));
    rigid.setAngularFactor(btVector3(0, 1, 0));
  }
  if (body.plan.role == GuestRole::kCharacter) rigid.setAngularFactor(0);
  if (body.plan.role == GuestRole::kMover) {
    rigid.setCollisionFlags(rigid.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    rigid.setActivationState(DISABLE_DEACTIVATION);
  }
}

void GuestWorld::add(GuestBody& body) {
  if (body.is_in_world) return;
  body.was_added_anew = steps_ > 0;
  if (body.has_filter) {
    world().addRigidBody(body.rigid, body.group, body.mask);
  } else {
    world().addRigidBody(body.rigid);
  }
  body.is_in_world = true;
  body.missed_gravity = false;
}

/// Joints and ties of a body go before it, as Bullet asks of its hosts.
void GuestWorld::remove(GuestBody& body) {
  if (!body.is_in_world) return;
  removeJointsOf(body);
  removeTiesOf(body);
  world().removeRigidBody(body.rigid);
  body.is_in_world = false;
}

void GuestWorld::destroy(GuestBody& body) {
  if (hasWorld()) remove(body);
  body.rigid->~btRigidBody();
  body.rigid = nullptr;
}

void GuestWorld::removeTiesOf(const GuestBody& body) {
  for (const auto& arm : arms_) arm->removeTiesOf(*body.rigid);
}

void GuestWorld::setMass(GuestBody& body, double mass) {
  if (mass == 0.0) removeTiesOf(body);
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) body.shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  body.rigid->setMassProps(static_cast<btScalar>(mass), inertia);
  body.rigid->updateInertiaTensor();
}

void GuestWorld::setShape(GuestBody& body, btCollisionShape& shape) {
  body.shape = &shape;
  body.rigid->setCollisionShape(&shape);
  if (body.rigid->getInvMass() > 0) setMass(body, body.mass);
}

void GuestWorld::renewPairs(GuestBody& body) {
  if (!body.is_in_world) return;
  world().getBroadphase()->getOverlappingPairCache()->cleanProxyFromPairs(
      body.rigid->getBroadphaseHandle(), world().getDispatcher());
}

void GuestWorld::setGravity(const btVector3& g_W) {
  world().setGravity(g_W);
  gravity_step_ = steps_;
  for (const auto& body : bodies_) {
    body->missed_gravity = body->is_in_world && !body->rigid->isActive();
    body->has_unclear_gravity |= steps_ - body->gravity_step <= 1;
  }
}

void GuestWorld::noteGravityOf(GuestBody& body) {
  body.gravity_step = steps_;
  body.has_unclear_gravity |= steps_ - gravity_step_ <= 1;
}

void GuestWorld::step(double time, const std::function<void()>& pending) {
  ++steps_;
  for (const auto& body : bodies_) {
    if (body->plan.role == GuestRole::kMover) {
      Vec3 p_W = body->plan.p_W;
      p_W.x() += kMoverWay * (1.0 - std::cos(kMoverPace * time));
      body->rigid->setWorldTransform(toBullet(p_W, body->plan.q_WB));
    }
    if (body->plan.role == GuestRole::kCharacter && steps_ % kStepsOfAStride == 0 &&
        body->rigid->getInvMass() > 0) {
      body->rigid->activate();
      btVector3 v = body->rigid->getLinearVelocity();
      v.setX(static_cast<btScalar>(std::sin(kMoverPace * time) * kWalkingSpeed));
      body->rigid->setLinearVelocity(v);
    }
  }
  pullBySprings();
  pending_ = &pending;
  world().stepSimulation(static_cast<btScalar>(case_.frame), case_.max_substeps,
                         static_cast<btScalar>(case_.fixed_step));
  pending_ = nullptr;
}

void GuestWorld::inPreTick(btDynamicsWorld* world, btScalar) {
  auto& self = *static_cast<GuestWorld*>(world->getWorldUserInfo());
  if (!self.pending_ || !*self.pending_) return;
  const std::function<void()>& pending = *self.pending_;
  self.pending_ = nullptr;
  pending();
}

void GuestWorld::endWorld() {
  while (!joints_.empty()) removeJoint(joints_.size() - 1);
  for (const auto& arm : arms_) arm->removeAllHolds();
  if (action_) world().removeAction(action_.get());
  if (ghost_) toggleGhost();
  if (!throng_.empty()) toggleThrong();
  for (const auto& arm : arms_) arm->forgetWorld();
  physics_.reset();
  for (const auto& body : bodies_) body->is_in_world = false;
}

void GuestWorld::beginNewWorld() {
  btVector3 gravity(0, 0, static_cast<btScalar>(-kGravity));
  btContactSolverInfo info;
  if (hasWorld()) {
    gravity = world().getGravity();
    info = world().getSolverInfo();
    while (!joints_.empty()) removeJoint(joints_.size() - 1);
    if (has_floor_) world().removeRigidBody(floor_.get());
    for (const auto& body : bodies_) remove(*body);
    for (const auto& arm : arms_) {
      arm->removeAllHolds();
      arm->remove();
    }
    endWorld();
  }
  physics_ = std::make_unique<Physics>(case_);
  world().getSolverInfo() = info;
  world().addRigidBody(floor_.get());
  has_floor_ = true;
  for (const auto& body : bodies_) add(*body);
  for (const auto& arm : arms_) addArm(*arm);
  world().setGravity(gravity);
}

}  // namespace tandem::demos::bench
