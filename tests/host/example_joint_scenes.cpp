// Bullet's examples of chains, pendulums, walkers and vehicles.

#include <cmath>

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>

#include "host/example_scenes.h"

namespace tandem::test {
namespace {

const btVector3 kWeight(0, -10, 0);

void buildSimpleJoint(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight);
  host.addGround();
  btBoxShape& shape = host.box(1, 1, 1);
  btRigidBody& moving = host.addBody(1.0, pose(at(0, 10, 0)), shape);
  btRigidBody& fixed = host.addBody(0.0, pose(at(0, 20, 0)), shape);
  auto& joint = host.join<btPoint2PointConstraint>(false, moving, fixed, at(0, 3, 0), at(0, 0, 0));
  joint.m_setting.m_damping = num(0.0625);
  joint.m_setting.m_impulseClamp = num(0.95);
  host.offer(moving);
}

void buildChain(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight);
  host.addGround();
  btBoxShape& shape = host.box(1, 1, 0.25);
  btRigidBody* last = nullptr;
  for (int i = 0; i < 10; ++i) {
    btRigidBody& body = host.addBody(i == 9 ? 0.0 : 1.0, pose(at(0, 5 + 2 * i, 0)), shape);
    if (last) {
      for (const double x : {-0.5, 0.5})
        host.join<btPoint2PointConstraint>(false, *last, body, at(x, 1, 0), at(x, -1, 0));
    } else {
      host.offer(body);
    }
    last = &body;
  }
}

void buildBridge(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight);
  host.addGround();
  constexpr int kPlanks = 10;
  constexpr double kWidth = 0.4, kReach = 0.5 * (kWidth * kPlanks + kWidth * (kPlanks - 1));
  btBoxShape& shape = host.box(kWidth, 0.2, 1);
  btRigidBody* last = nullptr;
  for (int i = 0; i < kPlanks; ++i) {
    const bool is_end = i == 0 || i == kPlanks - 1;
    btRigidBody& body = host.addBody(
        is_end ? 0.0 : 1.0, pose(at(-(2.0 * i / (kPlanks - 1) - 1.0) * kReach, 5, 0)), shape);
    if (last) {
      for (const double z : {-0.5, 0.5})
        host.join<btPoint2PointConstraint>(false, *last, body, at(-0.5, 0, z), at(0.5, 0, z));
    }
    if (i == 4) host.offer(body);
    last = &body;
  }
}

/// A slider without play, which the pendulums' authors use as a rod.
void joinByRod(ExampleHost& host, btRigidBody& top, btRigidBody& bottom) {
  btQuaternion q;
  q.setEuler(0, 0, -SIMD_HALF_PI);
  const btVector3 top_in_bottom =
      bottom.getWorldTransform().invXform(top.getWorldTransform().getOrigin());
  auto& rod = host.join<btSliderConstraint>(true, top, bottom, pose(at(0, 0, 0), q),
                                            pose(top_in_bottom, q), true);
  rod.setLowerLinLimit(0);
  rod.setUpperLinLimit(0);
  rod.setLowerAngLimit(0);
  rod.setUpperAngLimit(0);
}

/// The example's key 3, pressed after a second: a push on the first ball.
void pushOnce(ExampleHost& host, btRigidBody& ball) {
  host.before = [&ball](int step) {
    if (step == 60) ball.applyCentralForce(at(30, 0, 0));
  };
}

void buildNewtonsCradle(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight);
  auto& shape = host.keep<btSphereShape>(num(1));
  for (int i = 0; i < 5; ++i) {
    btRigidBody& top = host.addBody(1.0, pose(at(-2.1 * i, 15, 0)), shape);
    btRigidBody& bottom = host.addBody(1.0, pose(at(-2.1 * i, 7, 0)), shape);
    bottom.setFriction(0);
    top.setActivationState(DISABLE_DEACTIVATION);
    bottom.setActivationState(DISABLE_DEACTIVATION);
    bottom.setRestitution(1);
    host.join<btPoint2PointConstraint>(true, top, at(0, 0, 0));
    joinByRod(host, top, bottom);
    if (i == 0) pushOnce(host, bottom);
    host.offer(bottom);
  }
}

