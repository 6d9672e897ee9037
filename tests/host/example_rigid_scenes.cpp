// Bullet's examples of stacks, slopes and shapes.

#include <BulletCollision/CollisionDispatch/btBox2dBox2dCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvex2dConvex2dAlgorithm.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/NarrowPhaseCollision/btMinkowskiPenetrationDepthSolver.h>

#include "host/example_scenes.h"

namespace tandem::test {
namespace {

const btVector3 kDown(0, -10, 0);

/// Five layers of five by five boxes that touch.
void addCubeOfCubes(ExampleHost& host) {
  btBoxShape& shape = host.box(0.1, 0.1, 0.1);
  for (int k = 0; k < 5; ++k)
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) {
        btRigidBody& body = host.addBody(1.0, pose(at(0.2 * i, 2 + 0.2 * k, 0.2 * j)), shape);
        if (k == 4 && i == 4 && j == 2) host.offer(body);
      }
}

void buildBasicExample(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  host.addGround();
  addCubeOfCubes(host);
}

void buildHelloWorld(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  host.most_sub_steps = 10;
  host.addBody(0.0, pose(at(0, -56, 0)), host.box(50, 50, 50));
  host.offer(host.addBody(1.0, pose(at(2, 10, 0)), host.keep<btSphereShape>(num(1))));
}

void buildSimpleBox(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  host.addGround();
  host.offer(host.addBody(1.0, pose(at(0, 20, 0)), host.box(1, 1, 1)));
}

void buildMultipleBoxes(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  host.addGround();
  btBoxShape& shape = host.box(1, 1, 1);
  for (int i = 0; i < 10; ++i) {
    btRigidBody& body = host.addBody(1.0, pose(at(0, 20 + 2 * i, 0)), shape);
    if (i == 9) host.offer(body);
  }
}

void buildCompoundBoxes(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  host.addGround();
  btBoxShape& cube = host.box(0.5, 0.5, 0.5);
  btCompoundShape parts;
  for (const btVector3& p : {at(0, 0, 0), at(0, -1, 0), at(0, 0, 1)})
    parts.addChildShape(pose(p), &cube);
  const btScalar masses[] = {1, 1, 1};
  btTransform principal;
  btVector3 inertia;
  parts.calculatePrincipalAxisTransform(masses, principal, inertia);
  auto& compound = host.keep<btCompoundShape>();
  for (int i = 0; i < parts.getNumChildShapes(); ++i)
    compound.addChildShape(principal.inverse() * parts.getChildTransform(i), &cube);
  host.offer(host.addBody(1.0, pose(at(0, 10, 0)), compound));
}

void buildRollingFriction(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, btVector3(0, 0, -10));
  host.addBody(0.0, pose(at(0, 0, -28), turn(at(0, 1, 0), SIMD_PI * 0.03)), host.box(10, 5, 25))
      .setFriction(num(0.5));
  host.addBody(0.0, pose(at(0, 0, -54)), host.box(100, 100, 50)).setFriction(num(0.1));
  const btScalar r = num(0.25), h = num(0.5);
  btCollisionShape* shapes[] = {&host.keep<btSphereShape>(h),
                                &host.keep<btCapsuleShape>(r, h),
                                &host.keep<btCapsuleShapeX>(r, h),
                                &host.keep<btCapsuleShapeZ>(r, h),
                                &host.keep<btConeShape>(r, h),
                                &host.keep<btConeShapeX>(r, h),
                                &host.keep<btConeShapeZ>(r, h),
                                &host.keep<btCylinderShape>(btVector3(r, h, r)),
                                &host.keep<btCylinderShapeX>(btVector3(h, r, r)),
                                &host.keep<btCylinderShapeZ>(btVector3(r, r, h))};
  int count = 0;
  for (int k = 0; k < 5; ++k)
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) {
        btCollisionShape& shape = *shapes[++count % 10];
        btRigidBody& body = host.addBody(1.0, pose(at(2 * i - 7, 2 * j - 5, 15 + 2 * k)), shape);
        body.setFriction(1);
        body.setRollingFriction(num(0.1));
        body.setSpinningFriction(num(0.1));
        body.setAnisotropicFriction(shape.getAnisotropicRollingFrictionDirection(),
                                    btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION);
        if (count == 121) host.offer(body);
      }
}

void buildGyroscopic(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, at(0, 0, 0));
  const int flags[] = {0, BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT,
                       BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD,
                       BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY};
  for (int i = 0; i < 4; ++i) {
    auto& pin = host.keep<btCylinderShapeZ>(at(0.1, 0.1, 0.2));
    btBoxShape& box = host.box(1, 0.1, 0.1);
    box.setMargin(num(0.01));
    pin.setMargin(num(0.01));
    auto& compound = host.keep<btCompoundShape>();
    compound.addChildShape(btTransform::getIdentity(), &pin);
    compound.addChildShape(pose(at(0, 0, 0.2)), &box);
    const btScalar masses[] = {num(0.3), num(0.1)};
    btTransform principal;
    btVector3 inertia;
    compound.calculatePrincipalAxisTransform(masses, principal, inertia);
    btRigidBody& body = host.addBody(1.0, pose(at(-10 + 5 * i, 8, 4)), compound);
    body.setMassProps(1, inertia);
    body.setAngularVelocity(at(0, 0.1, 10));
    body.setFriction(1);
    body.setFlags(flags[i]);
    body.setDamping(0, 0);
    host.offer(body);
  }
  host.world().getSolverInfo().m_maxGyroscopicForce = 10;
  host.addBody(0.0, pose(at(0, 0, 0)), host.keep<btStaticPlaneShape>(at(0, 1, 0), num(0)))
      .setFriction(btSqrt(2));
}

