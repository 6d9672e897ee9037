#include "reference/rigid_reference.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace tandem::reference {
namespace {

constexpr std::uint64_t kSeed = 20090216;

// Random numbers that are equal with every standard library.
class Random {
 public:
  [[nodiscard]] double uniform(double low, double high) {
    const double unit = static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    return low + (high - low) * unit;
  }
  [[nodiscard]] Vec3 inCube(double half) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  [[nodiscard]] Vec3 direction() {
    Vec3 v = inCube(1.0);
    while (v.norm() > 1.0 || v.norm() < 0.1) v = inCube(1.0);
    return v.normalized();
  }
  [[nodiscard]] Quat orientation() {
    return Quat(Eigen::AngleAxisd(uniform(0.0, std::numbers::pi), direction()));
  }

 private:
  std::mt19937_64 engine_{kSeed};
};

Sphere makeSphere(const Vec3& p, const Vec3& v = Vec3::Zero()) {
  Sphere sphere;
  sphere.p = p;
  sphere.v = v;
  return sphere;
}

void expectVectorNear(const Vec3& actual, const Vec3& expected, double tolerance) {
  EXPECT_LE((actual - expected).norm(), tolerance)
      << "got " << actual.transpose() << ", expected " << expected.transpose();
}

// Displacement of m x'' = -K x - B x' that starts at rest at x0, for B^2 < 4 K m.
double dampedOscillation(double x0, double mass, const SpringDamper& gains, double t) {
  const double decay = gains.damping / (2.0 * mass);
  const double frequency = std::sqrt(gains.stiffness / mass - decay * decay);
  return x0 * std::exp(-decay * t) *
         (std::cos(frequency * t) + decay / frequency * std::sin(frequency * t));
}

TEST(SphereBoxContact, FindsFacesEdgesCornersAndInside) {
  const Box box = makeUniformBox(Vec3(0.2, 0.4, 0.6), 1.0);  // half: 0.1, 0.2, 0.3
  struct Case {
    Vec3 centre, point, normal;
    double distance;  // distance of the centre from the surface, negative inside
  };
  for (const Case& c : {
           Case{{0.13, 0.1, 0.0}, {0.1, 0.1, 0.0}, Vec3::UnitX(), 0.03},
           Case{{0.0, -0.25, 0.2}, {0.0, -0.2, 0.2}, -Vec3::UnitY(), 0.05},
           Case{{0.13, 0.24, 0.1}, {0.1, 0.2, 0.1}, Vec3(0.6, 0.8, 0.0), 0.05},
           Case{{-0.11, 0.22, -0.32}, {-0.1, 0.2, -0.3}, Vec3(-1.0, 2.0, -2.0) / 3.0, 0.03},
           Case{{0.0, 0.0, 0.28}, {0.0, 0.0, 0.3}, Vec3::UnitZ(), -0.02},
           Case{{-0.07, 0.1, 0.1}, {-0.1, 0.1, 0.1}, -Vec3::UnitX(), -0.03},
       }) {
    const Contact contact = computeSphereBoxContact(makeSphere(c.centre), box);
    EXPECT_NEAR(contact.overlap, 0.01 - c.distance, 1e-15);
    expectVectorNear(contact.point, c.point, 1e-15);
    expectVectorNear(contact.normal, c.normal, 1e-14);
  }
}

// The force uses -n (v_sphere - v_material), which must equal d(overlap)/dt for any moving and
// turning box and sphere. Central differences over +-1 us err by about v^2 / d * 1e-12 / 1e-6, with
// distances d down to 1e-3 m.
TEST(SphereBoxContact, OverlapRateIsTheDerivativeOfOverlap) {
  Random random;
  RecordProperty("seed", std::to_string(kSeed));
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", case " << i);
    Box box = makeUniformBox(Vec3(0.04, 0.06, 0.1), 0.2);
    box.q = random.orientation();
    box.v = random.inCube(1.0);
    box.w = random.inCube(5.0);
    const Sphere sphere = makeSphere(random.inCube(0.05), random.inCube(1.0));
    const Contact contact = computeSphereBoxContact(sphere, box);
    if (std::abs(contact.overlap - sphere.radius) < 1e-3) continue;  // too near to the surface
    inside += contact.overlap > sphere.radius ? 1 : 0;

