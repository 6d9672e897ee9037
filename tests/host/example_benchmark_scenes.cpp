// The scenes of Bullet's BenchmarkDemo, except those on a landscape of eight data tables.

#include "host/example_scenes.h"

namespace tandem::test {
namespace {

/// The settings and the floor of all these scenes.
void beginBenchmark(ExampleHost& host) {
  host.makeWorld(WorldKind::kDiscrete, at(0, -10, 0));
  host.world().getSolverInfo().m_solverMode |= SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  host.world().getSolverInfo().m_numIterations = 5;
  host.addBody(0.0, pose(at(0, -50, 0)), host.box(250, 50, 250));
}

/// 47 layers of eight by eight boxes, each layer shifted.
void buildThreeThousandBoxes(ExampleHost& host) {
  beginBenchmark(host);
  btBoxShape& shape = host.box(1, 1, 1);
  double y = 2.0, offset = -12.0;
  for (int k = 0; k < 47; ++k) {
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 8; ++i) {
        btRigidBody& body =
            host.addBody(2.0, pose(at(offset + 3.0 * i, y, offset + 3.0 * j)), shape);
        if (k == 1 && i == 7 && j == 4) host.offer(body);
      }
    offset -= 0.35;
    y += 3.0;
  }
}

void addWall(ExampleHost& host, double x, int size) {
  btBoxShape& shape = host.box(1, 1, 1);
  double offset = -size;
  for (double y = 1.0; size > 0; --size, y += 2.0, offset += 1.0)
    for (int i = 0; i < size; ++i) host.addBody(1.0, pose(at(x, y, offset + 2.0 * i)), shape);
}

void addPyramid(ExampleHost& host, double x, int size) {
  constexpr double kSpace = 0.0001, kPitch = 2.04 + kSpace;
  btBoxShape& shape = host.box(1, 1, 1);
  double offset = -0.5 * size * kPitch;
  for (double y = 1.0; size > 0; --size, y += kPitch, offset += 1.02)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        btRigidBody& body =
            host.addBody(1.0, pose(at(x + offset + i * kPitch, y, offset + j * kPitch)), shape);
        if (size == 1) host.offer(body);
      }
}

void addTower(ExampleHost& host, double x, int height, int around) {
  btBoxShape& shape = host.box(1, 1, 1);
  const double radius = 1.3 * around / SIMD_PI;
  btQuaternion q(0, 1, 0, 0);
  for (int i = 0; i < height; ++i) {
    for (int j = 0; j < around; ++j) {
      host.addBody(1.0, pose(at(x, 0, 0) + quatRotate(q, at(0, 1.0 + 2.0 * i, radius)), q), shape);
      q *= turn(at(0, 1, 0), 2.0 * double(SIMD_PI) / around);
    }
    q *= turn(at(0, 1, 0), double(SIMD_PI) / around);
  }
}

void buildThousandStack(ExampleHost& host) {
  beginBenchmark(host);
  addPyramid(host, -20.0, 12);
  for (const double x : {-2.0, 4.0, 10.0}) addWall(host, x, 12);
  addTower(host, 25.0, 8, 24);
}

constexpr double kOctant = SIMD_PI / 4, kRightAngle = SIMD_PI / 2;

struct Part {
  double radius, length, x, y, turn_z;
};
constexpr Part kParts[] = {{0.15, 0.20, 0.0, 1.0, 0.0},             // pelvis
                           {0.15, 0.28, 0.0, 1.2, 0.0},             // spine
                           {0.10, 0.05, 0.0, 1.6, 0.0},             // head
                           {0.07, 0.45, -0.18, 0.65, 0.0},          // left upper and lower leg
                           {0.05, 0.37, -0.18, 0.2, 0.0},           //
                           {0.07, 0.45, 0.18, 0.65, 0.0},           // right leg
                           {0.05, 0.37, 0.18, 0.2, 0.0},            //
                           {0.05, 0.33, -0.35, 1.45, kRightAngle},  // left upper and lower arm
                           {0.04, 0.25, -0.7, 1.45, kRightAngle},   //
                           {0.05, 0.33, 0.35, 1.45, -kRightAngle},  // right arm
                           {0.04, 0.25, 0.7, 1.45, -kRightAngle}};