void buildMultiPendulum(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight);
  auto& shape = host.keep<btSphereShape>(num(1));
  const auto addBall = [&](double y) -> btRigidBody& {
    btRigidBody& ball = host.addBody(1.0, pose(at(0, y, 0)), shape);
    ball.setActivationState(DISABLE_DEACTIVATION);
    return ball;
  };
  btRigidBody* parent = &addBall(15);
  host.join<btPoint2PointConstraint>(true, *parent, at(0, 0, 0));
  for (int i = 0; i < 2; ++i) {
    btRigidBody& joint = addBall(15 - 8 * i);
    joint.setFriction(0);
    const btVector3 parent_in_joint =
        joint.getWorldTransform().invXform(parent->getWorldTransform().getOrigin());
    host.join<btPoint2PointConstraint>(true, *parent, joint, at(0, 0, 0), parent_in_joint);
    btRigidBody& child = addBall(15 - 8 * (i + 1));
    child.setFriction(0);
    joinByRod(host, joint, child);
    parent = &child;
  }
  pushOnce(host, *parent);
  host.offer(*parent);
}

/// Six legs of two capsules on a body; the motors of its twelve hinges follow a sine.
class MotorRig {
 public:
  static constexpr int kLegs = 6;

  MotorRig(ExampleHost& host, const btVector3& p_W, bool is_fixed) {
    constexpr double kBody = 0.25, kThigh = 0.45, kShin = 0.75, kHeight = 0.5;
    const btTransform offset = pose(p_W);
    std::vector<btRigidBody*> bodies;
    const btVector3 root = at(0, kHeight, 0);
    bodies.push_back(&host.addBody(is_fixed ? 0.0 : 1.0, offset * pose(root),
                                   host.keep<btCapsuleShape>(num(kBody), num(0.10))));
    for (int i = 0; i < kLegs; ++i) {
      const double angle = double(SIMD_2_PI) * i / kLegs, c = std::cos(angle), s = std::sin(angle);
      const double middle = kBody + 0.5 * kThigh, knee = kBody + kThigh;
      const btVector3 bone = at(c * middle, kHeight, s * middle);
      const btVector3 axis = (bone - root).normalized().cross(at(0, 1, 0));
      const btTransform thigh = offset * pose(bone, turn(axis, SIMD_HALF_PI));
      bodies.push_back(
          &host.addBody(1.0, thigh, host.keep<btCapsuleShape>(num(0.10), num(kThigh))));
      const btTransform shin = offset * pose(at(c * knee, kHeight - 0.5 * kShin, s * knee));
      bodies.push_back(&host.addBody(1.0, shin, host.keep<btCapsuleShape>(num(0.08), num(kShin))));
    }
    for (btRigidBody* body : bodies) {
      body->setDamping(num(0.05), num(0.85));
      body->setDeactivationTime(num(0.8));
      body->setSleepingThresholds(num(0.5), num(0.5));
    }
    const btTransform& body_pose = bodies[0]->getWorldTransform();
    for (int i = 0; i < kLegs; ++i) {
      const double angle = double(SIMD_2_PI) * i / kLegs, c = std::cos(angle), s = std::sin(angle);
      btRigidBody &thigh = *bodies[static_cast<std::size_t>(1 + 2 * i)],
                  &shin = *bodies[static_cast<std::size_t>(2 + 2 * i)];
      const auto seenFrom = [&](const btRigidBody& body, const btTransform& frame) {
        return body.getWorldTransform().inverse() * body_pose * frame;
      };
      const btTransform hip(eulerZyx(0, -angle, 0), at(c * kBody, 0, s * kBody));
      auto& upper =
          host.join<btHingeConstraint>(true, *bodies[0], thigh, hip, seenFrom(thigh, hip));
      upper.setLimit(num(-0.75 * SIMD_PI / 4), num(SIMD_PI / 8));
      const double out = kBody + kThigh;
      const btTransform knee(eulerZyx(0, -angle, 0), at(c * out, 0, s * out));
      auto& lower = host.join<btHingeConstraint>(true, thigh, shin, seenFrom(thigh, knee),
                                                 seenFrom(shin, knee));
      lower.setLimit(num(-SIMD_PI / 8), num(0.2));
      hinges_.push_back(&upper);
      hinges_.push_back(&lower);
    }
    host.offer(*bodies[2]);
  }