    const auto overlapAt = [&](double t) {
      Box moved = box;
      moved.p += t * box.v;
      const Quat turn(Eigen::AngleAxisd(t * box.w.norm(), box.w.normalized()));
      moved.q = turn * box.q;
      return computeSphereBoxContact(makeSphere(sphere.p + t * sphere.v), moved).overlap;
    };
    const Vec3 material = box.v + box.w.cross(contact.point - box.p);
    const double rate = -contact.normal.dot(sphere.v - material);
    EXPECT_NEAR((overlapAt(1e-6) - overlapAt(-1e-6)) / 2e-6, rate, 2e-3);
  }
  EXPECT_GT(inside, 50);
}

TEST(ContactForce, NeitherPullsNorActsAtADistance) {
  const SpringDamper gains{4000.0, 10.0};
  const Contact touching{.overlap = 1e-3, .normal = Vec3::UnitZ()};
  expectVectorNear(computeContactForce(gains, touching, -Vec3::UnitZ()), Vec3(0, 0, 14), 1e-12);
  EXPECT_EQ(computeContactForce(gains, touching, Vec3::UnitZ()), Vec3::Zero());
  const Contact apart{.overlap = -1e-9, .normal = Vec3::UnitZ()};
  EXPECT_EQ(computeContactForce(gains, apart, -Vec3::UnitZ()), Vec3::Zero());
}

TEST(RotationVector, TakesTheShortWay) {
  const Vec3 axis = Vec3(2.0, -1.0, 2.0) / 3.0;
  const Quat from(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  const Quat to = Quat(Eigen::AngleAxisd(1.2, axis)) * from;
  const Quat same_as_to(-to.w(), -to.x(), -to.y(), -to.z());
  expectVectorNear(computeRotationVector(from, to), 1.2 * axis, 1e-14);
  expectVectorNear(computeRotationVector(from, same_as_to), 1.2 * axis, 1e-14);
  EXPECT_EQ(computeRotationVector(Quat::Identity(), Quat::Identity()), Vec3::Zero());
}

TEST(RigidReference, LoneCouplerIsADampedOscillator) {
  RigidScene scene;
  Sphere sphere = makeSphere(Vec3(0.03, -0.02, 0.01));
  sphere.coupling = {200.0, 2.0};
  sphere.target_p = Vec3(0.01, 0.0, 0.0);
  scene.spheres = {sphere};
  const Vec3 start = sphere.p - sphere.target_p;
  for (int k = 1; k <= 100; ++k) {
    advanceScene(scene, 5e-3, 1e-4);
    const double share = dampedOscillation(1.0, sphere.mass, sphere.coupling, 5e-3 * k);
    expectVectorNear(scene.spheres[0].p, sphere.target_p + share * start, 1e-8);
  }
}

// About a principal axis the rotation vector is axis times angle, for any angle below half a turn.
// The angular coupler is then the same oscillator with J for m.
TEST(RigidReference, AngularCouplerIsADampedOscillatorOfTheAngle) {
  RigidScene scene;
  Box box = makeUniformBox(Vec3(0.04, 0.05, 0.06), 0.1);
  const Vec3 axis_B = Vec3::UnitY();
  const Quat target(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, 2.0) / 3.0));
  const double start = 2.5;  // [rad]
  box.target_q = target;
  box.q = target * Quat(Eigen::AngleAxisd(start, axis_B));
  box.angular_coupling = {0.05, 1e-4};
  scene.boxes = {box};
  for (int k = 1; k <= 100; ++k) {
    advanceScene(scene, 5e-3, 1e-4);
    const double angle = dampedOscillation(start, box.inertia.y(), box.angular_coupling, 5e-3 * k);
    expectVectorNear(computeRotationVector(target, scene.boxes[0].q), angle * (target * axis_B),
                     1e-6);
  }
}

