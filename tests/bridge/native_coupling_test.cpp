// Couplers made of Bullet's own means, against closed forms.

#include "bullet_bridge/src/native/native_coupling.h"

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;

constexpr double kMass = 0.1;             // [kg]
constexpr double kStart = 0.01;           // [m], or [rad]
const CouplerGains kGains{2000.0, 10.0};  // [N/m, N s/m]

/// m x'' + B x' + K x = 0 from rest at x0, underdamped.
double freeDecay(double mass, const CouplerGains& gains, double x0, double t) {
  const double decay = 0.5 * gains.damping / mass;
  const double w = std::sqrt(gains.stiffness / mass - decay * decay);
  return x0 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
}

/// Largest error of a cube on its coupler, released at kStart, over 0.5 s.
double releaseError(NativeCouplerKind kind, double rate) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass, 0.02, Vec3(kStart, 0, 0));
  cube.setActivationState(DISABLE_DEACTIVATION);
  const auto coupler = makeNativeCoupler(kind, rig.world, cube, {kGains, {}});
  double error = 0.0;
  for (int i = 1; i <= 0.5 * rate; ++i) {
    coupler->pull({}, 1.0 / rate);
    rig.step(1.0 / rate);
    const double x = cube.getCenterOfMassPosition().x();
    if (!std::isfinite(x)) return x;
    error = std::max(error, std::abs(x - freeDecay(kMass, kGains, kStart, i / rate)));
  }
  return error;
}

class ExplicitCoupler : public ::testing::TestWithParam<NativeCouplerKind> {};

// Semi-implicit Euler is first order: 0.64 mm at 1 kHz, a quarter of it at four times the rate.
TEST_P(ExplicitCoupler, ConvergesToTheClosedFormInFirstOrder) {
  EXPECT_NEAR(releaseError(GetParam(), 1000.0), 0.640e-3, 0.005e-3);
  EXPECT_NEAR(releaseError(GetParam(), 4000.0), 0.157e-3, 0.005e-3);
  EXPECT_LT(releaseError(GetParam(), 16000.0), 0.045e-3);
}

// w dt = 2.4 at 60 Hz: beyond the step limit of computeInjectionStepLimit().
TEST_P(ExplicitCoupler, DivergesWhereItsStepIsTooLong) {
  EXPECT_FALSE(releaseError(GetParam(), 60.0) < 1.0);
}

TEST_P(ExplicitCoupler, DampsTowardsTheTargetsVelocity) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  cube.setActivationState(DISABLE_DEACTIVATION);
  const auto coupler = makeNativeCoupler(GetParam(), rig.world, cube, {{0.0, 10.0}, {}});
  RigidState target;
  target.v_W = Vec3(0.2, 0, 0);
  coupler->pull(target, 1e-3);
  rig.step(1e-3);
  EXPECT_NEAR(cube.getLinearVelocity().x(), 1e-3 * 10.0 * 0.2 / kMass, byWidth(1e-12, 1e-7));
}

TEST_P(ExplicitCoupler, TurnsByItsAngularGains) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass, 0.02, Vec3::Zero(), test::turn(kStart, Vec3(0, 0, 1)));
  cube.setActivationState(DISABLE_DEACTIVATION);
  const double inertia = static_cast<double>(cube.getLocalInertia().z());
  const CouplerGains angular{2000.0 * inertia / kMass, 10.0 * inertia / kMass};
  const auto coupler = makeNativeCoupler(GetParam(), rig.world, cube, {{}, angular});
  constexpr double kRate = 16000.0;  // [Hz]
  double error = 0.0;
  for (int i = 1; i <= 0.1 * kRate; ++i) {
    coupler->pull({}, 1.0 / kRate);
    rig.step(1.0 / kRate);
    const double angle = 2.0 * std::asin(fromBullet(cube.getOrientation()).z());
    error = std::max(error, std::abs(angle - freeDecay(inertia, angular, kStart, i / kRate)));
  }
  EXPECT_LT(error, 0.045e-3);  // the same bound as for the linear part above
}

INSTANTIATE_TEST_SUITE_P(Kinds, ExplicitCoupler,
                         ::testing::Values(NativeCouplerKind::kImpulse,
                                           NativeCouplerKind::kSpring6Dof));

// Ten iterations leave CFM^10 = 0.14^10 of the step's impulse: 3e-9.
TEST(PointToPoint, IsImplicitEulerAtLongSteps) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass, 0.02, Vec3(kStart, 0, 0));
  const auto coupler =
      makeNativeCoupler(NativeCouplerKind::kPointToPoint, rig.world, cube, {kGains, {}});
  const double dt = 1.0 / 60.0, K = kGains.stiffness, B = kGains.damping;
  double x = kStart, v = 0.0;
  for (int i = 0; i < 10; ++i) {
    coupler->pull({}, dt);
    rig.step(dt);
    v = (v - dt * K / kMass * x) / (1.0 + dt * B / kMass + dt * dt * K / kMass);
    x += dt * v;
    EXPECT_NEAR(cube.getCenterOfMassPosition().x(), x, byWidth(1e-9, 1e-6)) << "step " << i;
  }
}

// The CFM grows as 1/dt: 1.3 at 240 Hz, 8 at 1 kHz. Above 1 Bullet's iteration diverges. The NaN
// must be visible: nothing hides it.
TEST(PointToPoint, DivergesAtShortSteps) {
  for (const double rate : {240.0, 1000.0})
    EXPECT_FALSE(releaseError(NativeCouplerKind::kPointToPoint, rate) < 1e6) << rate;
}

TEST(NativeCoupler, RefusesBadGains) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  EXPECT_THROW(static_cast<void>(makeNativeCoupler(NativeCouplerKind::kSpring6Dof, rig.world, cube,
                                                   {{-1.0, 0.0}, {}})),
               std::invalid_argument);
  EXPECT_EQ(rig.world.getNumConstraints(), 0);
}

TEST(NativeCoupler, TakesItsConstraintAwayAgain) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  for (const auto kind : {NativeCouplerKind::kSpring6Dof, NativeCouplerKind::kPointToPoint}) {
    {
      const auto coupler = makeNativeCoupler(kind, rig.world, cube, {kGains, {}});
      EXPECT_EQ(rig.world.getNumConstraints(), 1);
    }
    EXPECT_EQ(rig.world.getNumConstraints(), 0);
  }
}

}  // namespace
}  // namespace tandem
