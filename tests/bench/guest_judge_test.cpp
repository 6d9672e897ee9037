// The judge of `tandem bench guest` allows for joints that are torn open, and twins that started
// a little differently.

#include <cmath>

#include <gtest/gtest.h>

#include "bench/guest/guest_energy.h"
#include "bench/guest/guest_shaken.h"
#include "bench/guest/guest_site.h"
#include "bench/guest/guest_tears.h"
#include "bench/guest/guest_verdict.h"
#include "bridge/bullet_rig.h"

namespace tandem::demos::bench {
namespace {

using test::BulletRig;
using test::byWidth;

constexpr double kMass = 0.5, kOther = 0.2;  // [kg]
constexpr double kWay = 0.03;                // by which a joint is open [m]

/// Two cubes on a pin, `kWay` apart.
struct TornPin {
  BulletRig rig;
  btRigidBody &a, &b;
  btPoint2PointConstraint pin;

  TornPin()
      : a(rig.addCube(kMass)),
        b(rig.addCube(kOther, 0.02, Vec3(0.0, kWay, 0.0))),
        pin(a, b, btVector3(0, 0, 0), btVector3(0, 0, 0)) {}
};

TEST(GuestTears, APinGivesTheEnergyOfItsWay) {
  TornPin torn;
  const double give = 1.0 / kMass + 1.0 / kOther;
  const double unit = kWay * kWay / (2.0 * give);
  const double near = byWidth(1e-12, 1e-6) * unit;
  EXPECT_NEAR(computeTear(torn.pin, {}), unit, near);
  // At 240 Hz Bullet closes a fifth of it in a step.
  const double speed = 0.2 * 240.0;
  EXPECT_NEAR(computeTear(torn.pin, {240.0, 0.2}), speed * speed * unit, speed * speed * near);
  // A host sees twice the mass of a copy that is shared by two: its motion counts twice.
  const double impulse = kWay / give;
  EXPECT_NEAR(computeTear(torn.pin, {}, 2.0),
              0.5 * impulse * impulse * (2.0 / kMass + 1.0 / kOther), 2.0 * near);
  torn.pin.setEnabled(false);
  EXPECT_EQ(computeTear(torn.pin, {}), 0.0);
}

TEST(GuestTears, APinToTheWorldMovesOneBody) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  btPoint2PointConstraint pin(cube, btVector3(0, 0, 0));
  EXPECT_EQ(computeTear(pin, {}), 0.0);
  cube.setWorldTransform(toBullet(Vec3(kWay, 0.0, 0.0), Quat::Identity()));
  EXPECT_NEAR(computeTear(pin, {}), 0.5 * kMass * kWay * kWay, byWidth(1e-15, 1e-9));
}

// A limit stores energy once it is exceeded, and a motor none.
TEST(GuestTears, OfAHingeAreThoseOfItsLimits) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  btHingeConstraint hinge(cube, btVector3(0, 0, 0), btVector3(0, 0, 1));
  constexpr btScalar kSoftness = btScalar(0.9), kBias = 1;
  hinge.setLimit(btScalar(-0.5), btScalar(0.5), kSoftness, kBias);
  hinge.enableAngularMotor(true, 3, 1);
  EXPECT_NEAR(computeTear(hinge, {}), 0.0, byWidth(1e-24, 1e-12));
  cube.setWorldTransform(toBullet(Vec3::Zero(), test::turn(0.7, Vec3::UnitZ())));
  cube.updateInertiaTensor();
  const double inertia = 1.0 / static_cast<double>(cube.getInvInertiaDiagLocal().z());
  EXPECT_NEAR(computeTear(hinge, {}), 0.5 * inertia * 0.2 * 0.2, 1e-3 * inertia * 0.2 * 0.2);
}

/// A case of one site, nothing of which moves but by weight.
GuestCase drawCase() {
  for (std::uint64_t index = 0;; ++index) {
    GuestCase one = drawGuestCase(11, index);
    if (one.sites != 1 || one.shared == 0 || one.joints > 0 || !one.arms.empty() || one.is_planar ||
        one.has_large_margins)
      continue;
    one.acts.clear();
    return one;
  }
}