void buildInclinedPlane(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  host.addGround();
  btRigidBody& ramp = host.addBody(0.0, pose(at(0, 15, 0), turn(at(0, 0, 1), SIMD_PI * 20 / 180)),
                                   host.box(20, 1, 10));
  ramp.setFriction(1);
  ramp.setRestitution(0);
  btRigidBody& box = host.addBody(1.0, pose(at(0, 20, 2)), host.box(1, 1, 1));
  box.forceActivationState(DISABLE_DEACTIVATION);
  box.setFriction(1);
  box.setRestitution(0);
  btRigidBody& ball = host.addBody(1.0, pose(at(0, 20, 4)), host.keep<btSphereShape>(num(1)));
  ball.forceActivationState(DISABLE_DEACTIVATION);
  ball.setFriction(1);
  ball.setRestitution(0);
  ball.setRollingFriction(1);
  ball.setSpinningFriction(num(0.3));
  host.offer(box);
}

void turnTheFloor(btDynamicsWorld* world, btScalar dt) {
  auto& floor = *static_cast<btRigidBody*>(world->getWorldUserInfo());
  btTransform next;
  btTransformUtil::integrateTransform(floor.getWorldTransform(), at(0, 0, 0), at(0, 0.1, 0), dt,
                                      next);
  floor.getMotionState()->setWorldTransform(next);
}

void buildKinematicRigidBody(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  btRigidBody& floor = host.addBody(0.0, pose(at(0, -0.1, 0)), host.box(10, 0.1, 10));
  host.world().removeRigidBody(&floor);
  floor.forceActivationState(DISABLE_DEACTIVATION);
  floor.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT |
                          btCollisionObject::CF_STATIC_OBJECT);
  host.world().addRigidBody(&floor);
  host.world().setInternalTickCallback(turnTheFloor, &floor, true);
  addCubeOfCubes(host);
}

void buildRigidBodySoftContact(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  btContactSolverInfo& info = host.world().getSolverInfo();
  info.m_erp2 = 0;
  info.m_globalCfm = 0;
  info.m_numIterations = 3;
  info.m_solverMode = SOLVER_SIMD;
  info.m_splitImpulse = 0;
  host.addGround().setContactStiffnessAndDamping(300, 10);
  auto& compound = host.keep<btCompoundShape>();
  compound.addChildShape(btTransform::getIdentity(), &host.keep<btSphereShape>(num(0.5)));
  host.offer(host.addBody(1.0, pose(at(0.1, 3, 0), turn(at(1, 1, 1), SIMD_PI / 10)), compound));
}

void buildPlanar2D(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, kDown);
  auto& convex = host.keep<btConvex2dConvex2dAlgorithm::CreateFunc>(
      &host.keep<btVoronoiSimplexSolver>(), &host.keep<btMinkowskiPenetrationDepthSolver>());
  auto& boxes = host.keep<btBox2dBox2dCollisionAlgorithm::CreateFunc>();
  constexpr int kConvex = CONVEX_2D_SHAPE_PROXYTYPE, kBox = BOX_2D_SHAPE_PROXYTYPE;
  host.dispatcher().registerCollisionCreateFunc(kConvex, kConvex, &convex);
  host.dispatcher().registerCollisionCreateFunc(kBox, kConvex, &convex);
  host.dispatcher().registerCollisionCreateFunc(kConvex, kBox, &convex);
  host.dispatcher().registerCollisionCreateFunc(kBox, kBox, &boxes);
  host.addBody(0.0, pose(at(0, -43, 0)), host.box(150, 50, 150));
  const btScalar u = num(0.96);
  auto& triangle = host.keep<btConvexHullShape>();
  for (const btVector3& corner : {btVector3(0, u, 0), btVector3(-u, -u, 0), btVector3(u, -u, 0)})
    triangle.addPoint(corner);
  auto& square = host.keep<btConvex2dShape>(&host.box(1, 1, 0.04));
  square.setMargin(num(0.03));
  btCollisionShape* shapes[] = {
      &square, &host.keep<btConvex2dShape>(&host.keep<btCylinderShapeZ>(at(1, 1, 0.04))),
      &host.keep<btConvex2dShape>(&triangle)};
  btVector3 inertia;
  square.calculateLocalInertia(1, inertia);
  for (int i = 0; i < 5; ++i) {
    for (int j = i; j < 5; ++j) {
      btRigidBody& body =
          host.addBody(1.0, pose(at(5 + i + 2 * (j - i), 8 + 2 * i, -20)), *shapes[j % 3]);
      body.setMassProps(1, inertia);
      body.setLinearFactor(at(1, 1, 0));
      body.setAngularFactor(at(0, 0, 1));
      body.setActivationState(ISLAND_SLEEPING);
      host.offer(body);
    }
  }
  host.guest_at = at(9, 22, -20);
}

}  // namespace

std::vector<ExampleScene> rigidScenes() {
  return {{"BasicExample", buildBasicExample, 12.0},
          {"HelloWorld", buildHelloWorld},
          {"SimpleBoxExample", buildSimpleBox},
          {"MultipleBoxesExample", buildMultipleBoxes},
          {"CompoundBoxesExample", buildCompoundBoxes},
          {"RollingFrictionDemo", buildRollingFriction},
          {"GyroscopicSetup", buildGyroscopic},
          {"InclinedPlaneExample", buildInclinedPlane},
          {"KinematicRigidBodyExample", buildKinematicRigidBody, 8.0, false},
          {"RigidBodySoftContact", buildRigidBodySoftContact},
          {"Planar2D", buildPlanar2D}};
}

}  // namespace tandem::test
