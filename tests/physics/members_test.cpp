// The number of sites follows who is there: masses, momentum, gains and forces.
#include <gtest/gtest.h>

#include "physics/member_hosts.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::MemberHosts;
using test::NeighbourScene;

/// Expects that each site that is there has its part of the mass.
void expectShares(const MemberHosts& hosts) {
  const int present = hosts.countPresent();
  for (int i = 0; i < hosts.count(); ++i) {
    if (!hosts.scenes[i]) continue;
    EXPECT_EQ(hosts.scenes[i]->site->memberCount(), present) << i;
    EXPECT_NEAR(hosts.massAt(i), MemberHosts::kMass / present, 1e-7) << i;
  }
}

TEST(Members, ShareTheMassAmongThoseWhoAreThere) {
  MemberHosts hosts(4);
  for (int i = 0; i < 4; ++i) {
    hosts.come(i);
    hosts.run(0.3);
    expectShares(hosts);
  }
  hosts.leave(1);
  hosts.run(0.3);
  expectShares(hosts);
  hosts.vanish(0);
  hosts.run(0.5);
  EXPECT_EQ(hosts.scenes[2]->site->memberCount(), 3);
  hosts.run(1.0);
  expectShares(hosts);
  btRigidBody& cube = *hosts.scenes[2]->cube;
  hosts.scenes[2]->site.reset();
  EXPECT_NEAR(1.0 / static_cast<double>(cube.getInvMass()), MemberHosts::kMass, 1e-7);
}

// Without couplers nothing holds the copies back: each keeps its speed, whoever comes and goes.
TEST(Members, KeepTheMomentumOfTheWhole) {
  MemberHosts hosts(4);
  hosts.settings.coordination = {0.0, 0.0};
  const Vec3 v_W(0.3, -0.1, 0.2);
  hosts.come(1, Vec3::Zero(), v_W);
  hosts.run(0.5);
  const auto expectMomentum = [&] {
    expectShares(hosts);
    Vec3 momentum = Vec3::Zero();
    for (int i = 0; i < hosts.count(); ++i)
      if (hosts.scenes[i]) momentum += hosts.massAt(i) * hosts.velocityAt(i);
    EXPECT_LT((momentum - MemberHosts::kMass * v_W).norm(), 2e-7);
  };
  expectMomentum();
  for (const int newcomer : {0, 2, 3}) {
    hosts.come(newcomer, Vec3(1.0, 0.0, 0.0));  // elsewhere, and at rest
    hosts.run(0.5);
    expectMomentum();
    EXPECT_LT(hosts.computeSpread(), 3.0 * hosts.delay * v_W.norm());
  }
  hosts.leave(1);
  hosts.run(0.5);
  expectMomentum();
  hosts.vanish(0);
  hosts.run(1.5);
  expectMomentum();
}

// A newcomer's copy is taken to the others': nobody who was there notices a pull.
TEST(Members, LeaveTheObjectsOfTheOthersInPlace) {
  for (const bool puts : {true, false}) {
    MemberHosts hosts(3);
    hosts.settings.puts_reset_objects = puts;
    hosts.come(1, Vec3(0.0, 0.0, 0.1));
    hosts.come(2, Vec3(0.0, 0.0, 0.1));
    hosts.run(1.0);
    double farthest = 0.0;
    const Vec3 place_W = hosts.positionAt(1);
    hosts.come(0, Vec3(0.0, 0.4, 0.0));
    hosts.run(4.0, [&] {
      for (const int old : {1, 2})
        farthest = std::max(farthest, (hosts.positionAt(old) - place_W).norm());
    });
    expectShares(hosts);
    EXPECT_LT(farthest, puts ? 1e-9 : 1e-2);
    EXPECT_LT(hosts.computeSpread(), puts ? 1e-9 : 1e-3);
  }
}

