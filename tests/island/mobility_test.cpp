// Bounds of how fast a push moves a body's surface; steps follow from them.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "coordination/src/geometry/separation.h"
#include "coordination/src/island/island.h"
#include "coordination/src/island/island_model.h"

namespace tandem {
namespace {

/// Velocity along a push per impulse, where a sphere's centre is at `c_B` [1/kg].
double computeVelocityPerImpulse(const ModelBody& body, const Vec3& c_B, const Quat& q_WB) {
  const Separation found = separate(PlainVec(c_B), body.settings.shape);
  const Vec3 n_B = found.n.toVec3();
  const Vec3 turn_W = q_WB * (c_B - found.distance * n_B).cross(n_B);
  const Vec3 felt_B = q_WB.conjugate() * body.factors.turn_root_W.cwiseProduct(turn_W);
  return body.inverse_mass + felt_B.dot(body.inverse_inertia_B.cwiseProduct(felt_B));
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    const double part = static_cast<double>(engine_() >> 11) * 0x1p-53;
    return low + part * (high - low);
  }
  Vec3 vector(double low, double high) {
    return {(*this)(low, high), (*this)(low, high), (*this)(low, high)};
  }

 private:
  std::mt19937_64 engine_;
};

TEST(Mobility, OfABoxIsThatOfItsFastestPush) {
  constexpr std::uint64_t kSeed = 7;
  Draw draw(kSeed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", box " << i);
    IslandBody settings;
    const Vec3 half = draw.vector(0.005, 0.1);  // [m]
    settings.shape = Box{half};
    settings.mass = draw(0.05, 2.0);
    settings.inertia_B = settings.mass * draw.vector(0.1, 1.0).cwiseProduct(half.cwiseAbs2());
    if (i % 3 == 1) settings.angular_factor = draw.vector(0.0, 1.0);
    const ModelBody body = ModelBody::make(settings, false);
    double fastest = 0.0;
    for (int k = 0; k < 500; ++k) {
      // On faces, edges and corners, and inside.
      Vec3 c_B = half.cwiseProduct(draw.vector(-1.3, 1.3));
      for (int axis = 0; axis < 3; ++axis)
        if (draw(0.0, 1.0) < 0.3) c_B[axis] = std::copysign(half[axis], c_B[axis]);
      const Quat q_WB(Eigen::AngleAxisd(draw(0.0, 3.0), draw.vector(-1.0, 1.0).normalized()));
      fastest = std::max(fastest, computeVelocityPerImpulse(body, c_B, q_WB));
    }
    EXPECT_LE(fastest, body.mobility * (1.0 + 1e-12));
    if (i % 3 != 1) {
      EXPECT_GT(fastest, 0.95 * body.mobility);
    }
  }
}

// Spring and both bodies swing at 316 rad/s. A step of 0.36 rad is longer than a tick.
TEST(Mobility, LetsASphereOnACubeTakeATickInOneStep) {
  constexpr double kHalf = 0.02, kRadius = 0.01, kMass = 0.1;  // [m], [kg]
  Island island(IslandSettings{});
  IslandBody cube, ball;
  cube.shape = Box{Vec3::Constant(kHalf)};
  cube.mass = ball.mass = kMass;
  cube.inertia_B = Vec3::Constant(kMass * kHalf * kHalf / 1.5);
  ball.shape = Sphere{kRadius};
  ball.start.p_W.x() = -kHalf - kRadius + 1e-3;
  const BodyIndex b = island.addBody(ball);
  island.addContact(b, island.addBody(cube), {2000.0, 0.0});
  island.addCoupler(b, {{2000.0, 10.0}, {}});
  island.prepare();
  for (int tick = 0; tick < 3; ++tick) island.advance(1e-3);
  EXPECT_EQ(island.counters().integrated_steps, 3U);
  EXPECT_EQ(island.counters().rejected_steps, 0U);
}

}  // namespace
}  // namespace tandem
