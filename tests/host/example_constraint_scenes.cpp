// Bullet's examples of each kind of joint, with limits, springs, servos and motors.

#include <cmath>

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>

#include "host/example_scenes.h"

namespace tandem::test {
namespace {

constexpr double kQuarter = SIMD_PI / 4, kHalf = SIMD_PI / 2;

/// The unit cubes of AllConstraintDemo.
class Cubes {
 public:
  explicit Cubes(ExampleHost& host) : host_(host), shape_(host.box(1, 1, 1)) {}
  btRigidBody& add(double x, double y, double z, double mass = 1.0) {
    return host_.addBody(mass, pose(at(x, y, z)), shape_);
  }
  btRigidBody& addAwake(double x, double y, double z, double mass = 1.0) {
    btRigidBody& body = add(x, y, z, mass);
    body.setActivationState(DISABLE_DEACTIVATION);
    return body;
  }

 private:
  ExampleHost& host_;
  btBoxShape& shape_;
};

/// Two discs whose turns are coupled, one of them tilted.
void addGears(ExampleHost& host) {
  const double l_1 = 2 - std::tan(kQuarter), l_2 = 1 / std::cos(kQuarter);
  const auto addDisc = [&](double hub, double radius, const btTransform& start) -> btRigidBody& {
    auto& compound = host.keep<btCompoundShape>();
    compound.addChildShape(btTransform::getIdentity(),
                           &host.keep<btCylinderShape>(at(0.2, hub, 0.2)));
    compound.addChildShape(btTransform::getIdentity(),
                           &host.keep<btCylinderShape>(at(radius, 0.025, radius)));
    btRigidBody& body = host.addBody(6.28, start, compound);
    body.setLinearFactor(at(0, 0, 0));
    return body;
  };
  btRigidBody& a = addDisc(0.25, l_1, pose(at(-8, 1, -8)));
  a.setAngularFactor(at(0, 1, 0));
  const btQuaternion tilt = turn(at(0, 0, 1), -kQuarter);
  btRigidBody& b = addDisc(0.26, l_2, pose(at(-10, 2, -8), tilt));
  host.join<btHingeConstraint>(false, b, at(0, 0, 0), at(0, 1, 0), true);
  b.setAngularVelocity(at(0, 3, 0));
  const btVector3 axis_b = btMatrix3x3(tilt).getRow(1);
  host.join<btGearConstraint>(true, a, b, at(0, 1, 0), axis_b, num(l_2 / l_1));
}

void addSliders(ExampleHost& host, Cubes& cubes) {
  const btTransform here = btTransform::getIdentity();
  auto& slider = host.join<btSliderConstraint>(true, cubes.addAwake(-20, 0, 30),
                                               cubes.addAwake(-30, 0, 30), here, here, true);
  slider.setLowerLinLimit(-15);
  slider.setUpperLinLimit(-5);
  slider.setLowerAngLimit(num(-SIMD_PI / 3));
  slider.setUpperAngLimit(num(SIMD_PI / 3));

  btRigidBody& led = cubes.addAwake(0, 10, 0);
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, nullptr);
  info.m_startWorldTransform = pose(at(0, 10, 0));
  auto& fixed = host.keep<btRigidBody>(info);
  const btTransform up = pose(at(0, 5, 0));
  auto& driven = host.join<btGeneric6DofConstraint>(false, fixed, led, up, up, true);
  driven.setLinearLowerLimit(at(-10, 0, 0));
  driven.setLinearUpperLimit(at(10, 0, 0));
  driven.setAngularLowerLimit(at(-SIMD_PI, 0, 0));
  driven.setAngularUpperLimit(at(1.5, 0, 0));
  driven.getTranslationalLimitMotor()->m_enableMotor[0] = true;
  driven.getTranslationalLimitMotor()->m_targetVelocity[0] = -5;
  driven.getTranslationalLimitMotor()->m_maxMotorForce[0] = 6;
}

btRigidBody& addDoor(ExampleHost& host) {
  btRigidBody& door = host.addBody(1.0, pose(at(-5, -2, 0)), host.box(2, 5, 0.2));
  door.setActivationState(DISABLE_DEACTIVATION);
  return door;
}

void addSixDofs(ExampleHost& host, Cubes& cubes) {
  btRigidBody& a = cubes.addAwake(10, 6, 0, 0.0);
  btRigidBody& b = cubes.addAwake(0, 6, 0);
  auto& limited =
      host.join<btGeneric6DofConstraint>(true, a, b, pose(at(-5, 0, 0)), pose(at(5, 0, 0)), true);
  limited.setLinearLowerLimit(at(-10, -2, -1));
  limited.setLinearUpperLimit(at(10, 2, 1));
  limited.setAngularLowerLimit(at(-kHalf * 0.5, -0.75, -kHalf * 0.8));
  limited.setAngularUpperLimit(at(kHalf * 0.5, 0.75, kHalf * 0.8));

  btRigidBody& c = cubes.addAwake(-20, 16, 0, 0.0);
  btRigidBody& d = cubes.addAwake(-10, 16, 0);
  auto& spring = host.join<btGeneric6DofSpringConstraint>(true, c, d, pose(at(10, 0, 0)),
                                                          pose(at(0, 0, 0)), true);
  spring.setLinearUpperLimit(at(5, 0, 0));
  spring.setLinearLowerLimit(at(-5, 0, 0));
  spring.setAngularLowerLimit(at(0, 0, -1.5));
  spring.setAngularUpperLimit(at(0, 0, 1.5));
  for (const int axis : {0, 5}) {
    spring.enableSpring(axis, true);
    spring.setStiffness(axis, num(39.478));
  }
  spring.setDamping(0, num(0.3));
  spring.setEquilibriumPoint();

  btRigidBody& e = cubes.addAwake(10, -15, 0);
  auto& driven = host.join<btGeneric6DofConstraint>(false, e, btTransform::getIdentity(), false);
  driven.setAngularLowerLimit(at(0, 0, 0));
  driven.setAngularUpperLimit(at(0, 0, 0));
  driven.setLinearLowerLimit(at(-10, 0, 0));
  driven.setLinearUpperLimit(at(10, 0, 0));
  driven.getTranslationalLimitMotor()->m_enableMotor[0] = true;
  driven.getTranslationalLimitMotor()->m_targetVelocity[0] = 5;
  driven.getTranslationalLimitMotor()->m_maxMotorForce[0] = 6;
}

void addHingesAndCones(ExampleHost& host, Cubes& cubes) {
  const btMatrix3x3 across = eulerZyx(0, 0, kHalf);
  btRigidBody& head = cubes.addAwake(-10, 5, 0);
  btRigidBody& foot = cubes.add(-10, -5, 0, 0.0);
  host.join<btConeTwistConstraint>(true, head, foot, btTransform(across, at(0, -5, 0)),
                                   btTransform(across, at(0, 5, 0)))
      .setLimit(num(kQuarter * 0.6), num(kQuarter), num(SIMD_PI * 0.8), num(0.5));

  host.join<btHingeConstraint>(false, cubes.addAwake(0, 0, 0), at(10, 0, 0), at(0, 0, 1))
      .enableAngularMotor(true, -1, num(1.65));

  btRigidBody& a = cubes.addAwake(20, 4, 0, 0.0);
  btRigidBody& b = cubes.addAwake(20, 0, 0);
  auto& universal =
      host.join<btUniversalConstraint>(true, a, b, at(20, 2, 0), at(1, 0, 0), at(0, 0, 1));
  universal.setLowerLimit(num(-kQuarter), num(-kQuarter));
  universal.setUpperLimit(num(kQuarter), num(kQuarter));

  btRigidBody& c = cubes.addAwake(-20, 4, 0, 0.0);
  btRigidBody& d = cubes.addAwake(-20, 0, 0);
  btVector3 anchor = at(-20, 0, 0), parent = at(0, 1, 0), child = at(1, 0, 0);
  auto& hinge2 = host.join<btHinge2Constraint>(true, c, d, anchor, parent, child);
  hinge2.setLowerLimit(num(-kQuarter));
  hinge2.setUpperLimit(num(kQuarter));

  btRigidBody& light = cubes.addAwake(-20, -2, 0);
  btRigidBody& heavy = cubes.addAwake(-30, -2, 0, 10.0);
  btVector3 up = at(0, 1, 0);
  host.join<btHingeConstraint>(true, light, heavy, at(-5, 0, 0), at(5, 0, 0), up, up)
      .setLimit(num(-kQuarter), num(kQuarter));
}

void buildAllConstraints(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, at(0, -10, 0));
  host.addBody(0.0, pose(at(0, -56, 0)), host.keep<btStaticPlaneShape>(at(0, 1, 0), num(40)));
  Cubes cubes(host);
  addGears(host);
  host.offer(cubes.add(1, 30, -5));
  host.join<btPoint2PointConstraint>(false, cubes.add(0, 0, -5), at(1, 1, 0))
      .setBreakingImpulseThreshold(num(10.2));
  host.join<btPoint2PointConstraint>(false, cubes.add(2, 20, 0), at(1, -1, -1));
  addSliders(host, cubes);
  host.join<btHingeConstraint>(false, addDoor(host), at(12.1, -2, 0), at(0, 1, 0))
      .setLimit(num(-kQuarter), num(kQuarter));
  addSixDofs(host, cubes);
  addHingesAndCones(host, cubes);
}