// An epoch of the newcomer's own does not count for those who are together.
TEST(Members, FollowNoTeleportOfBeforeTheJoin) {
  MemberHosts hosts(3);
  hosts.come(1, Vec3(0.0, 0.0, 0.1));
  hosts.come(2, Vec3(0.0, 0.0, 0.1));
  hosts.run(1.0);
  NeighbourScene& newcomer = hosts.come(0);
  hosts.links[0][1]->has_left = hosts.links[0][2]->has_left = true;  // as if alone
  hosts.run(0.1);
  newcomer.cube->setWorldTransform(toBullet(Vec3(0.0, 0.5, 0.0), Quat::Identity()));
  newcomer.cube->setInterpolationWorldTransform(newcomer.cube->getWorldTransform());
  hosts.run(0.2);
  hosts.links[0][1]->has_left = hosts.links[0][2]->has_left = false;
  hosts.run(1.0);
  expectShares(hosts);
  for (int i = 0; i < 3; ++i) EXPECT_LT((hosts.positionAt(i) - Vec3(0, 0, 0.1)).norm(), 1e-6) << i;
}

// Whatever the moment: who was there stays where it is, and the newcomer's copy comes there.
TEST(Members, FollowAnotherIfTheLeaderLeavesDuringTheJoin) {
  for (int steps = 1; steps <= 10; ++steps)
    for (const bool says_farewell : {true, false}) {
      SCOPED_TRACE(testing::Message() << steps << " steps, farewell " << says_farewell);
      MemberHosts hosts(3);
      const Vec3 place_W(0.0, 0.0, 0.1);
      hosts.come(0, place_W);
      hosts.come(1, place_W);
      hosts.run(1.0);
      hosts.come(2, Vec3(0.0, 0.4, 0.0));
      hosts.run(steps / MemberHosts::kRate);
      says_farewell ? hosts.leave(0) : hosts.vanish(0);
      double farthest = 0.0;
      hosts.run(4.0,
                [&] { farthest = std::max(farthest, (hosts.positionAt(1) - place_W).norm()); });
      expectShares(hosts);
      EXPECT_LT(farthest, 1e-8);  // single precision
      EXPECT_LT(hosts.computeSpread(), 1e-8);
    }
}

// A program that dies and begins anew at once may be what a newcomer has just begun to follow.
TEST(Members, MeetThoughOneBeginsAnewDuringTheJoin) {
  for (int steps = 1; steps <= 10; ++steps) {
    SCOPED_TRACE(steps);
    MemberHosts hosts(2);
    hosts.come(1, Vec3(0.0, 0.0, 0.1));
    hosts.run(1.0);
    hosts.come(0, Vec3(0.0, 0.4, 0.0));
    hosts.run(steps / MemberHosts::kRate);
    hosts.vanish(1);
    hosts.come(1, Vec3(0.3, 0.0, 0.0));
    hosts.run(4.0);
    expectShares(hosts);
    EXPECT_LT(hosts.computeSpread(), 1e-3);
    for (int i = 0; i < 2; ++i)
      EXPECT_EQ(hosts.scenes[i]->site->linkState(0), LinkState::kLive) << i;
  }
}

// Copies of a newcomer are led, and a wall is in the way. It takes part all the same.
TEST(Members, JoinThoughSomethingIsInTheWay) {
  MemberHosts hosts(2);
  hosts.settings.puts_reset_objects = false;
  hosts.come(0);
  hosts.run(0.5);
  hosts.come(1, Vec3(0.4, 0.0, 0.0)).addWall(0.1);
  hosts.run(6.0);
  expectShares(hosts);
  EXPECT_EQ(hosts.scenes[0]->site->linkState(0), LinkState::kLive);
  EXPECT_GT(hosts.positionAt(0).x(), 0.1);  // the newcomer's copy pulls
}

TEST(Members, NeedIdsThatRollsCanName) {
  MemberHosts hosts(2);
  NeighbourScene& scene = hosts.come(0);
  EXPECT_THROW(scene.site->connect(PeerId{65}, *hosts.links[0][1], Vec3::Zero()),
               std::invalid_argument);
  SiteSettings settings = hosts.settings;
  settings.self = PeerId{65};
  EXPECT_THROW(checkSiteSettings(settings), std::invalid_argument);
  settings.membership.follows = false;
  EXPECT_NO_THROW(checkSiteSettings(settings));
}

