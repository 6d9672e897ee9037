#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "host/any_host.h"

namespace tandem::test {

[[nodiscard]] inline btScalar num(double value) { return static_cast<btScalar>(value); }
[[nodiscard]] inline btVector3 at(double x, double y, double z) { return {num(x), num(y), num(z)}; }
[[nodiscard]] inline btTransform pose(const btVector3& p_W,
                                      const btQuaternion& q_WB = btQuaternion::getIdentity()) {
  return btTransform(q_WB, p_W);
}
/// A turn by `angle` [rad] about `axis`.
[[nodiscard]] inline btQuaternion turn(const btVector3& axis, double angle) {
  return {axis, num(angle)};
}
[[nodiscard]] inline btMatrix3x3 eulerZyx(double x, double y, double z) {
  btMatrix3x3 basis;
  basis.setEulerZYX(num(x), num(y), num(z));
  return basis;
}

/// A host that owns one of Bullet's example scenes.
class ExampleHost {
 public:
  using Solver = std::unique_ptr<btConstraintSolver>;

  ExampleHost() = default;
  ~ExampleHost();
  ExampleHost(const ExampleHost&) = delete;
  ExampleHost& operator=(const ExampleHost&) = delete;

  /// Makes the world. `sweep` [m] is the half size of a btAxisSweep3; 0 makes a btDbvtBroadphase.
  void makeWorld(WorldKind kind, const btVector3& gravity, double sweep = 0.0,
                 Solver solver = nullptr);

  [[nodiscard]] btDiscreteDynamicsWorld& world() { return *world_; }
  [[nodiscard]] btCollisionDispatcher& dispatcher() { return *dispatcher_; }
  [[nodiscard]] btMultiBodyDynamicsWorld& multiWorld() {
    return dynamic_cast<btMultiBodyDynamicsWorld&>(*world_);
  }
  [[nodiscard]] btSoftRigidDynamicsWorld& softWorld() {
    return dynamic_cast<btSoftRigidDynamicsWorld&>(*world_);
  }
  [[nodiscard]] btSoftBodyWorldInfo& softInfo() { return softWorld().getWorldInfo(); }

  /// Keeps a thing beyond the end of the world.
  template <typename Thing, typename... Arguments>
  Thing& keep(Arguments&&... arguments) {
    auto thing = std::make_shared<Thing>(std::forward<Arguments>(arguments)...);
    kept_.push_back(thing);
    return *thing;
  }
  btBoxShape& box(double x, double y, double z) { return keep<btBoxShape>(at(x, y, z)); }

  /// Adds a body as the examples do, with a motion state; mass 0 makes it static.
  btRigidBody& addBody(double mass, const btTransform& start, btCollisionShape& shape,
                       int group = 0, int mask = 0);
  /// The floor of most examples: its top is y = 0.
  btRigidBody& addGround() { return addBody(0.0, pose(at(0, -50, 0)), box(50, 50, 50)); }

  template <typename Joint, typename... Arguments>
  Joint& join(bool excludes_contact, Arguments&&... arguments) {
    auto joint = std::make_unique<Joint>(std::forward<Arguments>(arguments)...);
    Joint& reference = *joint;
    joints_.push_back(std::move(joint));
    world_->addConstraint(&reference, excludes_contact);
    return reference;
  }

  btMultiBody& addMultiBody(int links, double mass, const btVector3& inertia, bool is_fixed);
  /// Ends the set-up of links; the multi-body is in the world then.
  void finish(btMultiBody& body);
  btMultiBodyLinkCollider& addCollider(btMultiBody& body, int link, btCollisionShape& shape,
                                       int group, int mask);
  /// Puts all colliders where the joints are.
  static void placeColliders(btMultiBody& body);
  void add(std::unique_ptr<btMultiBodyConstraint> constraint);

  /// Takes over what btSoftBodyHelpers made.
  btSoftBody& addSoft(btSoftBody* body);

  /// Bodies that a site may be asked to share, in this order.
  void offer(btRigidBody& body) { offered_.push_back(&body); }
  [[nodiscard]] const std::vector<btRigidBody*>& offered() const { return offered_; }
  /// Place of a ball of 1 kg that a test adds if none of them can be shared.
  btVector3 guest_at = at(0, 3, 2);
  btRigidBody& addGuest() { return addBody(1.0, pose(guest_at), keep<btSphereShape>(num(0.25))); }

  /// What the example does ahead of each step; it gets the number of the step.
  std::function<void(int)> before;
  double dt = 1.0 / 60.0;          ///< [s]
  int most_sub_steps = 1;          ///< 0: one sub-step of dt
  double fixed_step = 1.0 / 60.0;  ///< [s]

  void step();

  /// Hash of pose and velocity of all bodies, links and nodes.
  [[nodiscard]] std::uint64_t hash() const;
  /// Kinetic energy and energy in the field of gravity [J], of all that moves.
  [[nodiscard]] double energy() const;

 private:
  std::vector<std::shared_ptr<void>> kept_;  // owned here alone; shared for its type erasure
  std::vector<std::unique_ptr<btDefaultMotionState>> motions_;
  std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  Solver solver_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<std::unique_ptr<btMultiBody>> multi_bodies_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> multi_constraints_;
  std::vector<std::unique_ptr<btSoftBody>> soft_bodies_;
  std::vector<btRigidBody*> offered_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  int steps_ = 0;
};

}  // namespace tandem::test