void buildConstraintPhysics(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, at(0, -10, 0));
  host.most_sub_steps = 10;
  host.fixed_step = 1.0 / 240.0;
  btRigidBody& door = addDoor(host);
  auto& hinge =
      host.join<btHingeAccumulatedAngleConstraint>(false, door, at(12.1, -2, 0), at(0, 1, 0));
  host.before = [&hinge](int) {
    static_cast<void>(hinge.getAccumulatedHingeAngle());
    hinge.enableAngularMotor(true, 0, 10000);
  };
  host.offer(door);
}

void buildTestHingeTorque(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, at(0, 0, -10));
  host.dt = 1.0 / 240.0;
  host.most_sub_steps = 0;
  host.world().getSolverInfo().m_splitImpulse = 0;
  constexpr int kGroup = btBroadphaseProxy::CharacterFilter;
  constexpr int kMask = btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::CharacterFilter;
  btBoxShape& bar = host.box(0.05, 0.37, 0.1);
  btRigidBody& base = host.addBody(0.0, pose(at(-0.4, 3, 0)), bar, kGroup, kMask);
  btRigidBody& link = host.addBody(1.0, pose(at(-0.4, 2.26, 0)), bar, kGroup, kMask);
  btRigidBody& ball =
      host.addBody(1.0, pose(at(-0.4, 1.52, 0)), host.keep<btSphereShape>(num(0.2)), kGroup, kMask);
  for (btRigidBody* body : {&base, &link, &ball}) body->setDamping(0, 0);
  btVector3 axis = at(1, 0, 0);
  host.join<btHingeConstraint>(true, base, link, at(0, -0.37, 0), at(0, 0.37, 0), axis, axis, true)
      .setJointFeedback(&host.keep<btJointFeedback>());
  auto& rigid = host.join<btGeneric6DofSpring2Constraint>(true, link, ball, pose(at(0, -0.2, 0)),
                                                          pose(at(0, 0.2, 0)));
  rigid.setLinearLowerLimit(at(0, 0, 0));
  rigid.setLinearUpperLimit(at(0, 0, 0));
  rigid.setAngularLowerLimit(at(0, 0, 0));
  rigid.setAngularUpperLimit(at(0, 0, 0));
  rigid.setJointFeedback(&host.keep<btJointFeedback>());
  host.addBody(0.0, pose(at(-0.4, 2.5, -0.6)), host.box(1, 1, 0.2)).setFriction(0);
  host.offer(ball);
}

