#include "crowd.h"

#include <cmath>

namespace tandem::bench {
namespace {

constexpr btScalar kHalfEdge = 0.02, kPitch = 0.2, kMass = 0.1;  // [m, m, kg]
constexpr btScalar kDepth = 10.0;                                ///< below the scene [m]
constexpr btScalar kGravity = 9.81;                              // [m/s^2]

}  // namespace

Crowd::Crowd(btDiscreteDynamicsWorld& world, int count)
    : world_(world),
      floor_shape_(btVector3(0, 0, 1), -kDepth),
      box_shape_(btVector3(kHalfEdge, kHalfEdge, kHalfEdge)) {
  if (count == 0) return;
  add(floor_shape_, 0, btVector3(0, 0, 0));
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    btRigidBody& box = add(box_shape_, kMass,
                           btVector3(kPitch * static_cast<btScalar>(i % side),
                                     kPitch * static_cast<btScalar>(i / side), kHalfEdge - kDepth));
    // The scene may be weightless; the crowd is not.
    box.setFlags(box.getFlags() | BT_DISABLE_WORLD_GRAVITY);
    box.setGravity(btVector3(0, 0, -kGravity));
    box.forceActivationState(DISABLE_DEACTIVATION);
  }
}

Crowd::~Crowd() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

btRigidBody& Crowd::add(btCollisionShape& shape, btScalar mass, const btVector3& p_W) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape.calculateLocalInertia(mass, inertia);
  bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
  bodies_.back()->setCenterOfMassTransform(btTransform(btQuaternion::getIdentity(), p_W));
  world_.addRigidBody(bodies_.back().get());
  return *bodies_.back();
}

}  // namespace tandem::bench
