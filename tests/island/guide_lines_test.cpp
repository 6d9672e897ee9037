// Many spheres push one cube in a guide, side by side on parallel lines.

#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kRadius = 0.01, kHalf = 0.04;
constexpr double kCubeMass = 0.1, kSphereMass = 0.1;  // [kg]
const CouplerGains kContact{4000.0, 1.0};             // [N/m, N s/m]

/// A cube with spheres on its face at -x, just touching, each on a line of its own.
struct Row {
  explicit Row(const std::vector<double>& lines) : island(makeSettings()) {
    IslandBody box;
    box.shape = Box{Vec3::Constant(kHalf)};
    box.mass = kCubeMass;
    box.inertia_B = Vec3::Constant(kCubeMass * 4.0 * kHalf * kHalf / 6.0);
    cube = island.addBody(box);
    for (const double line : lines) addSphere({-kHalf - kRadius, line, 0.0});
    island.prepare();
  }

  static IslandSettings makeSettings() {
    IslandSettings settings;
    settings.guide = Vec3::UnitX();
    return settings;
  }
  void addSphere(const Vec3& p_W) {
    IslandBody sphere;
    sphere.shape = Sphere{kRadius};
    sphere.mass = kSphereMass;
    sphere.start.p_W = p_W;
    spheres.push_back(island.addBody(sphere));
    island.addContact(spheres.back(), cube, kContact);
    if (spheres.size() > 1) island.addContact(spheres.front(), spheres.back(), kContact);
  }
  void run(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kPeriod) island.advance(kPeriod);
  }
  [[nodiscard]] double depth(BodyIndex sphere) const {
    return island.state(sphere).p_W.x() + kHalf + kRadius - island.state(cube).p_W.x();
  }

  Island island;
  BodyIndex cube = 0;
  std::vector<BodyIndex> spheres;
};

// Five contacts are too many for maps. All move alike, as one mass under the sum of all forces.
TEST(GuideLines, FiveSpheresPushOneCube) {
  Row row({-0.045, -0.024, -0.003, 0.018, 0.039});
  const double force = 0.3;  // on each sphere [N]
  for (const BodyIndex sphere : row.spheres)
    row.island.setExternalWrench(sphere, Vec3(force, 0, 0), Vec3::Zero());
  row.run(1.0);
  const double speed = 5.0 * force / (kCubeMass + 5.0 * kSphereMass) * 1.0;
  EXPECT_NEAR(row.island.state(row.cube).v_W.x(), speed, 0.02 * speed);
  double momentum = kCubeMass * row.island.state(row.cube).v_W.x();
  for (const BodyIndex sphere : row.spheres) {
    momentum += kSphereMass * row.island.state(sphere).v_W.x();
    EXPECT_NEAR(row.depth(sphere), row.depth(row.spheres[0]), 1e-12);
  }
  EXPECT_NEAR(momentum, 5.0 * force * 1.0, 1e-9);
}

// A sphere beside the cube passes it, and passes a sphere that stands at the same place along it.
TEST(GuideLines, BodiesOnParallelLinesPassEachOther) {
  Row row({0.0, 0.06});
  RigidState fast = row.island.state(row.spheres[1]);
  fast.v_W = Vec3(0.5, 0, 0);
  row.island.setState(row.spheres[1], fast);
  row.run(0.5);
  EXPECT_NEAR(row.island.state(row.spheres[1]).p_W.x(), -kHalf - kRadius + 0.25, 1e-12);
  EXPECT_EQ(row.island.state(row.cube).p_W, Vec3::Zero());
  EXPECT_EQ(row.island.state(row.spheres[0]).v_W, Vec3::Zero());
}

// The sphere at the front is nearer to the cube than the one behind, but on another line.
TEST(GuideLines, ASphereOnAnotherLineDoesNotShield) {
  Row row({-0.02});
  row.addSphere({-kHalf - kRadius - 0.01, 0.02, 0.0});
  row.island.prepare();
  RigidState fast = row.island.state(row.spheres[1]);
  fast.v_W = Vec3(0.5, 0, 0);
  row.island.setState(row.spheres[1], fast);
  row.run(0.2);
  EXPECT_GT(row.island.state(row.cube).v_W.x(), 0.4);
}

// With more contacts than have maps, the power series gives the same hit.
TEST(GuideLines, ManyContactsAreAsExactAsFew) {
  Row few({-0.02, 0.02}), many({-0.02, 0.02});
  for (const double line : {-0.045, 0.0, 0.045})
    many.addSphere({-kHalf - kRadius - 1.0, line, 0.0});  // far away, but a contact each
  many.island.prepare();
  for (Row* row : {&few, &many}) {
    RigidState fast = row->island.state(row->spheres[0]);
    fast.v_W = Vec3(0.5, 0, 0);
    row->island.setState(row->spheres[0], fast);
    row->run(0.2);
  }
  EXPECT_NEAR(many.island.state(many.cube).v_W.x(), few.island.state(few.cube).v_W.x(), 1e-9);
  EXPECT_NEAR(many.island.state(many.cube).p_W.x(), few.island.state(few.cube).p_W.x(), 1e-10);
}

}  // namespace
}  // namespace tandem
