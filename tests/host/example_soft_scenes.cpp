// Bullet's examples of cloths, ropes and soft balls. Those made of mesh tables are not here.

#include <cmath>

#include "host/example_scenes.h"

namespace tandem::test {
namespace {

using Helpers = btSoftBodyHelpers;

btSoftBody* makePatch(ExampleHost& host, double half, double y, int nodes, int fixed) {
  return Helpers::CreatePatch(host.softInfo(), at(-half, y, -half), at(half, y, -half),
                              at(-half, y, half), at(half, y, half), nodes, nodes, fixed, true);
}

void buildSimpleCloth(ExampleHost& host) {
  host.makeWorld(WorldKind::kSoftRigid, at(0, -10, 0));
  host.softInfo().m_sparsesdf.Initialize();
  host.addGround();
  btSoftBody* cloth = Helpers::CreatePatch(host.softInfo(), at(-2, 5, 0), at(2, 5, 0), at(-2, 5, 4),
                                           at(2, 5, 4), 31, 31, 1 + 2, true);
  cloth->getCollisionShape()->setMargin(num(0.001));
  cloth->generateBendingConstraints(2, cloth->appendMaterial());
  cloth->setTotalMass(10);
  cloth->m_cfg.piterations = 5;
  cloth->m_cfg.kDP = num(0.005);
  host.addSoft(cloth);
  host.guest_at = at(0.5, 6, 2);
}

/// Five balls on two ropes each. The example's key 3, a push on the first, comes after a second.
void buildNewtonsRopeCradle(ExampleHost& host) {
  host.makeWorld(WorldKind::kSoftRigid, at(0, -10, 0));
  host.softInfo().m_sparsesdf.Initialize();
  auto& shape = host.keep<btSphereShape>(num(1));
  for (int i = 0; i < 5; ++i) {
    const double x = -2.1 * i;
    btRigidBody& front = host.addBody(0.0, pose(at(x, 15, 4)), shape);
    btRigidBody& back = host.addBody(0.0, pose(at(x, 15, -4)), shape);
    btRigidBody& ball = host.addBody(1.0, pose(at(x, 7, 0)), shape);
    ball.setFriction(0);
    for (btRigidBody* body : {&front, &back, &ball}) body->setActivationState(DISABLE_DEACTIVATION);
    ball.setRestitution(1);
    for (btRigidBody* top : {&front, &back}) {
      btSoftBody* rope = Helpers::CreateRope(host.softInfo(), top->getWorldTransform().getOrigin(),
                                             ball.getWorldTransform().getOrigin(), 1, 0);
      rope->setTotalMass(num(0.1));
      rope->appendAnchor(0, top);
      rope->appendAnchor(rope->m_nodes.size() - 1, &ball);
      rope->m_cfg.piterations = 5;
      rope->m_cfg.kDP = num(0.005);
      rope->m_cfg.kSHR = 1;
      rope->m_cfg.kCHR = 1;
      rope->m_cfg.kKHR = 1;
      host.addSoft(rope);
    }
    if (i == 0) {
      host.before = [&ball](int step) {
        if (step == 60) ball.applyCentralForce(at(30, 0, 0));
      };
    }
    host.offer(ball);
  }
}

/// The waves on which SoftDemo's later scenes stand.
btCollisionShape& makeWaves(ExampleHost& host) {
  constexpr int kSide = 30;
  auto& mesh = host.keep<btTriangleMesh>();
  const auto vertex = [](int i, int j) {
    return at((i - 0.5 * kSide) * 8.0, 5.0 * std::sin(i) * std::cos(j - 50),
              (j - 0.5 * kSide) * 8.0);
  };
  for (int i = 0; i < kSide - 1; ++i) {
    for (int j = 0; j < kSide - 1; ++j) {
      mesh.addTriangle(vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j));
      mesh.addTriangle(vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1));
    }
  }
  auto& shape = host.keep<btBvhTriangleMeshShape>(&mesh, true);
  shape.setMargin(num(0.5));
  return shape;
}

void beginSoftDemo(ExampleHost& host, bool has_waves = false) {
  host.makeWorld(WorldKind::kSoftRigid, at(0, -10, 0), 1000);
  host.world().getDispatchInfo().m_enableSPU = true;
  btSoftBodyWorldInfo& info = host.softInfo();
  info.m_sparsesdf.Initialize();
  info.air_density = num(1.2);
  info.water_density = 0;
  info.water_offset = 0;
  info.water_normal = at(0, 0, 0);
  auto& ground = host.keep<btCollisionObject>();
  ground.setWorldTransform(pose(at(0, -12, 0)));
  ground.setInterpolationWorldTransform(pose(at(0, -12, 0)));
  ground.setCollisionShape(has_waves ? &makeWaves(host) : &host.box(100, 1.5, 100));
  host.world().addCollisionObject(&ground);
}