/// What Dof6Spring2Setup changes every three seconds.
struct SpringShow {
  btRigidBody *bouncing = nullptr, *end = nullptr;
  btGeneric6DofSpring2Constraint *servo = nullptr, *left = nullptr, *right = nullptr;
  bool is_left = true;

  void animate(btDiscreteDynamicsWorld& world, int step) {
    bouncing->setActivationState(ACTIVE_TAG);
    if (step % 181 != 0) return;
    servo->getRotationalLimitMotor(2)->m_servoTarget *= -1;
    end->setActivationState(ACTIVE_TAG);
    world.removeConstraint(is_left ? left : right);
    world.addConstraint(is_left ? right : left, true);
    is_left = !is_left;
    bouncing->applyCentralImpulse(at(10, 0, 0));
  }
};

using SixDof = btGeneric6DofSpring2Constraint;

/// Locks all six axes of a joint but `free`.
void lockAllBut(SixDof& joint, int free) {
  for (int axis = 0; axis < 6; ++axis)
    joint.setLimit(axis, axis == free ? 1 : 0, axis == free ? -1 : 0);
}
void setStops(SixDof& joint, double erp, int axes) {
  for (int axis = 0; axis < axes; ++axis) {
    joint.setParam(BT_CONSTRAINT_STOP_ERP, num(erp), axis);
    joint.setParam(BT_CONSTRAINT_STOP_CFM, 0, axis);
  }
}

