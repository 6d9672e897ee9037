#include "host/example_host.h"

#include "host/body_bits.h"

namespace tandem::test {

ExampleHost::~ExampleHost() {
  if (!world_) return;
  for (const auto& body : soft_bodies_) softWorld().removeSoftBody(body.get());
  for (const auto& constraint : multi_constraints_)
    multiWorld().removeMultiBodyConstraint(constraint.get());
  for (const auto& body : multi_bodies_) multiWorld().removeMultiBody(body.get());
  for (int i = world_->getNumConstraints(); i-- > 0;)
    world_->removeConstraint(world_->getConstraint(i));
  for (int i = world_->getNumCollisionObjects(); i-- > 0;)
    world_->removeCollisionObject(world_->getCollisionObjectArray()[i]);
  world_.reset();
}

void ExampleHost::makeWorld(WorldKind kind, const btVector3& gravity, double sweep, Solver solver) {
  const bool is_soft = kind == WorldKind::kSoftRigid;
  const bool is_multi = kind == WorldKind::kMultiBody;
  configuration_ = is_soft ? std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>()
                           : std::make_unique<btDefaultCollisionConfiguration>();
  dispatcher_ = std::make_unique<btCollisionDispatcher>(configuration_.get());
  if (sweep > 0.0) {
    broadphase_ =
        std::make_unique<btAxisSweep3>(at(-sweep, -sweep, -sweep), at(sweep, sweep, sweep));
  } else {
    broadphase_ = std::make_unique<btDbvtBroadphase>();
  }
  solver_ = std::move(solver);
  if (is_multi) {
    auto own = std::make_unique<btMultiBodyConstraintSolver>();
    world_ = std::make_unique<btMultiBodyDynamicsWorld>(dispatcher_.get(), broadphase_.get(),
                                                        own.get(), configuration_.get());
    solver_ = std::move(own);
  } else {
    if (!solver_) solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    if (is_soft) {
      world_ = std::make_unique<btSoftRigidDynamicsWorld>(dispatcher_.get(), broadphase_.get(),
                                                          solver_.get(), configuration_.get());
    } else {
      world_ = std::make_unique<btDiscreteDynamicsWorld>(dispatcher_.get(), broadphase_.get(),
                                                         solver_.get(), configuration_.get());
    }
  }
  world_->setGravity(gravity);
  if (!is_soft) return;
  softInfo().m_dispatcher = dispatcher_.get();
  softInfo().m_broadphase = broadphase_.get();
  softInfo().m_gravity = gravity;
}

btRigidBody& ExampleHost::addBody(double mass, const btTransform& start, btCollisionShape& shape,
                                  int group, int mask) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape.calculateLocalInertia(num(mass), inertia);
  motions_.push_back(std::make_unique<btDefaultMotionState>(start));
  bodies_.push_back(std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(num(mass), motions_.back().get(), &shape, inertia)));
  btRigidBody& body = *bodies_.back();
  if (mask == 0) {
    world_->addRigidBody(&body);
  } else {
    world_->addRigidBody(&body, group, mask);
  }
  return body;
}

btMultiBody& ExampleHost::addMultiBody(int links, double mass, const btVector3& inertia,
                                       bool is_fixed) {
  multi_bodies_.push_back(
      std::make_unique<btMultiBody>(links, num(mass), inertia, is_fixed, false));
  return *multi_bodies_.back();
}

void ExampleHost::finish(btMultiBody& body) {
  body.finalizeMultiDof();
  multiWorld().addMultiBody(&body);
}

btMultiBodyLinkCollider& ExampleHost::addCollider(btMultiBody& body, int link,
                                                  btCollisionShape& shape, int group, int mask) {
  colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(&body, link));
  btMultiBodyLinkCollider& collider = *colliders_.back();
  collider.setCollisionShape(&shape);
  if (link < 0) {
    collider.setWorldTransform(body.getBaseWorldTransform());
    body.setBaseCollider(&collider);
  } else {
    body.getLink(link).m_collider = &collider;
  }
  world_->addCollisionObject(&collider, group, mask);
  return collider;
}