  void setMotors(double time_ms, double dt) {
    constexpr int kPeriod = 2000;  // [ms]
    const double part = (static_cast<int>(time_ms) % kPeriod) / double(kPeriod);
    const double target = 0.5 * (1 + std::sin(SIMD_2_PI * part));
    for (btHingeConstraint* hinge : hinges_) {
      const double low = double(hinge->getLowerLimit()), high = double(hinge->getUpperLimit());
      const double error = low + target * (high - low) - double(hinge->getHingeAngle());
      hinge->enableAngularMotor(true, num(error / dt), num(0.5));
    }
  }

 private:
  std::vector<btHingeConstraint*> hinges_;
};

struct MotorRigs {
  std::vector<MotorRig> rigs;
  double time_ms = 0.0;
};

void moveLegs(btDynamicsWorld* world, btScalar dt) {
  auto& all = *static_cast<MotorRigs*>(world->getWorldUserInfo());
  all.time_ms += 1000.0 * double(dt);
  for (MotorRig& rig : all.rigs) rig.setMotors(all.time_ms, double(dt));
}

void buildMotorDemo(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight, 10000);
  host.addBody(0.0, pose(at(0, -10, 0)), host.box(200, 10, 200));
  auto& all = host.keep<MotorRigs>();
  host.world().setInternalTickCallback(moveLegs, &all, true);
  all.rigs.emplace_back(host, at(1, 0.5, 0), false);
  all.rigs.emplace_back(host, at(-2, 0.5, 0), true);
}

/// The chassis of both vehicles.
btCompoundShape& makeChassis(ExampleHost& host) {
  auto& compound = host.keep<btCompoundShape>();
  compound.addChildShape(pose(at(0, 1, 0)), &host.box(1, 0.5, 2));
  compound.addChildShape(pose(at(0, 1, 2.5)), &host.box(0.5, 0.1, 0.5));
  return compound;
}

/// Puts a vehicle's chassis to the origin, as both examples do at the end of their set-up.
void putToOrigin(ExampleHost& host, btRigidBody& chassis) {
  chassis.setCenterOfMassTransform(btTransform::getIdentity());
  host.world().getBroadphase()->getOverlappingPairCache()->cleanProxyFromPairs(
      chassis.getBroadphaseHandle(), &host.dispatcher());
}

void buildHinge2Vehicle(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight, 1000);
  host.most_sub_steps = 2;
  host.world().getSolverInfo().m_minimumSolverBatchSize = 128;
  host.world().getSolverInfo().m_numIterations = 100;
  host.addBody(0.0, pose(at(0, -3, 0)), host.box(50, 3, 50));
  btRigidBody& chassis = host.addBody(2.0, pose(at(0, 5, 0)), makeChassis(host));
  chassis.setActivationState(DISABLE_DEACTIVATION);
  host.offer(chassis);
  auto& shape = host.keep<btCylinderShapeX>(at(0.4, 0.5, 0.5));
  const btVector3 places[] = {at(-1, 4.75, 1.25), at(1, 4.75, 1.25), at(1, 4.75, -1.25),
                              at(-1, 4.75, -1.25)};
  for (btVector3 place : places) {
    btRigidBody& wheel = host.addBody(1.0, pose(place), shape);
    wheel.setFriction(1110);
    wheel.setActivationState(DISABLE_DEACTIVATION);
    btVector3 up = at(0, 1, 0), side = at(1, 0, 0);
    auto& hinge = host.join<btHinge2Constraint>(true, chassis, wheel, place, up, side);
    for (const int axis : {3, 5}) {
      hinge.enableMotor(axis, true);
      hinge.setMaxMotorForce(axis, 1000);
      hinge.setTargetVelocity(axis, 0);
    }
    hinge.setParam(BT_CONSTRAINT_CFM, num(0.15), 2);
    hinge.setParam(BT_CONSTRAINT_ERP, num(0.35), 2);
    hinge.setDamping(2, 2);
    hinge.setStiffness(2, 40);
    host.offer(wheel);
  }
  putToOrigin(host, chassis);
}

