#include "world/own_world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/bad_value.h"
#include "shapes/bullet_shape.h"

namespace tandem {
namespace {

constexpr double kUnit = 1e-6;  ///< tolerance of a quaternion's length

template <typename Value>
void require(bool good, const char* name, const Value& value, const char* allowed) {
  if (!good) throwBadValue(name, value, allowed);
}

struct Body {
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btRigidBody> rigid;
};

btRigidBody::btRigidBodyConstructionInfo makeInfo(const OwnBodySettings& settings,
                                                  btCollisionShape& shape) {
  const auto mass = static_cast<btScalar>(settings.mass);
  btVector3 inertia = toBullet(settings.inertia);
  if (mass > 0 && settings.inertia == Vec3::Zero()) shape.calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
  info.m_startWorldTransform = toBullet(settings.start.p_W, settings.start.q_WB.normalized());
  info.m_friction = static_cast<btScalar>(settings.friction);
  info.m_restitution = static_cast<btScalar>(settings.restitution);
  info.m_rollingFriction = static_cast<btScalar>(settings.rolling_friction);
  info.m_spinningFriction = static_cast<btScalar>(settings.spinning_friction);
  return info;
}

}  // namespace

void checkOwnBodySettings(const OwnBodySettings& s) {
  checkShape(s.shape);
  if (std::holds_alternative<Mesh>(s.shape))
    throw std::invalid_argument("a mesh cannot be a body of this world; use hulls");
  require(s.mass >= 0.0 && std::isfinite(s.mass), "mass", s.mass, "finite, 0 or more [kg]");
  const bool is_static = s.mass == 0.0;
  require(is_static || static_cast<btScalar>(s.mass) >= std::numeric_limits<btScalar>::min(),
          "mass", s.mass, "0, or large enough for Bullet's scalars");
  if (!is_static && std::holds_alternative<Plane>(s.shape))
    require(false, "mass of a plane", s.mass, "0: planes are static");
  const auto inertia = s.inertia.transpose();
  require(s.inertia.allFinite() && (s.inertia == Vec3::Zero() || s.inertia.minCoeff() > 0.0),
          "inertia", inertia, "three moments above 0, or all 0 for those of the shape [kg m^2]");
  require(s.friction >= 0.0 && std::isfinite(s.friction), "friction", s.friction,
          "finite, 0 or more");
  require(s.restitution >= 0.0 && s.restitution <= 1.0, "restitution", s.restitution, "0 to 1");
  require(s.rolling_friction >= 0.0 && std::isfinite(s.rolling_friction), "rolling friction",
          s.rolling_friction, "finite, 0 or more [m]");
  require(s.spinning_friction >= 0.0 && std::isfinite(s.spinning_friction), "spinning friction",
          s.spinning_friction, "finite, 0 or more [m]");
  require(isFinite(s.start), "start position", s.start.p_W.transpose(),
          "finite, and so must be orientation and velocities");
  require(std::abs(s.start.q_WB.norm() - 1.0) <= kUnit, "length of the start orientation",
          s.start.q_WB.norm(), "1");
  require(!is_static || (s.start.v_W == Vec3::Zero() && s.start.w_W == Vec3::Zero()),
          "start velocity of a static body", s.start.v_W.transpose(), "0, or give it a mass");
}

struct OwnWorld::Impl {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<Body> bodies;

  Impl() { world.setGravity(btVector3(0, 0, 0)); }
  ~Impl() {
    for (const Body& body : bodies) world.removeRigidBody(body.rigid.get());
  }
};

OwnWorld::OwnWorld() : impl_(std::make_unique<Impl>()) {}
OwnWorld::~OwnWorld() = default;

btDiscreteDynamicsWorld& OwnWorld::world() const noexcept { return impl_->world; }

btRigidBody& OwnWorld::add(const OwnBodySettings& settings) {
  checkOwnBodySettings(settings);
  impl_->bodies.reserve(impl_->bodies.size() + 1);
  Body body;
  body.shape = makeBulletShape(settings.shape);
  body.rigid = std::make_unique<btRigidBody>(makeInfo(settings, *body.shape));
  body.rigid->setLinearVelocity(toBullet(settings.start.v_W));
  body.rigid->setAngularVelocity(toBullet(settings.start.w_W));
  impl_->world.addRigidBody(body.rigid.get());
  impl_->bodies.push_back(std::move(body));
  return *impl_->bodies.back().rigid;
}

void OwnWorld::change(btRigidBody& body, const OwnBodySettings& settings) {
  checkOwnBodySettings(settings);
  const bool is_static = body.getInvMass() == 0;
  require((settings.mass == 0.0) == is_static, "mass", settings.mass,
          is_static ? "0: the body is static" : "above 0: the body moves");
  const auto info = makeInfo(settings, *body.getCollisionShape());
  // Added anew it is another body to a Site, which so notices a new surface even while it rests.
  impl_->world.removeRigidBody(&body);
  if (!is_static) {
    body.setMassProps(info.m_mass, info.m_localInertia);
    body.updateInertiaTensor();
  }
  body.setFriction(info.m_friction);
  body.setRestitution(info.m_restitution);
  body.setRollingFriction(info.m_rollingFriction);
  body.setSpinningFriction(info.m_spinningFriction);
  impl_->world.addRigidBody(&body);
  body.activate(true);
}

void OwnWorld::remove(btRigidBody& body) noexcept {
  const auto place = std::find_if(impl_->bodies.begin(), impl_->bodies.end(),
                                  [&](const Body& own) { return own.rigid.get() == &body; });
  if (place == impl_->bodies.end()) return;
  impl_->world.removeRigidBody(&body);
  impl_->bodies.erase(place);
}

}  // namespace tandem