struct Limb {
  int a, b;
  bool is_hinge;
  double turn_a, x_a, y_a, turn_b, y_b;  // a hinge turns about y, a cone about z
  double limit_1, limit_2, limit_3;
};
constexpr Limb kLimbs[] = {
    {0, 1, true, kRightAngle, 0, 0.15, kRightAngle, -0.15, -kOctant, kRightAngle, 0},
    {1, 2, false, kRightAngle, 0, 0.30, kRightAngle, -0.14, kOctant, kOctant, kRightAngle},
    {0, 3, false, -5 * kOctant, -0.18, -0.10, -5 * kOctant, 0.225, kOctant, kOctant, 0},
    {3, 4, true, kRightAngle, 0, -0.225, kRightAngle, 0.185, 0, kRightAngle, 0},
    {0, 5, false, kOctant, 0.18, -0.10, kOctant, 0.225, kOctant, kOctant, 0},
    {5, 6, true, kRightAngle, 0, -0.225, kRightAngle, 0.185, 0, kRightAngle, 0},
    {1, 7, false, SIMD_PI, -0.2, 0.15, kRightAngle, -0.18, kRightAngle, kRightAngle, 0},
    {7, 8, true, kRightAngle, 0, 0.18, kRightAngle, -0.14, -kRightAngle, 0, 0},
    {1, 9, false, 0, 0.2, 0.15, kRightAngle, -0.18, kRightAngle, kRightAngle, 0},
    {9, 10, true, kRightAngle, 0, 0.18, kRightAngle, -0.14, -kRightAngle, 0, 0}};

void addRagDoll(ExampleHost& host, const btVector3& p_W, double scale) {
  std::vector<btRigidBody*> bodies;
  for (const Part& part : kParts) {
    btTransform start(eulerZyx(0, 0, part.turn_z), at(scale * part.x, scale * part.y, 0));
    auto& shape = host.keep<btCapsuleShape>(num(part.radius * scale), num(part.length * scale));
    btRigidBody& body = host.addBody(1.0, pose(p_W) * start, shape);
    body.setDamping(num(0.05), num(0.85));
    body.setDeactivationTime(num(0.8));
    body.setSleepingThresholds(num(1.6), num(2.5));
    bodies.push_back(&body);
  }
  for (const Limb& limb : kLimbs) {
    const auto frame = [&](double angle, double x, double y) {
      const btMatrix3x3 basis = limb.is_hinge ? eulerZyx(0, angle, 0) : eulerZyx(0, 0, angle);
      return btTransform(basis, at(scale * x, scale * y, 0));
    };
    const btTransform a = frame(limb.turn_a, limb.x_a, limb.y_a);
    const btTransform b = frame(limb.turn_b, 0, limb.y_b);
    btRigidBody &body_a = *bodies[static_cast<std::size_t>(limb.a)],
                &body_b = *bodies[static_cast<std::size_t>(limb.b)];
    if (limb.is_hinge) {
      host.join<btHingeConstraint>(true, body_a, body_b, a, b)
          .setLimit(num(limb.limit_1), num(limb.limit_2));
    } else {
      host.join<btConeTwistConstraint>(true, body_a, body_b, a, b)
          .setLimit(num(limb.limit_1), num(limb.limit_2), num(limb.limit_3));
    }
  }
  host.offer(*bodies[2]);
}

/// Rows of 16, 15, ... 1 rag dolls above each other.
void buildRagDolls(ExampleHost& host) {
  beginBenchmark(host);
  double y = 1.0, z = 0.0;
  for (int size = 16; size > 0; --size, y += 7.0, z -= 2.0)
    for (int i = 0; i < size; ++i) addRagDoll(host, at(-3.0 * size + 6.0 * i, y, z), 3.5);
}

}  // namespace

std::vector<ExampleScene> benchmarkScenes() {
  return {{"Benchmark1", buildThreeThousandBoxes, 1.0},
          {"Benchmark2", buildThousandStack, 1.0},
          {"Benchmark3", buildRagDolls, 1.0}};
}

}  // namespace tandem::test