TEST(ShakenTwin, StartsAsItsNumberSays) {
  const GuestCase one = drawCase();
  const ShakenTwin first(one, 3), again(one, 3), other(one, 4);
  const GuestWorld still(one);
  bool differs = false;
  for (std::size_t b = 0; b < one.bodies.size(); ++b) {
    const auto speedIn = [&](const GuestWorld& world) {
      return fromBullet(world.bodies()[b]->rigid->getLinearVelocity());
    };
    EXPECT_EQ(speedIn(first.world(0)), speedIn(again.world(0)));
    const Vec3 shake = speedIn(first.world(0)) - speedIn(still);
    EXPECT_LE(shake.cwiseAbs().maxCoeff(), 0.01 + 4.905 * one.step() + 1e-9);
    differs |= speedIn(first.world(0)) != speedIn(other.world(0));
  }
  EXPECT_TRUE(differs);
}

// Bodies that happen to start towards +x are dropped below the floor, and get 1 m/s.
TEST(ShakenTwin, DoesWhatTheJournalSays) {
  const GuestCase one = drawCase();
  const auto drop = [](GuestWorld& world) {
    btRigidBody& rigid = *world.bodies()[0]->rigid;
    if (!(rigid.getLinearVelocity().x() > 0)) return;
    world.put(0, {toBullet(Vec3(0.0, 0.0, -0.5), Quat::Identity()), btVector3(1, 0, 0),
                  btVector3(0, 0, 0)});
  };
  GuestJournal journal(1);
  journal[0].after.emplace_back(drop);
  ShakenTwins twins(one);
  twins.advance({&journal});
  EXPECT_TRUE(twins.hasFallen(0, 0));
  EXPECT_FALSE(twins.hasFallen(0, 1));
  int fallen = 0;
  for (std::uint64_t number = 0; number < 16; ++number) {
    ShakenTwin twin(one, number);
    twin.advance({&journal}, 1);
    fallen += twin.hasFallen(0, 0) ? 1 : 0;
    EXPECT_LE(twin.gained(), twins.mostGained());
  }
  EXPECT_GT(fallen, 0);
  EXPECT_LT(fallen, 16);
}

// No shaken twin does what only the site's world does.
TEST(GuestVerdict, SeesABodyThatFellAndEnergyFromNowhere) {
  const GuestCase one = drawCase();
  for (const bool falls : {true, false}) {
    std::vector<std::unique_ptr<GuestSite>> sites;
    sites.push_back(std::make_unique<GuestSite>(one, 0));
    GuestVerdict verdict(one, sites);
    sites[0]->step(0.0);
    EXPECT_FALSE(verdict.look());
    const Vec3 p_W = falls ? Vec3(0.0, 0.0, -0.2) : Vec3(0.0, 0.0, 0.2);
    const double speed = falls ? 0.0 : 50.0;
    sites[0]->world().put(0, {toBullet(p_W, Quat::Identity()),
                              btVector3(static_cast<btScalar>(speed), 0, 0), btVector3(0, 0, 0)});
    const auto found = verdict.look();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->failure, falls ? GuestFailure::kFell : GuestFailure::kEnergy) << found->text;
    sites[0]->end();
  }
}

// Bullet presses two bodies at one place apart in any direction.
TEST(GuestVerdict, ExcusesABodyWhoseTwinIsWedged) {
  const GuestCase one = drawCase();
  std::vector<std::unique_ptr<GuestSite>> sites;
  sites.push_back(std::make_unique<GuestSite>(one, 0));
  GuestSite& site = *sites[0];
  GuestVerdict verdict(one, sites);
  for (GuestWorld* world : {&site.world(), &site.twin()}) world->put(0, world->motionOf(1));
  site.step(0.0);
  EXPECT_FALSE(verdict.look());
  site.world().put(0, {toBullet(Vec3(0.0, 0.0, -0.2), Quat::Identity()), btVector3(0, 0, 0),
                       btVector3(0, 0, 0)});
  EXPECT_FALSE(verdict.look());
  site.end();
}

}  // namespace
}  // namespace tandem::demos::bench
