#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/own_body.h"
#include "native/native_coupling.h"
#include "world/world_access.h"
#include "world/world_lookup.h"

namespace tandem {

struct KinematicSphere::Impl {
  Impl(btDiscreteDynamicsWorld& host, double radius, const Vec3& p_W)
      : world(host), shape(static_cast<btScalar>(radius)), own({0, nullptr, &shape}) {
    btRigidBody& rigid = own.rigid();
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
    if (isInWorld()) world.removeRigidBody(&own.rigid());
  }

  [[nodiscard]] bool isInWorld() const noexcept {
    return own.isAlive() && findInWorld(world, &own.rigid()) >= 0;
  }

  btDiscreteDynamicsWorld& world;
  btSphereShape shape;
  OwnBody own;
  btTransform end;  // target of moveTo()
};

KinematicSphere::KinematicSphere(btDiscreteDynamicsWorld& world, double radius, const Vec3& p_W)
    : impl_(std::make_unique<Impl>(world, radius, p_W)) {}
KinematicSphere::~KinematicSphere() = default;

btRigidBody& KinematicSphere::rigid() const noexcept { return impl_->own.rigid(); }

bool KinematicSphere::isInWorld() const noexcept { return impl_->isInWorld(); }

RigidState KinematicSphere::state() const noexcept { return readState(rigid()); }

void KinematicSphere::moveTo(const Vec3& end_W, double dt) noexcept {
  impl_->end.setOrigin(toBullet(end_W));
  const btVector3 way = impl_->end.getOrigin() - rigid().getWorldTransform().getOrigin();
  rigid().setLinearVelocity(way / static_cast<btScalar>(dt));
}

void KinematicSphere::arrive() noexcept {
  rigid().setWorldTransform(impl_->end);
  rigid().setInterpolationWorldTransform(impl_->end);
}

void KinematicSphere::hold(const PointState& state) noexcept {
  impl_->end.setOrigin(toBullet(state.p_W));
  arrive();
  rigid().setLinearVelocity(toBullet(state.v_W));
}

}  // namespace tandem