TEST(RigidReference, FallsFreelyUnderGravityAndForce) {
  RigidScene scene;
  scene.gravity = Vec3(0.0, 0.0, -9.81);
  Box box = makeUniformBox(Vec3::Constant(0.04), 0.2);
  box.v = Vec3(0.5, 0.0, 1.0);
  box.force = Vec3(0.0, 0.4, 0.0);
  scene.boxes = {box};
  const double energy = computeEnergy(scene);
  advanceScene(scene, 0.5, 1e-3);
  expectVectorNear(scene.boxes[0].p, Vec3(0.25, 0.25, 0.5 - 9.81 / 8.0), 1e-12);
  EXPECT_NEAR(computeEnergy(scene) - 0.4 * 0.25, energy, 1e-12);
}

// The collision is elastic and head-on. Final velocities are (m1 - m2) / (m1 + m2) and 2 m1 / (m1 +
// m2) of the first sphere's. The contact lasts pi sqrt(mu / K).
TEST(RigidReference, SpheresBounceElastically) {
  RigidScene scene;
  scene.contact = {4000.0, 0.0};
  scene.spheres = {makeSphere(Vec3::Zero(), Vec3::UnitX()), makeSphere(Vec3(0.02, 0.0, 0.0))};
  scene.spheres[1].mass = 0.3;
  const double reduced_mass = 0.1 * 0.3 / 0.4;
  const double contact_time = std::numbers::pi * std::sqrt(reduced_mass / 4000.0);

  advanceScene(scene, contact_time / 2.0, 1e-6);  // both have the common speed, fully pressed
  EXPECT_NEAR(scene.spheres[0].v.x(), 0.25, 1e-9);
  EXPECT_NEAR(scene.spheres[1].v.x(), 0.25, 1e-9);
  EXPECT_NEAR(computeContactForceOnSphere(scene, 1).x(), std::sqrt(reduced_mass * 4000.0), 1e-6);
  EXPECT_NEAR(computeContactForceOnSphere(scene, 0).x(), -std::sqrt(reduced_mass * 4000.0), 1e-6);

  advanceScene(scene, contact_time, 1e-6);
  EXPECT_NEAR(scene.spheres[0].v.x(), -0.5, 1e-8);
  EXPECT_NEAR(scene.spheres[1].v.x(), 0.5, 1e-8);
}

// The axis of a free symmetric top circles the angular momentum H at |H| / I1. The top turns about
// its own axis at (I1 - I3) / I1 w3.
TEST(RigidReference, SymmetricTopPrecesses) {
  RigidScene scene;
  Box top = makeUniformBox(Vec3(0.06, 0.06, 0.02), 0.2);
  top.q = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitY()));
  top.w = top.q * Vec3(3.0, 0.0, 20.0);
  scene.boxes = {top};
  const Vec3 spin = computeSpin(top);
  const double precession = spin.norm() / top.inertia.x();
  const double own_turn = (top.inertia.x() - top.inertia.z()) / top.inertia.x() * 20.0;
  for (int k = 1; k <= 20; ++k) {
    advanceScene(scene, 0.05, 1e-4);
    const double t = 0.05 * k;
    const Quat expected = Quat(Eigen::AngleAxisd(precession * t, spin.normalized())) * top.q *
                          Quat(Eigen::AngleAxisd(own_turn * t, Vec3::UnitZ()));
    EXPECT_LE(computeRotationVector(expected, scene.boxes[0].q).norm(), 1e-8);
    expectVectorNear(computeSpin(scene.boxes[0]), spin, 1e-15);
  }
}

// Spheres fly at a turning box from all sides, without damping.
TEST(RigidReference, ElasticImpactsKeepEnergyAndMomenta) {
  Random random;
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", case " << i);
    RigidScene scene;
    scene.contact = {4000.0, 0.0};
    Box box = makeUniformBox(Vec3(0.03, 0.04, 0.06), 0.2);
    box.q = random.orientation();
    box.v = random.inCube(0.1);
    box.w = random.inCube(10.0);
    scene.boxes = {box};
    for (int s = 0; s < 2; ++s) {
      const Vec3 start = 0.06 * random.direction();
      scene.spheres.push_back(makeSphere(start, (random.inCube(0.02) - start) * 10.0));
    }
    const double energy = computeEnergy(scene);
    const Vec3 momentum = computeMomentum(scene);
    const Vec3 angular_momentum = computeAngularMomentum(scene);
    double stored = 0.0;  // largest energy in springs, equal to the kinetic energy lost [J]
    for (int k = 0; k < 60; ++k) {
      advanceScene(scene, 2e-3, 1e-5);
      RigidScene springless = scene;
      springless.contact.stiffness = 0.0;
      stored = std::max(stored, energy - computeEnergy(springless));
    }
    EXPECT_GT(stored, 1e-4) << "nothing touched";
    EXPECT_NEAR(computeEnergy(scene), energy, 1e-6 * energy);
    expectVectorNear(computeMomentum(scene), momentum, 1e-13);
    expectVectorNear(computeAngularMomentum(scene), angular_momentum, 1e-12);
  }
}