// Two hands squeeze a cube while a third user comes and goes.
TEST(Members, HandsFeelNoStep) {
  MemberHosts hosts(3);
  const double reach = NeighbourScene::kHalf + hosts.settings.hip_radius;
  const auto place = [&](int site, double side) {
    hosts.come(site).device.sample.hip.p_W = Vec3(side * (reach - 0.01), 0.0, 0.0);
  };
  place(0, 1.0);
  place(1, -1.0);
  hosts.run(2.0);
  const double before = hosts.scenes[0]->site->force().norm();
  EXPECT_GT(before, 0.4);
  double last = before, rise = 0.0;
  const auto watch = [&] {
    const double force = hosts.scenes[0]->site->force().norm();
    rise = std::max(rise, std::abs(force - last));
    last = force;
  };
  hosts.come(2);
  hosts.run(2.0, watch);
  EXPECT_EQ(hosts.scenes[0]->site->memberCount(), 3);
  hosts.leave(2);
  hosts.run(2.0, watch);
  EXPECT_EQ(hosts.scenes[0]->site->memberCount(), 2);
  EXPECT_LT(rise, 0.05 * before);  // in a host step
  EXPECT_NEAR(last, before, 0.02 * before);
}

// A hand that carries the weight of all copies carries it on, whoever has a part of it.
TEST(Members, AHandLiftsOnWhileUsersComeAndGo) {
  MemberHosts hosts(4);
  hosts.has_weight = true;
  const Vec3 place_W(0.0, 0.0, 0.3);
  hosts.come(0, place_W).device.sample.hip.p_W = place_W;
  hosts.scenes[0]->site->grab(0, Vec3::Zero());
  hosts.run(3.0);
  const double lifted = hosts.positionAt(0).z();
  EXPECT_NEAR(lifted, place_W.z(), 2e-3);
  double most = 0.0;
  const auto watch = [&] { most = std::max(most, std::abs(hosts.positionAt(0).z() - lifted)); };
  for (int i = 1; i < 4; ++i) {
    hosts.come(i, Vec3(0.3, 0.0, NeighbourScene::kHalf));
    hosts.run(2.0, watch);
    expectShares(hosts);
  }
  for (int i = 1; i < 4; ++i) {
    hosts.leave(i);
    hosts.run(2.0, watch);
    expectShares(hosts);
  }
  EXPECT_LT(most, 2e-3);
  EXPECT_LT(std::abs(hosts.positionAt(0).z() - lifted), 1e-4);
}

TEST(Members, AnObjectRestsWhileUsersComeAndGo) {
  MemberHosts hosts(4);
  hosts.has_weight = true;
  const Vec3 place_W(0.0, 0.0, NeighbourScene::kHalf);
  hosts.come(0, place_W);
  hosts.run(0.5);
  double farthest = 0.0;
  const auto watch = [&] {
    for (int i = 0; i < hosts.count(); ++i)
      if (hosts.scenes[i]) farthest = std::max(farthest, (hosts.positionAt(i) - place_W).norm());
  };
  for (int i = 1; i < 4; ++i) {
    hosts.come(i, place_W);
    hosts.run(1.0, watch);
    expectShares(hosts);
  }
  for (int i = 3; i > 0; --i) {
    hosts.leave(i);
    hosts.run(1.0, watch);
    expectShares(hosts);
  }
  EXPECT_LT(farthest, 1e-4);
}

TEST(Members, AnythingMayHappenInAnyOrder) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    test::Random random(seed);
    MemberHosts hosts(5);
    hosts.has_weight = seed % 2 == 0;
    hosts.settings.coordination_mode =
        seed % 3 == 0 ? CoordinationMode::kSum : CoordinationMode::kAverage;
    for (int change = 0; change < 25; ++change) {
      const int site = random.below(5);
      if (!hosts.scenes[site]) {
        hosts.come(site, Vec3(0, 0, NeighbourScene::kHalf) + 0.2 * random.inCube(1.0).cwiseAbs());
      } else if (random.uniform(0.0, 1.0) < 0.5) {
        hosts.leave(site);
      } else {
        hosts.vanish(site);
      }
      hosts.run(random.uniform(0.05, 0.8));
    }
    for (int site : {0, 3})
      if (!hosts.scenes[site]) hosts.come(site);
    hosts.run(5.0);
    expectShares(hosts);
    EXPECT_LT(hosts.computeSpread(), 2e-3) << "seed " << seed;
    for (int i = 0; i < 5; ++i)
      if (hosts.scenes[i]) {
        EXPECT_EQ(hosts.scenes[i]->site->status() & kStateNotFinite, 0u);
      }
  }
}

}  // namespace
}  // namespace tandem
