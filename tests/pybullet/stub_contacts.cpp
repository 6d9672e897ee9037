#include "stub_contacts.h"

#include <btBulletDynamicsCommon.h>

namespace tandem::test {
namespace {

using Pairs = std::set<std::pair<int, int>>;

btVector3 toBullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 toVec3(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// Leaves out pairs that a filter has, by the bodies' numbers.
class FilteringDispatcher : public btCollisionDispatcher {
 public:
  explicit FilteringDispatcher(btCollisionConfiguration* configuration)
      : btCollisionDispatcher(configuration) {}
  void filter(const Pairs& without_contact) { without_contact_ = &without_contact; }
  bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override {
    return mayTouch(*a, *b) && btCollisionDispatcher::needsCollision(a, b);
  }
  // A manifold outlives its pair's last collision.
  bool needsResponse(const btCollisionObject* a, const btCollisionObject* b) override {
    return mayTouch(*a, *b) && btCollisionDispatcher::needsResponse(a, b);
  }

 private:
  [[nodiscard]] bool mayTouch(const btCollisionObject& a, const btCollisionObject& b) const {
    return without_contact_->count(std::minmax({a.getUserIndex(), b.getUserIndex()})) == 0;
  }
  const Pairs* without_contact_ = nullptr;
};

/// A shape with its pieces.
struct Shape {
  std::vector<std::unique_ptr<btCollisionShape>> pieces;
  btCompoundShape all;

  explicit Shape(const StubBody& body) {
    for (const b3::CollisionShapeData& piece : body.shape) {
      const double* const at = piece.frame;
      pieces.push_back(make(piece));
      all.addChildShape(
          btTransform(btQuaternion(at[3], at[4], at[5], at[6]), btVector3(at[0], at[1], at[2])),
          pieces.back().get());
    }
  }
  /// PyBullet makes no compound of one centred piece.
  [[nodiscard]] btCollisionShape* get() {
    const bool is_plain = pieces.size() == 1 && all.getChildTransform(0).getOrigin().isZero();
    return is_plain ? pieces.front().get() : &all;
  }

 private:
  static std::unique_ptr<btCollisionShape> make(const b3::CollisionShapeData& piece) {
    const double* const d = piece.dimensions;
    const btVector3 size(d[0], d[1], d[2]);
    switch (piece.geometry) {
      case b3::kBox:
        return std::make_unique<btBoxShape>(0.5 * size);
      case b3::kSphere:
        return std::make_unique<btSphereShape>(d[0]);
      case b3::kCapsule:
        return std::make_unique<btCapsuleShapeZ>(d[1], d[0]);
      case b3::kCylinder:
        return std::make_unique<btCylinderShapeZ>(btVector3(d[1], d[1], 0.5 * d[0]));
      default:
        return std::make_unique<btStaticPlaneShape>(size, 0.0);
    }
  }
};

/// A body of Bullet's with the number, state and surface of a stub body.
class Copy {
 public:
  explicit Copy(const StubBody& of)
      : serial_(of.serial), is_static_(of.mass == 0.0), shape_(of), body_(settings(of)) {
    body_.setActivationState(DISABLE_DEACTIVATION);
    // The stub has accelerated multibodies already; a btRigidBody turns in Bullet's own way.
    body_.setFlags(of.is_multibody ? 0 : BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY);
  }
  [[nodiscard]] bool isOf(const StubBody& body) const {
    return serial_ == body.serial && is_static_ == (body.mass == 0.0);
  }
  [[nodiscard]] btRigidBody* get() { return &body_; }

  void follow(int number, const StubBody& of) {
    const RigidState& state = of.state;
    const auto& q = state.q_WB;
    body_.setUserIndex(number);
    body_.setWorldTransform(
        btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), toBullet(state.p_W)));
    body_.setLinearVelocity(toBullet(state.v_W));
    body_.setAngularVelocity(toBullet(state.w_W));
    body_.setMassProps(of.mass, toBullet(of.inertia));
    body_.updateInertiaTensor();
    body_.setFriction(of.friction);
    body_.setRestitution(of.restitution);
    body_.setRollingFriction(of.rolling_friction);
    body_.setSpinningFriction(of.spinning_friction);
  }
  void tell(StubBody& body) const {
    if (is_static_) return;
    const btTransform& pose = body_.getWorldTransform();
    const btQuaternion q = pose.getRotation();
    body.state.p_W = toVec3(pose.getOrigin());
    body.state.q_WB = Quat(q.w(), q.x(), q.y(), q.z());
    body.state.v_W = toVec3(body_.getLinearVelocity());
    body.state.w_W = toVec3(body_.getAngularVelocity());
  }

 private:
  btRigidBody::btRigidBodyConstructionInfo settings(const StubBody& of) {
    return {of.mass, nullptr, shape_.get(), toBullet(of.inertia)};
  }
  int serial_;
  bool is_static_;
  Shape shape_;
  btRigidBody body_;
};

}  // namespace

struct StubContacts::World {
  btDefaultCollisionConfiguration configuration;
  FilteringDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::map<int, std::unique_ptr<Copy>> copies;

  void remove(std::map<int, std::unique_ptr<Copy>>::iterator copy) {
    world.removeRigidBody(copy->second->get());
    copies.erase(copy);
  }
};

StubContacts::StubContacts() : world_(std::make_unique<World>()) {
  // As PyBullet's server; its contacts of multibodies know no split impulse.
  btContactSolverInfo& info = world_->world.getSolverInfo();
  info.m_splitImpulse = 0;
  info.m_erp2 = 0.08;
  info.m_linearSlop = 1e-5;
  info.m_numIterations = 50;
  world_->world.setGravity(btVector3(0, 0, 0));
}

StubContacts::~StubContacts() {
  while (!world_->copies.empty()) world_->remove(world_->copies.begin());
}

void StubContacts::move(std::map<int, StubBody>& bodies, const Pairs& without_contact, double dt) {
  auto& copies = world_->copies;
  for (auto copy = copies.begin(); copy != copies.end();) {
    const auto next = std::next(copy);
    const auto body = bodies.find(copy->first);
    if (body == bodies.end() || !copy->second->isOf(body->second)) world_->remove(copy);
    copy = next;
  }
  for (auto& [number, body] : bodies) {
    std::unique_ptr<Copy>& copy = copies[number];
    const bool is_new = !copy;
    if (is_new) copy = std::make_unique<Copy>(body);
    copy->follow(number, body);
    if (is_new) world_->world.addRigidBody(copy->get());
  }
  world_->dispatcher.filter(without_contact);
  world_->world.stepSimulation(dt, 0);
  for (auto& [number, body] : bodies) copies.at(number)->tell(body);
}

Vec3 computeStubInertia(const StubBody& body) {
  Shape shape(body);
  btVector3 inertia(0, 0, 0);
  if (body.mass > 0.0) shape.get()->calculateLocalInertia(body.mass, inertia);
  return toVec3(inertia);
}

}  // namespace tandem::test
