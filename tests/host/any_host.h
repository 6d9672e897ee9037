#pragma once

#include <memory>
#include <ostream>
#include <vector>

#include <btBulletDynamicsCommon.h>
// These need the common header first.
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::test {

/// The kinds of world that Bullet has.
enum class WorldKind { kDiscrete, kMultiBody, kSoftRigid, kSoftMultiBody, kParallel };

inline constexpr WorldKind kAllKinds[] = {WorldKind::kDiscrete, WorldKind::kMultiBody,
                                          WorldKind::kSoftRigid, WorldKind::kSoftMultiBody,
                                          WorldKind::kParallel};

[[nodiscard]] inline const char* nameOf(WorldKind kind) {
  switch (kind) {
    case WorldKind::kDiscrete:
      return "Discrete";
    case WorldKind::kMultiBody:
      return "MultiBody";
    case WorldKind::kSoftRigid:
      return "SoftRigid";
    case WorldKind::kSoftMultiBody:
      return "SoftMultiBody";
    case WorldKind::kParallel:
      break;
  }
  return "Parallel";
}

/// A host with a world of any kind. `world.reset()` may destroy the world before all other members.
struct AnyHost {
  WorldKind kind;
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btConstraintSolverPoolMt solver_pool{1};
  btSequentialImpulseConstraintSolver solver;
  btMultiBodyConstraintSolver multi_solver;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  std::unique_ptr<btMultiBody> multi_body;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders;
  std::unique_ptr<btSoftBody> soft_body;
  std::unique_ptr<btDiscreteDynamicsWorld> world;

  explicit AnyHost(WorldKind of, const Vec3& gravity = Vec3::Zero()) : kind(of), world(make()) {
    world->setGravity(toBullet(gravity));
  }
  ~AnyHost() {
    if (!world) return;
    if (soft_body) soft()->removeSoftBody(soft_body.get());
    if (multi_body) multi()->removeMultiBody(multi_body.get());
    for (const auto& joint : joints) world->removeConstraint(joint.get());
    for (int i = world->getNumCollisionObjects(); i-- > 0;)
      world->removeCollisionObject(world->getCollisionObjectArray()[i]);
    world.reset();
  }
  AnyHost(const AnyHost&) = delete;
  AnyHost& operator=(const AnyHost&) = delete;

  [[nodiscard]] btMultiBodyDynamicsWorld* multi() const {
    return dynamic_cast<btMultiBodyDynamicsWorld*>(world.get());
  }
  /// Any world with soft bodies.
  struct Soft {
    btSoftRigidDynamicsWorld* rigid;
    btSoftMultiBodyDynamicsWorld* multi;
    Soft* operator->() { return this; }
    [[nodiscard]] bool isThere() const { return rigid != nullptr || multi != nullptr; }
    [[nodiscard]] btSoftBodyWorldInfo& info() {
      return rigid ? rigid->getWorldInfo() : multi->getWorldInfo();
    }
    void addSoftBody(btSoftBody* body) {
      if (rigid) {
        rigid->addSoftBody(body);
      } else {
        multi->addSoftBody(body);
      }
    }
    void removeSoftBody(btSoftBody* body) {
      if (rigid) {
        rigid->removeSoftBody(body);
      } else {
        multi->removeSoftBody(body);
      }
    }
  };
  [[nodiscard]] Soft soft() const {
    return {dynamic_cast<btSoftRigidDynamicsWorld*>(world.get()),
            dynamic_cast<btSoftMultiBodyDynamicsWorld*>(world.get())};
  }

  template <typename ShapeType, typename... Arguments>
  ShapeType& makeShape(Arguments&&... arguments) {
    auto shape = std::make_unique<ShapeType>(std::forward<Arguments>(arguments)...);
    ShapeType& reference = *shape;
    shapes.push_back(std::move(shape));
    return reference;
  }
  btBoxShape& makeBox(const Vec3& half) { return makeShape<btBoxShape>(toBullet(half)); }

  /// Adds a body; mass 0 makes it static.
  btRigidBody& addBody(btCollisionShape& shape, double mass, const Vec3& p_W = Vec3::Zero(),
                       const Quat& q_WB = Quat::Identity()) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0.0) shape.calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, &shape,
                                                  inertia);
    info.m_startWorldTransform = toBullet(p_W, q_WB);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world->addRigidBody(bodies.back().get());
    return *bodies.back();
  }
  btRigidBody& addCube(double mass, const Vec3& p_W = Vec3::Zero()) {
    return addBody(makeBox(Vec3::Constant(0.02)), mass, p_W);
  }

  /// Adds a pendulum of two links on a fixed base at `p_W`, in worlds that support it.
  void addMultiBody(const Vec3& p_W) {
    constexpr int kLinks = 2;
    btBoxShape& shape = makeBox(Vec3::Constant(0.02));
    btVector3 inertia;
    shape.calculateLocalInertia(btScalar(0.1), inertia);
    multi_body = std::make_unique<btMultiBody>(kLinks, btScalar(0), btVector3(0, 0, 0), true, true);
    multi_body->setBasePos(toBullet(p_W));
    for (int link = 0; link < kLinks; ++link) {
      multi_body->setupRevolute(link, btScalar(0.1), inertia, link - 1, btQuaternion::getIdentity(),
                                btVector3(1, 0, 0), btVector3(0, 0, btScalar(link ? -0.03 : 0)),
                                btVector3(0, 0, btScalar(-0.03)), true);
    }
    multi_body->finalizeMultiDof();
    multi_body->setJointPos(0, btScalar(0.5));
    multi()->addMultiBody(multi_body.get());
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> places;
    multi_body->forwardKinematics(turns, places);
    for (int link = 0; link < kLinks; ++link) {
      colliders.push_back(std::make_unique<btMultiBodyLinkCollider>(multi_body.get(), link));
      colliders.back()->setCollisionShape(&shape);
      world->addCollisionObject(colliders.back().get(), btBroadphaseProxy::DefaultFilter,
                                btBroadphaseProxy::AllFilter);
      multi_body->getLink(link).m_collider = colliders.back().get();
    }
    multi_body->updateCollisionObjectWorldTransforms(turns, places);
  }

  /// Adds a cloth above `p_W`, held at its corners, in worlds that support it.
  void addSoftBody(const Vec3& p_W) {
    btSoftBodyWorldInfo& info = soft()->info();
    info.m_broadphase = &broadphase;
    info.m_dispatcher = &dispatcher;
    info.m_gravity = world->getGravity();
    info.m_sparsesdf.setDefaultVoxelsz(btScalar(0.005));  // [m]; the default is 0.25
    const auto corner = [&](double x, double y) { return toBullet(Vec3(p_W + Vec3(x, y, 0.0))); };
    constexpr double kHalf = 0.08;
    soft_body.reset(btSoftBodyHelpers::CreatePatch(info, corner(-kHalf, -kHalf),
                                                   corner(kHalf, -kHalf), corner(-kHalf, kHalf),
                                                   corner(kHalf, kHalf), 6, 6, 15, true));
    soft_body->setTotalMass(btScalar(0.1));
    soft_body->getCollisionShape()->setMargin(btScalar(0.005));  // the default is 0.25 m
    soft()->addSoftBody(soft_body.get());
  }

  void step(double dt) { world->stepSimulation(static_cast<btScalar>(dt), 0); }

 private:
  std::unique_ptr<btDiscreteDynamicsWorld> make() {
    switch (kind) {
      case WorldKind::kMultiBody:
        return std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher, &broadphase, &multi_solver,
                                                          &configuration);
      case WorldKind::kSoftRigid:
        return std::make_unique<btSoftRigidDynamicsWorld>(&dispatcher, &broadphase, &solver,
                                                          &configuration);
      case WorldKind::kSoftMultiBody:
        return std::make_unique<btSoftMultiBodyDynamicsWorld>(&dispatcher, &broadphase,
                                                              &multi_solver, &configuration);
      case WorldKind::kParallel:
        return std::make_unique<btDiscreteDynamicsWorldMt>(&dispatcher, &broadphase, &solver_pool,
                                                           nullptr, &configuration);
      case WorldKind::kDiscrete:
        break;
    }
    return std::make_unique<btDiscreteDynamicsWorld>(&dispatcher, &broadphase, &solver,
                                                     &configuration);
  }
};

}  // namespace tandem::test
