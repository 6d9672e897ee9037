#include "native/native_coupling.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/rotation_vector.h"

namespace tandem {
namespace {

void checkGains(const char* name, const CouplerGains& gains) {
  const auto isGood = [](double gain) { return gain >= 0.0 && std::isfinite(gain); };
  if (isGood(gains.stiffness) && isGood(gains.damping)) return;
  std::ostringstream message;
  message << name << " gains K = " << gains.stiffness << ", B = " << gains.damping
          << ": must be finite numbers, 0 or more";
  throw std::invalid_argument(message.str());
}

CouplerGains scale(const CouplerGains& gains, double share) noexcept {
  return {share * gains.stiffness, share * gains.damping};
}

/// The target body of a constraint; kinematic, so that the solver uses its velocity.
class Anchor {
 public:
  Anchor() : rigid_(0, nullptr, nullptr) {
    rigid_.setCollisionFlags(rigid_.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  }
  [[nodiscard]] btRigidBody& rigid() noexcept { return rigid_; }

  void set(const RigidState& target) noexcept {
    rigid_.setWorldTransform(toBullet(target.p_W, target.q_WB));
    rigid_.setLinearVelocity(toBullet(target.v_W));
    rigid_.setAngularVelocity(toBullet(target.w_W));
  }

 private:
  btRigidBody rigid_;
};

/// Applies impulses F dt, computed from the state at the start of the step.
class ImpulseCoupler final : public NativeCoupler {
 public:
  ImpulseCoupler(btRigidBody& body, const CouplerSettings& settings)
      : body_(body), full_(settings), settings_(settings) {}

  void setShare(double share) noexcept override {
    settings_ = {scale(full_.linear, share), scale(full_.angular, share)};
  }

  void pull(const RigidState& target, double dt) noexcept override {
    const PointState point{fromBullet(body_.getCenterOfMassPosition()),
                           fromBullet(body_.getLinearVelocity())};
    const Vec3 f_W = computeCouplerForce(settings_.linear, target.point(), point);
    const Vec3 t_W =
        settings_.angular.stiffness *
            computeRotationVector(fromBullet(body_.getOrientation()), target.q_WB) +
        settings_.angular.damping * (target.w_W - fromBullet(body_.getAngularVelocity()));
    body_.applyCentralImpulse(toBullet(Vec3(f_W * dt)));
    body_.applyTorqueImpulse(toBullet(Vec3(t_W * dt)));
  }

 private:
  btRigidBody& body_;
  CouplerSettings full_, settings_;
};

class Spring6DofCoupler final : public NativeCoupler {
 public:
  Spring6DofCoupler(btDiscreteDynamicsWorld& world, btRigidBody& body,
                    const CouplerSettings& settings)
      : world_(world),
        full_(settings),
        spring_(anchor_.rigid(), body, btTransform::getIdentity(), btTransform::getIdentity()) {
    for (int axis = 0; axis < 6; ++axis) {
      const CouplerGains& gains = axis < 3 ? settings.linear : settings.angular;
      spring_.setLimit(axis, 1, -1);  // lower above upper: free
      if (gains.stiffness == 0.0 && gains.damping == 0.0) continue;
      spring_.enableSpring(axis, true);
      spring_.setEquilibriumPoint(axis, 0);
    }
    setShare(1.0);
    world_.addConstraint(&spring_);
  }
  ~Spring6DofCoupler() override { world_.removeConstraint(&spring_); }
  Spring6DofCoupler(const Spring6DofCoupler&) = delete;
  Spring6DofCoupler& operator=(const Spring6DofCoupler&) = delete;

  void setShare(double share) noexcept override {
    for (int axis = 0; axis < 6; ++axis) {
      const CouplerGains gains = scale(axis < 3 ? full_.linear : full_.angular, share);
      // Bullet's default silently lowers K where w dt > 0.25, and B where B dt > m.
      spring_.setStiffness(axis, static_cast<btScalar>(gains.stiffness), false);
      spring_.setDamping(axis, static_cast<btScalar>(gains.damping), false);
    }
  }

  void pull(const RigidState& target, double) noexcept override { anchor_.set(target); }

 private:
  btDiscreteDynamicsWorld& world_;
  CouplerSettings full_;
  Anchor anchor_;
  btGeneric6DofSpring2Constraint spring_;
};

class PointToPointCoupler final : public NativeCoupler {
 public:
  PointToPointCoupler(btDiscreteDynamicsWorld& world, btRigidBody& body,
                      const CouplerSettings& settings)
      : world_(world),
        body_(body),
        full_linear_(settings.linear),
        turn_(body, {{}, settings.angular}),
        joint_(body, anchor_.rigid(), btVector3(0, 0, 0), btVector3(0, 0, 0)) {
    setShare(1.0);
    world_.addConstraint(&joint_);
  }
  ~PointToPointCoupler() override { world_.removeConstraint(&joint_); }
  PointToPointCoupler(const PointToPointCoupler&) = delete;
  PointToPointCoupler& operator=(const PointToPointCoupler&) = delete;

  void setShare(double share) noexcept override {
    linear_ = scale(full_linear_, share);
    turn_.setShare(share);
    // Without gains the joint would be rigid, so it is disabled.
    joint_.setEnabled(linear_.stiffness > 0.0 || linear_.damping > 0.0);
  }

  void pull(const RigidState& target, double dt) noexcept override {
    anchor_.set(target);
    if (!joint_.isEnabled()) return turn_.pull(target, dt);
    const double K = linear_.stiffness, B = linear_.damping;
    const double m = 1.0 / static_cast<double>(body_.getInvMass());
    joint_.setParam(BT_CONSTRAINT_ERP, static_cast<btScalar>(dt * K / (dt * K + B)));
    joint_.setParam(BT_CONSTRAINT_CFM, static_cast<btScalar>(m / (dt * (dt * K + B))));
    turn_.pull(target, dt);
  }

 private:
  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  CouplerGains full_linear_, linear_;
  ImpulseCoupler turn_;
  Anchor anchor_;
  btPoint2PointConstraint joint_;
};

}  // namespace

std::unique_ptr<NativeCoupler> makeNativeCoupler(NativeCouplerKind kind,
                                                 btDiscreteDynamicsWorld& world, btRigidBody& body,
                                                 const CouplerSettings& settings) {
  checkGains("coupler", settings.linear);
  checkGains("angular coupler", settings.angular);
  switch (kind) {
    case NativeCouplerKind::kSpring6Dof:
      return std::make_unique<Spring6DofCoupler>(world, body, settings);
    case NativeCouplerKind::kPointToPoint:
      return std::make_unique<PointToPointCoupler>(world, body, settings);
    case NativeCouplerKind::kImpulse:
      break;
  }
  return std::make_unique<ImpulseCoupler>(body, settings);
}

}  // namespace tandem
