// Rows of bodies that a kinematic ram jams, drawn by chance. No force solves a jam: its bodies must
// not be thrown harder than Bullet throws them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::kGravity;
using test::Random;

/// One to three balls, boxes and capsules in a row on a floor, before a wall or free, and a capsule
/// that drives into them.
class DrawnJam {
 public:
  DrawnJam(std::uint64_t seed, bool is_planar) : random_(seed) {
    const double friction = std::sqrt(random_.uniform(0.0, 1.0));
    const auto rub = [&](btRigidBody& body) -> btRigidBody& {
      body.setFriction(static_cast<btScalar>(friction));
      return body;
    };
    rub(rig_.addBody(rig_.makeShape<btBoxShape>(toBullet(Vec3(2.0, 2.0, 0.1))), 0.0,
                     Vec3(0.0, 0.0, -0.1)));
    double x = 0.0;
    const int count = 1 + random_.below(3);
    for (int i = 0; i < count; ++i) {
      const double half = random_.uniform(0.015, 0.03);
      const double mass = random_.logUniform(0.03, 0.5);
      btCollisionShape& shape = drawShape(half);
      bodies_.push_back(&rub(rig_.addBody(shape, mass, Vec3(x + half, 0.0, half))));
      btRigidBody& body = *bodies_.back();
      body.setSleepingThresholds(0, 0);
      if (is_planar) {
        body.setLinearFactor(btVector3(1, 0, 1));
        body.setAngularFactor(btVector3(0, 1, 0));
      }
      x += 2.0 * half + random_.uniform(0.0, 0.002);
    }
    if (random_.below(2) == 0)
      rub(rig_.addBody(rig_.makeShape<btBoxShape>(toBullet(Vec3(0.05, 0.2, 0.2))), 0.0,
                       Vec3(x + 0.05, 0.0, 0.0)));
    pace_ = random_.logUniform(0.1, 1.0);
    const double radius = random_.uniform(0.01, 0.03);
    const double height = random_.uniform(0.3, 1.5) * radius;
    const double across = random_.uniform(-0.01, 0.01);
    start_ = Vec3(-1.05 * radius, across, height);
    const bool lies = random_.below(2) == 0;
    btCollisionShape& upright = rig_.makeShape<btCapsuleShape>(static_cast<btScalar>(radius),
                                                               static_cast<btScalar>(radius));
    turn_ = lies ? test::turn(0.5 * M_PI, Vec3::UnitX()) : Quat::Identity();
    ram_ = &rub(rig_.addBody(upright, 0.0, start_, turn_));
    rig_.world.removeRigidBody(ram_);
    ram_->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    ram_->setActivationState(DISABLE_DEACTIVATION);
    rig_.world.addRigidBody(ram_);
  }

  /// Speed of the fastest body within 0.15 s [m/s].
  double run(double rate) {
    SiteSettings settings;
    settings.peers = 1;
    settings.contact = {1000.0, 5.0};
    settings.host_step = 1.0 / rate;
    test::FakeDevice device(Vec3(0.0, 0.0, 10.0));
    Site site(settings, rig_.world, device);
    site.share(*bodies_.front());
    double fastest = 0.0;
    for (int i = 1; i <= 0.15 * rate; ++i) {
      const Vec3 p_W = start_ + pace_ * i / rate * Vec3::UnitX();
      ram_->setWorldTransform(toBullet(p_W, turn_));
      rig_.step(1.0 / rate);
      for (const btRigidBody* body : bodies_)
        fastest = std::max(fastest, fromBullet(body->getLinearVelocity()).norm());
    }
    return fastest;
  }

 private:
  btCollisionShape& drawShape(double half) {
    const auto size = static_cast<btScalar>(half);
    switch (random_.below(3)) {
      case 0:
        return rig_.makeShape<btSphereShape>(size);
      case 1:
        return rig_.makeShape<btBoxShape>(btVector3(size, size, size));
      default:
        return rig_.makeShape<btCapsuleShape>(size, btScalar(0.5) * size);
    }
  }

  Random random_;
  test::BulletRig rig_{Vec3(0.0, 0.0, -kGravity)};
  std::vector<btRigidBody*> bodies_;
  btRigidBody* ram_ = nullptr;
  Vec3 start_ = Vec3::Zero();
  Quat turn_ = Quat::Identity();
  double pace_ = 0.0;
};

/// Host's rate [Hz]; whether bodies keep a plane.
class DrawnJams : public ::testing::TestWithParam<std::tuple<double, bool>> {};

// These were the worst of 250 seeds. Exact answers threw them at up to 300 m/s, and forces held
// from such answers faster. Bare Bullet throws bodies of such jams at up to 42 m/s at 1 kHz. Jams
// are chaotic: of 250 seeds at each rate the worst are thrown at 10 to 27 m/s, and one in float
// at 54.
TEST_P(DrawnJams, ThrowNothingHarderThanBullet) {
  const auto [rate, is_planar] = GetParam();
  for (const std::uint64_t seed : {4, 13, 18, 48, 51, 54, 58, 136})
    EXPECT_LT(DrawnJam(seed, is_planar).run(rate), 25.0) << "seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(Hosts, DrawnJams,
                         ::testing::Combine(::testing::Values(60.0, 240.0, 1000.0),
                                            ::testing::Bool()));

}  // namespace
}  // namespace tandem