void buildSoftDemoRopes(ExampleHost& host) {
  beginSoftDemo(host);
  for (int i = 0; i < 15; ++i) {
    btSoftBody* rope =
        Helpers::CreateRope(host.softInfo(), at(-10, 0, i * 0.25), at(10, 0, i * 0.25), 16, 1 + 2);
    rope->m_cfg.piterations = 4;
    rope->m_materials[0]->m_kLST = num(0.1 + i / 14.0 * 0.9);
    rope->setTotalMass(20);
    host.addSoft(rope);
  }
  host.guest_at = at(0, 3, 1.7);
}

void buildSoftDemoRopeAttach(ExampleHost& host) {
  beginSoftDemo(host);
  btRigidBody& body = host.addBody(50.0, pose(at(12, 8, 0)), host.box(2, 6, 2));
  for (const double z : {-1.0, 1.0}) {
    btSoftBody* rope = Helpers::CreateRope(host.softInfo(), at(0, 8, z), at(10, 8, z), 8, 1);
    rope->setTotalMass(50);
    host.addSoft(rope);
    rope->appendAnchor(rope->m_nodes.size() - 1, &body);
  }
  host.offer(body);
}

void buildSoftDemoClothAttach(ExampleHost& host) {
  beginSoftDemo(host);
  btSoftBody& cloth = host.addSoft(makePatch(host, 4, 6, 9, 4 + 8));
  btRigidBody& body = host.addBody(20.0, pose(at(0, 6, -7.5)), host.box(4, 1, 3));
  cloth.appendAnchor(0, &body);
  cloth.appendAnchor(8, &body);
  host.offer(body);
}

void buildSoftDemoSticks(ExampleHost& host) {
  beginSoftDemo(host);
  constexpr int kSide = 16;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const btVector3 root = at(-5 + 10.0 * x / (kSide - 1), -10, -5 + 10.0 * y / (kSide - 1));
      btSoftBody* stick = Helpers::CreateRope(host.softInfo(), root, root + at(0.004, 4, 0), 4, 1);
      stick->m_cfg.kDP = num(0.005);
      stick->m_cfg.kCHR = num(0.1);
      for (int i = 0; i < 3; ++i) stick->generateBendingConstraints(2 + i);
      stick->setMass(1, 0);
      stick->setTotalMass(num(0.01));
      host.addSoft(stick);
    }
  }
  host.offer(host.addBody(10.0, pose(at(0, 13, 0)), host.keep<btSphereShape>(num(3))));
}

void buildSoftDemoCapsuleCollision(ExampleHost& host) {
  beginSoftDemo(host);
  auto& capsule = host.keep<btCapsuleShapeX>(num(1), num(5));
  capsule.setMargin(num(0.5));
  host.addBody(0.0, pose(at(0, 4, 0)), capsule).setFriction(num(0.8));
  btSoftBody& cloth = host.addSoft(makePatch(host, 4, 6, 20, 0));
  cloth.setTotalMass(num(0.1));
  cloth.m_cfg.piterations = 10;
  cloth.m_cfg.citerations = 10;
  cloth.m_cfg.diterations = 10;
  host.guest_at = at(0.5, 9, 0.5);
}

void buildSoftDemoCollide3(ExampleHost& host) {
  beginSoftDemo(host);
  btSoftBody* net = makePatch(host, 8, 0, 15, 1 + 2 + 4 + 8);
  net->m_materials[0]->m_kLST = num(0.4);
  net->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
  net->setTotalMass(150);
  host.addSoft(net);
  btSoftBody* cloth = Helpers::CreatePatch(host.softInfo(), at(1, 10, -4), at(9, 10, -4),
                                           at(1, 10, 4), at(9, 10, 4), 7, 7, 0, true);
  btSoftBody::Material* material = cloth->appendMaterial();
  material->m_kLST = num(0.1);
  cloth->generateBendingConstraints(2, material);
  cloth->m_materials[0]->m_kLST = num(0.5);
  cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
  cloth->setTotalMass(150);
  host.addSoft(cloth);
  host.guest_at = at(-3, 3, 0);
}