TEST(RigidReference, ContactDampingOnlyTakesEnergy) {
  RigidScene scene;
  scene.contact = {4000.0, 5.0};
  Box box = makeUniformBox(Vec3::Constant(0.04), 0.2);
  box.w = Vec3(0.0, 0.0, 4.0);
  scene.boxes = {box};
  scene.spheres = {makeSphere(Vec3(-0.035, 0.012, 0.0), Vec3(1.0, 0.0, 0.2))};
  const double start = computeEnergy(scene);
  double energy = start;
  for (int k = 0; k < 100; ++k) {
    advanceScene(scene, 5e-4, 5e-6);
    EXPECT_LE(computeEnergy(scene), energy + 1e-12);
    energy = computeEnergy(scene);
  }
  EXPECT_LT(energy, 0.95 * start);
}

TEST(RigidReference, ErrorFallsWithTheFourthPowerOfTheStep) {
  RigidScene start;
  Box box = makeUniformBox(Vec3(0.03, 0.04, 0.06), 0.1);
  box.w = Vec3(6.0, -4.0, 9.0);
  box.angular_coupling = {0.02, 1e-5};
  box.coupling = {200.0, 1.0};
  box.p = Vec3(0.01, 0.0, 0.0);
  start.boxes = {box};
  const auto runWithStep = [&](double step) {
    RigidScene scene = start;
    advanceScene(scene, 0.2, step);
    return scene.boxes[0];
  };
  const Box exact = runWithStep(1e-5);
  const auto turnError = [&](double step) {
    return computeRotationVector(exact.q, runWithStep(step).q).norm();
  };
  // Combines position and velocity, because either alone passes through zero as the box swings.
  const double frequency = std::sqrt(box.coupling.stiffness / box.mass);
  const auto shiftError = [&](double step) {
    const Box rough = runWithStep(step);
    return std::hypot((exact.p - rough.p).norm(), (exact.v - rough.v).norm() / frequency);
  };
  EXPECT_NEAR(std::log2(turnError(2e-3) / turnError(1e-3)), 4.0, 0.3);
  EXPECT_NEAR(std::log2(shiftError(2e-3) / shiftError(1e-3)), 4.0, 0.3);
}

TEST(RigidReference, PrescribedAndDrivenSpheresPushWithoutBeingPushed) {
  for (const Motion motion : {Motion::kPrescribed, Motion::kDriven}) {
    RigidScene scene;
    scene.contact = {4000.0, 1.0};
    scene.boxes = {makeUniformBox(Vec3::Constant(0.04), 0.2)};
    scene.spheres = {makeSphere(Vec3(-0.03, 0.0, 0.0), Vec3(0.2, 0.0, 0.0))};
    scene.spheres[0].motion = motion;
    advanceScene(scene, 0.05, 1e-5);
    expectVectorNear(scene.spheres[0].p, Vec3(-0.02, 0.0, 0.0), 1e-14);
    EXPECT_GT(scene.boxes[0].v.x(), 0.2);  // it bounces off
  }
}

TEST(RigidReference, RefusesBodiesWithoutMass) {
  RigidScene scene;
  scene.spheres = {Sphere{.mass = 0.0}};
  EXPECT_THROW(advanceScene(scene, 1e-3, 1e-5), std::invalid_argument);
  scene.spheres.clear();
  scene.boxes = {makeUniformBox(Vec3::Zero(), 1.0)};
  EXPECT_THROW(advanceScene(scene, 1e-3, 1e-5), std::invalid_argument);
  scene.boxes.clear();
  EXPECT_THROW(advanceScene(scene, 1e-3, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace tandem::reference