/// A fork lift on a btRaycastVehicle, solved by Dantzig's method, and its load.
void buildForkLift(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kWeight, 1000,
                 std::make_unique<btMLCPSolver>(&host.keep<btDantzigSolver>()));
  host.most_sub_steps = 2;
  host.world().getSolverInfo().m_minimumSolverBatchSize = 1;
  host.world().getSolverInfo().m_globalCfm = num(0.00001);
  host.addBody(0.0, pose(at(0, -3, 0)), host.box(50, 3, 50));
  btRigidBody& chassis = host.addBody(800.0, pose(at(0, 0, 0)), makeChassis(host));

  btRigidBody& lift = host.addBody(10.0, pose(at(0, 2.5, 3.05)), host.box(0.5, 2, 0.05));
  host.join<btHingeConstraint>(true, chassis, lift,
                               btTransform(eulerZyx(0, SIMD_HALF_PI, 0), at(0, 1, 3.05)),
                               btTransform(eulerZyx(0, SIMD_HALF_PI, 0), at(0, -1.5, -0.05)))
      .setLimit(0, 0);
  auto& fork_shape = host.keep<btCompoundShape>();
  fork_shape.addChildShape(pose(at(0, 0, 0)), &host.box(1, 0.1, 0.1));
  for (const double x : {-0.9, 0.9})
    fork_shape.addChildShape(pose(at(x, -0.08, 0.7)), &host.box(0.1, 0.02, 0.6));
  btRigidBody& fork = host.addBody(5.0, pose(at(0, 0.6, 3.2)), fork_shape);
  auto& slider = host.join<btSliderConstraint>(
      true, lift, fork, btTransform(eulerZyx(0, 0, SIMD_HALF_PI), at(0, -1.9, 0.05)),
      btTransform(eulerZyx(0, 0, SIMD_HALF_PI), at(0, 0, -0.1)), true);
  slider.setLowerLinLimit(num(0.1));
  slider.setUpperLinLimit(num(0.1));
  slider.setLowerAngLimit(0);
  slider.setUpperAngLimit(0);
  auto& load_shape = host.keep<btCompoundShape>();
  load_shape.addChildShape(pose(at(0, 0, 0)), &host.box(2, 0.5, 0.5));
  for (const double x : {2.1, -2.1})
    load_shape.addChildShape(pose(at(x, 0, 0)), &host.box(0.1, 1, 1));
  host.offer(host.addBody(350.0, pose(at(0, 3.5, 7)), load_shape));
  host.offer(lift);

  btRaycastVehicle::btVehicleTuning tuning;
  auto& caster = host.keep<btDefaultVehicleRaycaster>(&host.world());
  auto& vehicle = host.keep<btRaycastVehicle>(tuning, &chassis, &caster);
  chassis.setActivationState(DISABLE_DEACTIVATION);
  host.world().addVehicle(&vehicle);
  vehicle.setCoordinateSystem(0, 1, 2);
  const double x = 1.0 - 0.3 * 0.4;
  const btVector3 places[] = {at(x, 1.2, 1.5), at(-x, 1.2, 1.5), at(-x, 1.2, -1.5),
                              at(x, 1.2, -1.5)};
  for (int i = 0; i < 4; ++i) {
    btWheelInfo& wheel =
        vehicle.addWheel(places[i], at(0, -1, 0), at(-1, 0, 0), num(0.6), num(0.5), tuning, i < 2);
    wheel.m_suspensionStiffness = 20;
    wheel.m_wheelsDampingRelaxation = num(2.3);
    wheel.m_wheelsDampingCompression = num(4.4);
    wheel.m_frictionSlip = 1000;
    wheel.m_rollInfluence = num(0.1);
  }
  putToOrigin(host, chassis);
  vehicle.resetSuspension();
  for (int i = 0; i < 4; ++i) vehicle.updateWheelTransform(i, true);
  host.before = [&vehicle](int) {
    for (const int rear : {2, 3}) {
      vehicle.applyEngineForce(0, rear);
      vehicle.setBrake(10, rear);
    }
    for (const int front : {0, 1}) vehicle.setSteeringValue(0, front);
  };
}

}  // namespace

std::vector<ExampleScene> jointScenes() {
  return {{"SimpleJointExample", buildSimpleJoint},
          {"ChainExample", buildChain},
          {"BridgeExample", buildBridge},
          {"NewtonsCradleExample", buildNewtonsCradle},
          {"MultiPendulumExample", buildMultiPendulum},
          {"MotorDemo", buildMotorDemo},
          {"Hinge2Vehicle", buildHinge2Vehicle},
          {"ForkLiftDemo", buildForkLift}};
}

}  // namespace tandem::test