void buildSoftDemoImpact(ExampleHost& host) {
  beginSoftDemo(host);
  btSoftBody& rope =
      host.addSoft(Helpers::CreateRope(host.softInfo(), at(0, 0, 0), at(0, -1, 0), 0, 1));
  rope.m_cfg.kCHR = num(0.5);
  host.offer(host.addBody(10.0, pose(at(0, 20, 0)), host.box(2, 2, 2)));
}

/// A soft ball that rolls down stairs onto a plate: Init_Pressure and Init_Volume.
btSoftBody& addBallAndStairs(ExampleHost& host, btSoftBody* ball) {
  host.addSoft(ball);
  btRigidBody& plate = host.addBody(15.0, pose(at(0, 4, 0.5)), host.box(5, 1, 5));
  plate.setFriction(1);
  btBoxShape& step = host.box(2, 1, 5);
  for (int i = 0; i < 10; ++i) host.addBody(0.0, pose(at(4 * i, 2 * i, 0)), step).setFriction(1);
  host.offer(plate);
  return *ball;
}

void buildSoftDemoPressure(ExampleHost& host) {
  beginSoftDemo(host);
  btSoftBody* ball = Helpers::CreateEllipsoid(host.softInfo(), at(35, 25, 0), at(3, 3, 3), 512);
  ball->m_materials[0]->m_kLST = num(0.1);
  ball->m_cfg.kDF = 1;
  ball->m_cfg.kDP = num(0.001);
  ball->m_cfg.kPR = 2500;
  ball->setTotalMass(30, true);
  addBallAndStairs(host, ball);
}

void buildSoftDemoVolume(ExampleHost& host) {
  beginSoftDemo(host);
  btSoftBody* ball = Helpers::CreateEllipsoid(host.softInfo(), at(35, 25, 0), at(3, 3, 3), 512);
  ball->m_materials[0]->m_kLST = num(0.45);
  ball->m_cfg.kVC = 20;
  ball->setTotalMass(50, true);
  ball->setPose(true, false);
  addBallAndStairs(host, ball);
}

/// A cylinder on three soft balls, each one cluster, on the waves.
void buildSoftDemoClusterRobot(ExampleHost& host) {
  beginSoftDemo(host, true);
  const auto addBall = [&](double x, double z) -> btSoftBody& {
    btSoftBody* ball =
        Helpers::CreateEllipsoid(host.softInfo(), at(x, 25, 8 + z), at(3, 3, 3), 512);
    ball->m_materials[0]->m_kLST = num(0.45);
    ball->m_cfg.kVC = 20;
    ball->setTotalMass(50, true);
    ball->setPose(true, false);
    ball->generateClusters(1);
    return host.addSoft(ball);
  };
  btSoftBody* balls[] = {&addBall(-8, 0), &addBall(8, 0), &addBall(0, 8 * std::sqrt(2.0))};
  btVector3 centre = at(0, 0, 0);
  for (btSoftBody* ball : balls) centre += ball->clusterCom(0) / 3;
  btRigidBody& body =
      host.addBody(50.0, pose(centre + at(0, 5, 0)), host.keep<btCylinderShape>(at(8, 1, 8)));
  for (btSoftBody* ball : balls) {
    btSoftBody::LJoint::Specs specs;
    specs.erp = num(0.5);
    specs.position = ball->clusterCom(0);
    ball->appendLinearJoint(specs, &body);
  }
  btQuaternion slope;
  slope.setEuler(0, -SIMD_HALF_PI / 2, 0);
  host.addBody(0.0, pose(at(0, 0, 0), slope), host.box(20, 1, 40));
  host.offer(body);
}

}  // namespace

std::vector<ExampleScene> softScenes() {
  return {{"SimpleClothExample", buildSimpleCloth, 8.0},
          {"NewtonsRopeCradleExample", buildNewtonsRopeCradle},
          {"SoftDemoRopes", buildSoftDemoRopes},
          {"SoftDemoRopeAttach", buildSoftDemoRopeAttach},
          {"SoftDemoClothAttach", buildSoftDemoClothAttach},
          {"SoftDemoSticks", buildSoftDemoSticks, 10.0},
          {"SoftDemoCapsuleCollision", buildSoftDemoCapsuleCollision},
          {"SoftDemoCollide3", buildSoftDemoCollide3},
          {"SoftDemoImpact", buildSoftDemoImpact},
          {"SoftDemoPressure", buildSoftDemoPressure},
          {"SoftDemoVolume", buildSoftDemoVolume},
          {"SoftDemoClusterRobot", buildSoftDemoClusterRobot, 1.5, false}};
}

}  // namespace tandem::test