void buildDof6Spring2(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, at(0, 0, 0), 10000,
                 std::make_unique<btNNCGConstraintSolver>());
  host.world().getDispatchInfo().m_useContinuous = true;
  host.world().getSolverInfo().m_numIterations = 100;
  auto& ground = host.keep<btCollisionObject>();
  ground.setCollisionShape(&host.box(200, 5, 200));
  ground.setWorldTransform(pose(at(0, -10, 0)));
  host.world().addCollisionObject(&ground);
  btBoxShape& shape = host.box(0.5, 0.5, 0.5);
  auto& fixed = host.keep<btRigidBody>(num(0), nullptr, &shape);
  const auto addCube = [&](const btTransform& start) -> btRigidBody& {
    btRigidBody& body = host.addBody(1.0, start, shape);
    body.setActivationState(DISABLE_DEACTIVATION);
    return body;
  };
  const auto join = [&](btRigidBody& body, const btVector3& a, const btVector3& b) -> SixDof& {
    return host.join<SixDof>(true, fixed, body, pose(a), pose(b));
  };
  auto& show = host.keep<SpringShow>();

  SixDof& sliding = join(addCube(pose(at(-2, 0, -5))), at(0, 0, -5), at(0, 0, 0));
  SixDof& turning = join(addCube(btTransform(eulerZyx(0, 0, kHalf))), at(0, 0, 0), at(0, 0.5, 0));
  for (const auto& [joint, axis] : {std::pair(&sliding, 0), std::pair(&turning, 5)}) {
    lockAllBut(*joint, axis);
    joint->enableSpring(axis, true);
    joint->setStiffness(axis, 100);
    joint->setDamping(axis, 0);
    joint->setEquilibriumPoint(0, 0);
  }

  show.bouncing = &addCube(pose(at(0, 0, -3)));
  show.bouncing->setDeactivationTime(20000000);
  for (const bool is_low : {true, false}) {
    SixDof& wall = join(*show.bouncing, at(0, 0, 0), at(0, 0, 0));
    lockAllBut(wall, 0);
    wall.setLimit(0, is_low ? num(-2) : -SIMD_INFINITY, is_low ? SIMD_INFINITY : num(2));
    wall.setLimit(2, -3, -3);
    wall.setBounce(0, is_low ? 0 : 1);
    setStops(wall, 0.995, 1);
  }

  for (const double x : {4.0, 7.0}) {
    SixDof& motor = join(addCube(pose(at(x, 0, 0))), at(x, 0, 0), at(0, 0, 0));
    lockAllBut(motor, 5);
    motor.enableMotor(5, true);
    motor.setTargetVelocity(5, 3);
    motor.setMaxMotorForce(5, 600);
    if (x < 5.0) continue;
    motor.setServo(5, true);
    motor.setServoTarget(5, num(kHalf));
    show.servo = &motor;
  }

  constexpr int kLinks = 10;
  for (int i = 0; i < kLinks; ++i) {
    btRigidBody& body = addCube(pose(at(-i, 0, 3)));
    if (show.end) {
      SixDof& link =
          host.join<SixDof>(true, *show.end, body, pose(at(-0.5, 0, 0)), pose(at(0.5, 0, 0)));
      lockAllBut(link, -1);
      link.setLimit(0, num(-0.01), num(0.01));
      setStops(link, 0.9, 6);
    }
    if (i < kLinks - 1) {
      join(body, at(0, 0, 3), at(0, 0, 0)).setLimit(0, 1, -1);
    } else {
      show.left = &join(body, at(kLinks, 0, 3), at(0, 0, 0));
      show.right = &host.keep<SixDof>(fixed, body, pose(at(-kLinks, 0, 3)), pose(at(0, 0, 0)));
      for (SixDof* end : {show.left, show.right}) {
        for (const int axis : {3, 4, 5}) end->setLimit(axis, 0, 0);
        setStops(*end, 0.6, 6);
      }
    }
    show.end = &body;
  }
  host.offer(*show.bouncing);
  host.before = [&show, &host](int step) { show.animate(host.world(), step); };
}

}  // namespace

std::vector<ExampleScene> constraintScenes() {
  return {{"AllConstraintDemo", buildAllConstraints},
          {"ConstraintPhysicsSetup", buildConstraintPhysics},
          {"TestHingeTorque", buildTestHingeTorque},
          {"Dof6Spring2Setup", buildDof6Spring2}};
}

}  // namespace tandem::test
