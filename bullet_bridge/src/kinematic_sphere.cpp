#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/bullet_bridge/native_coupling.h"

#include "world_lookup.h"

namespace tandem {

struct KinematicSphere::Impl {
  Impl(btDiscreteDynamicsWorld& host, double radius, const Vec3& p_W)
      : world(host), shape(static_cast<btScalar>(radius)), rigid(0, nullptr, &shape) {
    rigid.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    rigid.setFriction(0);
    rigid.setWorldTransform(toBullet(p_W, Quat::Identity()));
    rigid.setInterpolationWorldTransform(rigid.getWorldTransform());
    rigid.forceActivationState(DISABLE_DEACTIVATION);
    constexpr int kAtRest = btBroadphaseProxy::StaticFilter | btBroadphaseProxy::KinematicFilter;
    world.addRigidBody(&rigid, btBroadphaseProxy::KinematicFilter,
                       btBroadphaseProxy::AllFilter ^ kAtRest);
    end = rigid.getWorldTransform();
  }
  ~Impl() {
    if (findInWorld(world, &rigid) >= 0) world.removeRigidBody(&rigid);
  }

  btDiscreteDynamicsWorld& world;
  btSphereShape shape;
  btRigidBody rigid;
  btTransform end;  // of moveTo()
};

KinematicSphere::KinematicSphere(btDiscreteDynamicsWorld& world, double radius, const Vec3& p_W)
    : impl_(std::make_unique<Impl>(world, radius, p_W)) {}
KinematicSphere::~KinematicSphere() = default;

btRigidBody& KinematicSphere::rigid() const noexcept { return impl_->rigid; }

bool KinematicSphere::isInWorld() const noexcept {
  return findInWorld(impl_->world, &impl_->rigid) >= 0;
}

RigidState KinematicSphere::state() const noexcept {
  const btRigidBody& rigid = impl_->rigid;
  return {fromBullet(rigid.getCenterOfMassPosition()), fromBullet(rigid.getOrientation()),
          fromBullet(rigid.getLinearVelocity()), fromBullet(rigid.getAngularVelocity())};
}

void KinematicSphere::moveTo(const Vec3& end_W, double dt) noexcept {
  impl_->end.setOrigin(toBullet(end_W));
  const btVector3 way = impl_->end.getOrigin() - impl_->rigid.getWorldTransform().getOrigin();
  impl_->rigid.setLinearVelocity(way / static_cast<btScalar>(dt));
}

void KinematicSphere::arrive() noexcept {
  impl_->rigid.setWorldTransform(impl_->end);
  impl_->rigid.setInterpolationWorldTransform(impl_->end);
}

void KinematicSphere::hold(const PointState& state) noexcept {
  impl_->end.setOrigin(toBullet(state.p_W));
  arrive();
  impl_->rigid.setLinearVelocity(toBullet(state.v_W));
}

}  // namespace tandem
