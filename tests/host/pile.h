#pragma once

#include <cstdint>
#include <vector>

#include "host/any_host.h"
#include "host/body_bits.h"

namespace tandem::test {

/// A host's scene with all kinds of Bullet bodies. 21 boxes, balls and hulls fall on a heap with
/// friction, a joint and a kinematic sweeper. Worlds that support them add a multi-body that swings
/// into the heap and a cloth.
class Pile {
 public:
  explicit Pile(WorldKind kind) : host_(kind, Vec3(0.0, 0.0, -9.81)) {
    btCollisionShape& ground = host_.makeBox(Vec3(10.0, 10.0, 0.1));
    host_.addBody(ground, 0.0, Vec3(0.0, 0.0, -0.1)).setFriction(btScalar(0.8));
    btCollisionShape* shapes[] = {&host_.makeBox(Vec3(0.02, 0.02, 0.02)),
                                  &host_.makeShape<btSphereShape>(btScalar(0.02)), &makeHull()};
    for (int i = 0; i < kBodies; ++i) {
      const double turn = 0.7 * i;
      const Vec3 p_W(0.03 * (i % 3) - 0.03, 0.031 * (i / 3 % 2), 0.03 + 0.025 * i);
      btRigidBody& body = host_.addBody(*shapes[i % 3], 0.05 + 0.01 * i, p_W,
                                        Quat(Eigen::AngleAxisd(turn, Vec3(1, 2, 3).normalized())));
      body.setFriction(btScalar(0.6));
      body.setRestitution(btScalar(0.1));
      body.setRollingFriction(btScalar(0.001));
    }
    join(body(3), body(6));
    sweeper_ = &host_.addBody(*shapes[0], 0.0, Vec3(-0.2, 0.0, 0.02));
    sweeper_->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    sweeper_->setActivationState(DISABLE_DEACTIVATION);
    if (host_.multi()) host_.addMultiBody(Vec3(0.12, 0.0, 0.2));
    if (host_.soft()->isThere()) host_.addSoftBody(Vec3(0.0, 0.0, 0.06));
  }

  [[nodiscard]] AnyHost& host() { return host_; }
  [[nodiscard]] btDiscreteDynamicsWorld& world() { return *host_.world; }
  /// Body `i` of the heap; the host's first body is the ground.
  [[nodiscard]] btRigidBody& body(int i) { return *host_.bodies[static_cast<std::size_t>(i) + 1]; }

  /// Steps 1/60 s in `sub_steps` sub-steps.
  void step(int sub_steps = 4) {
    ++steps_;
    sweeper_->setWorldTransform(
        toBullet(Vec3(-0.2 + 0.001 * (steps_ % 200), 0.0, 0.02), Quat::Identity()));
    const btScalar whole = btScalar(1) / 60;
    host_.world->stepSimulation(whole, sub_steps, whole / static_cast<btScalar>(sub_steps));
  }

  [[nodiscard]] std::uint64_t hash() {
    BitHash hash;
    for (int i = 0; i < kBodies; ++i) hash.add(body(i));
    if (host_.multi_body) {
      for (int link = 0; link < host_.multi_body->getNumLinks(); ++link) {
        hash.add(host_.multi_body->getJointPos(link));
        hash.add(host_.multi_body->getJointVel(link));
      }
    }
    if (host_.soft_body) {
      for (int node = 0; node < host_.soft_body->m_nodes.size(); ++node) {
        hash.add(host_.soft_body->m_nodes[node].m_x);
        hash.add(host_.soft_body->m_nodes[node].m_v);
      }
    }
    return hash.value();
  }

 private:
  static constexpr int kBodies = 21;

  btCollisionShape& makeHull() {
    auto& hull = host_.makeShape<btConvexHullShape>();
    for (int corner = 0; corner < 6; ++corner) {
      Vec3 p = Vec3::Zero();
      p[corner / 2] = corner % 2 ? 0.024 : -0.02;
      hull.addPoint(toBullet(p));
    }
    hull.setMargin(btScalar(0.001));
    return hull;
  }
  void join(btRigidBody& a, btRigidBody& b) {
    host_.joints.push_back(std::make_unique<btPoint2PointConstraint>(
        a, b, btVector3(0, 0, btScalar(0.03)), btVector3(0, 0, btScalar(-0.03))));
    host_.world->addConstraint(host_.joints.back().get());
  }

  AnyHost host_;
  btRigidBody* sweeper_ = nullptr;
  int steps_ = 0;
};

}  // namespace tandem::test
