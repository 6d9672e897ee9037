#include "bodies/sphere_body.h"

#include <optional>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/haptic_body.h"
#include "bodies/own_body.h"

namespace tandem {
namespace {

btRigidBody::btRigidBodyConstructionInfo makeInfo(btSphereShape& shape, double mass,
                                                  const Vec3& p_W) {
  btVector3 inertia;
  shape.calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, &shape,
                                                inertia);
  info.m_startWorldTransform.setIdentity();
  info.m_startWorldTransform.setOrigin(toBullet(p_W));
  return info;
}

}  // namespace

struct SphereBody::Impl {
  Impl(btDiscreteDynamicsWorld& host, double radius, double mass, const Vec3& p_W,
       SphereMeets meets, const CollisionFilter& filter)
      : world(host), shape(static_cast<btScalar>(radius)), own(makeInfo(shape, mass, p_W)) {
    btRigidBody& rigid = own.rigid();
    rigid.setFlags(rigid.getFlags() | BT_DISABLE_WORLD_GRAVITY);
    const bool meets_all = meets == SphereMeets::kAllBodies;
    if (meets_all) rigid.setFriction(0);
    world.addRigidBody(&rigid, filter.group,
                       meets_all ? filter.mask : filter.mask & ~btBroadphaseProxy::StaticFilter);
    haptic.emplace(world, rigid);
  }
  ~Impl() {
    const bool present = own.isAlive() && haptic->isInWorld();
    if (!own.isAlive()) haptic->noteDeletion();
    haptic.reset();
    if (present) world.removeRigidBody(&own.rigid());
  }

  btDiscreteDynamicsWorld& world;
  btSphereShape shape;
  OwnBody own;
  std::optional<HapticBody> haptic;
};

SphereBody::SphereBody(btDiscreteDynamicsWorld& world, double radius, double mass, const Vec3& p_W,
                       SphereMeets meets, const CollisionFilter& filter)
    : impl_(std::make_unique<Impl>(world, radius, mass, p_W, meets, filter)) {}
SphereBody::~SphereBody() = default;

btRigidBody& SphereBody::rigid() const noexcept { return impl_->own.rigid(); }
bool SphereBody::isAlive() const noexcept { return impl_->own.isAlive(); }
HapticBody& SphereBody::haptic() const noexcept { return *impl_->haptic; }

}  // namespace tandem