void ExampleHost::placeColliders(btMultiBody& body) {
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> places;
  body.forwardKinematics(turns, places);
  body.updateCollisionObjectWorldTransforms(turns, places);
}

void ExampleHost::add(std::unique_ptr<btMultiBodyConstraint> constraint) {
  multi_constraints_.push_back(std::move(constraint));
  multiWorld().addMultiBodyConstraint(multi_constraints_.back().get());
}

btSoftBody& ExampleHost::addSoft(btSoftBody* body) {
  soft_bodies_.emplace_back(body);
  softWorld().addSoftBody(body);
  return *body;
}

void ExampleHost::step() {
  if (before) before(steps_);
  ++steps_;
  world_->stepSimulation(num(dt), most_sub_steps, num(fixed_step));
}

std::uint64_t ExampleHost::hash() const {
  BitHash hash;
  const btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    if (const btRigidBody* body = btRigidBody::upcast(objects[i])) {
      hash.add(*body);
    } else {
      hash.add(objects[i]->getWorldTransform());
    }
  }
  for (const auto& body : multi_bodies_) {
    hash.add(body->getBasePos());
    for (int axis = 0; axis < 4; ++axis) hash.add(body->getWorldToBaseRot()[axis]);
    hash.add(body->getBaseVel());
    hash.add(body->getBaseOmega());
    for (int link = 0; link < body->getNumLinks(); ++link) {
      for (int i = 0; i < body->getLink(link).m_posVarCount; ++i)
        hash.add(body->getJointPosMultiDof(link)[i]);
      for (int i = 0; i < body->getLink(link).m_dofCount; ++i)
        hash.add(body->getJointVelMultiDof(link)[i]);
    }
  }
  for (const auto& body : soft_bodies_) {
    for (int node = 0; node < body->m_nodes.size(); ++node) {
      hash.add(body->m_nodes[node].m_x);
      hash.add(body->m_nodes[node].m_v);
    }
  }
  return hash.value();
}

double ExampleHost::energy() const {
  double energy = 0.0;
  const auto add = [&](btScalar mass, const btVector3& p_W, const btVector3& v_W) {
    energy += double(mass) * (0.5 * double(v_W.length2()) - double(world_->getGravity().dot(p_W)));
  };
  // Both in the frame of the inertia's principal axes.
  const auto addTurning = [&](const btVector3& inertia, const btVector3& omega) {
    energy += 0.5 * double((inertia * omega).dot(omega));
  };
  for (const auto& body : bodies_) {
    if (body->getInvMass() <= 0) continue;
    add(1 / body->getInvMass(), body->getCenterOfMassPosition(), body->getLinearVelocity());
    const btVector3& inverse = body->getInvInertiaDiagLocal();
    btVector3 inertia(0, 0, 0);
    for (int axis = 0; axis < 3; ++axis)
      if (inverse[axis] > 0) inertia[axis] = 1 / inverse[axis];
    addTurning(inertia, body->getAngularVelocity() * body->getCenterOfMassTransform().getBasis());
  }
  for (const auto& body : multi_bodies_) {
    if (!body->hasFixedBase()) {
      add(body->getBaseMass(), body->getBasePos(), body->getBaseVel());
      addTurning(body->getBaseInertia(),
                 quatRotate(body->getWorldToBaseRot(), body->getBaseOmega()));
    }
    for (int i = 0; i < body->getNumLinks(); ++i) {
      const btMultibodyLink& link = body->getLink(i);
      add(link.m_mass, link.m_cachedWorldTransform.getOrigin(),
          link.m_absFrameTotVelocity.m_bottomVec);
      addTurning(link.m_inertiaLocal, link.m_absFrameTotVelocity.m_topVec);
    }
  }
  for (const auto& body : soft_bodies_) {
    for (int i = 0; i < body->m_nodes.size(); ++i) {
      const btSoftBody::Node& node = body->m_nodes[i];
      if (node.m_im > 0) add(1 / node.m_im, node.m_x, node.m_v);
    }
  }
  return energy;
}

}  // namespace tandem::test
