// Multi-bodies near the hand: their links are felt and pushed, as exactly as rigid bodies in
// joints.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>

#include "tandem/plugin/site.h"

#include "physics/arm_host.h"

namespace tandem {
namespace {

using test::ArmHost;
using test::ArmLinkPlan;
using test::byWidth;
using test::FakeDevice;
using test::kLink;
using test::kMass;
using test::makeChain;

constexpr double kUnit = kMass * ArmHost::kGravity * kLink;

class ArmsAtRates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(HostRates, ArmsAtRates, ::testing::Values(60.0, 240.0, 1000.0));

TEST_P(ArmsAtRates, AFreeArmKeepsItsEnergy) {
  for (const std::size_t count : {1U, 2U, 7U}) {
    ArmHost host;
    host.build(makeChain(count));
    host.putHandBeside();
    host.start();
    const double before = host.energy();
    double worst = 0.0;
    for (int i = 0; i < static_cast<int>(10.0 * GetParam()); ++i) {
      host.step(1.0 / GetParam());
      worst = std::max(worst, std::abs(host.energy() - before));
    }
    EXPECT_EQ(host.site->counters().promoted, count);
    EXPECT_EQ(host.site->counters().demoted, 0U);
    EXPECT_LT(worst, byWidth(1e-6, 1e-2) * kUnit) << count << " links";
  }
}

/// Arms with joints of all kinds; the hand is near, and touches nothing.
std::vector<std::vector<ArmLinkPlan>> makeArmsOfAllKinds() {
  std::vector<std::vector<ArmLinkPlan>> arms(6, makeChain(2));
  for (ArmLinkPlan& link : arms[0]) link.joint = btMultibodyLink::eSpherical;
  arms[1][0].joint = btMultibodyLink::ePrismatic;
  arms[1][0].axis = Vec3::UnitX();
  arms[2][0].joint = btMultibodyLink::ePlanar;
  arms[2][0].axis = Vec3::UnitZ();
  arms[2][1].e = Vec3(0.05, 0.0, 0.0);
  arms[3][1].joint = btMultibodyLink::eFixed;
  // A frame without mass between two links.
  arms[4][1].joint = btMultibodyLink::eFixed;
  arms[4][1].mass = 0.0;
  arms[4][1].has_shape = false;
  arms[4].emplace_back();
  // A tree, whose first link is fixed to the base.
  arms[5][0].joint = btMultibodyLink::eFixed;
  arms[5].emplace_back();
  arms[5][2].parent = 0;
  arms[5][2].e = Vec3(0.1, 0.0, 0.0);
  arms[5][2].axis = Vec3::UnitZ();
  return arms;
}

TEST_P(ArmsAtRates, EveryKindOfJointKeepsItsEnergy) {
  for (const std::vector<ArmLinkPlan>& plan : makeArmsOfAllKinds()) {
    for (const bool is_free : {false, true}) {
      ArmHost host(is_free ? Vec3(Vec3::Zero()) : Vec3(0.0, 0.0, -ArmHost::kGravity));
      host.build(plan, is_free ? 1.0 : 0.0, is_free ? Vec3(0.05, 0.04, 0.03) : Vec3(Vec3::Zero()));
      for (int link = 0; link < host.arm().getNumLinks(); ++link)
        for (int k = 0; k < host.arm().getLink(link).m_dofCount; ++k)
          host.arm().getJointVelMultiDof(link)[k] = btScalar(0.3) * static_cast<btScalar>(k + 1);
      if (is_free) host.arm().setBaseOmega(btVector3(1, 2, btScalar(0.5)));
      host.device.sample.hip.p_W = Vec3(0.0, 2.0, 0.0);
      SiteSettings settings;
      settings.host_stall = 1.0;
      host.start(settings);
      host.step(1.0 / GetParam());  // Bullet's own, if the arm was not held at once
      const auto energy = [&] {
        double sum = host.energy();
        if (is_free)
          for (const ArmHost::Motion& link : host.motions())
            sum -= link.mass * ArmHost::kGravity * link.p_W.z();
        return sum;
      };
      const double before = energy();
      double worst = 0.0;
      for (int i = 0; i < static_cast<int>(GetParam()); ++i) {
        host.step(1.0 / GetParam());
        worst = std::max(worst, std::abs(energy() - before));
      }
      EXPECT_GT(host.site->counters().promoted, 0U);
      EXPECT_EQ(host.site->counters().demoted, 0U);
      EXPECT_LT(worst, byWidth(1e-7, 1e-3) * kUnit)
          << plan.size() << " links, kinds " << plan[0].joint << ", " << plan[1].joint
          << (is_free ? ", free" : "");
    }
  }
}

/// The same chain out of rigid bodies and hinges.
struct RigidChain {
  test::BulletRig rig{Vec3(0.0, 0.0, -ArmHost::kGravity)};
  FakeDevice device{Vec3(10.0, 0.0, 0.0)};
  std::vector<btRigidBody*> links;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  std::unique_ptr<Site> site;

  explicit RigidChain(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      auto& shape =
          rig.makeShape<btBoxShape>(btVector3(btScalar(0.1), btScalar(0.02), btScalar(0.02)));
      const Vec3 p_W(kLink * (static_cast<double>(i) + 0.5), 0.0, 0.0);
      btRigidBody& link = rig.addBody(shape, kMass, p_W);
      shape.setMargin(btScalar(0.001));
      link.setSleepingThresholds(0, 0);
      const btVector3 left(btScalar(-0.1), 0, 0), right(btScalar(0.1), 0, 0), axis(0, 1, 0);
      if (i == 0)
        joints.push_back(std::make_unique<btHingeConstraint>(link, left, axis));
      else
        joints.push_back(
            std::make_unique<btHingeConstraint>(link, *links.back(), left, right, axis, axis));
      rig.world.addConstraint(joints.back().get(), true);
      links.push_back(&link);
    }
  }
  ~RigidChain() {
    site.reset();
    for (const auto& joint : joints) rig.world.removeConstraint(joint.get());
  }
  RigidChain(const RigidChain&) = delete;
  RigidChain& operator=(const RigidChain&) = delete;
  void start(const SiteSettings& settings = {}) {
    site = std::make_unique<Site>(settings, rig.world, device);
  }
};

TEST_P(ArmsAtRates, MoveLikeTheSameBodiesInHinges) {
  ArmHost host;
  host.build(makeChain(3));
  host.putHandBeside();
  host.start();
  RigidChain chain(3);
  chain.device.sample = host.device.sample;
  chain.start();
  for (int i = 0; i < static_cast<int>(GetParam()); ++i) {
    host.step(1.0 / GetParam());
    chain.rig.step(1.0 / GetParam());
  }
  for (int i = 0; i < 3; ++i) {
    const btRigidBody& link = *chain.links[static_cast<std::size_t>(i)];
    EXPECT_LT((host.linkPosition(i) - fromBullet(link.getCenterOfMassPosition())).norm(),
              byWidth(1e-7, 1e-3));
  }
}

TEST_P(ArmsAtRates, TheHandFeelsALinkAsItFeelsARigidBody) {
  ArmHost host;
  std::vector<ArmLinkPlan> plan = makeChain(2);
  host.build(plan);
  RigidChain chain(2);
  host.device.sample.hip.p_W = chain.device.sample.hip.p_W = Vec3(0.15, 0.0, -0.05);
  SiteSettings settings;
  settings.host_stall = 0.2;  // both are held from the start
  host.start(settings);
  chain.start(settings);
  double most = 0.0, worst = 0.0;
  for (int i = 0; i < static_cast<int>(0.4 * GetParam()); ++i) {
    host.step(1.0 / GetParam());
    chain.rig.step(1.0 / GetParam());
    most = std::max(most, chain.device.force_W.norm());
    worst = std::max(worst, (chain.device.force_W - host.device.force_W).norm());
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(worst, byWidth(1e-3, 0.02) * most);
}

// A link of a door leans on the hand: the moment of its weight, about its joint.
TEST(Arms, ALinkAtRestWeighsOnTheHand) {
  ArmHost host;
  host.build(makeChain(1));
  host.arm().setAngularDamping(btScalar(20));
  const double radius = SiteSettings().hip_radius;
  host.device.sample.hip.p_W = Vec3(0.15, 0.0, -0.02 - radius);
  host.start();
  host.run(4.0, 60.0);
  EXPECT_NEAR(host.device.force_W.z(), -kMass * ArmHost::kGravity * 0.1 / 0.15, 0.02);
}

TEST_P(ArmsAtRates, AFingerPushesACubeAsInManySteps) {
  constexpr double kHalf = 0.02, kSpeed = 0.1, kGap = 0.003, kForce = 100.0;
  constexpr double kFingerMass = 5.0;
  const auto push = [&](double rate, bool has_site) {
    ArmHost host;
    ArmLinkPlan finger;
    finger.joint = btMultibodyLink::ePrismatic;
    finger.axis = Vec3::UnitX();
    finger.mass = kFingerMass;
    finger.half = Vec3::Constant(kHalf);
    finger.d = Vec3::Zero();
    host.build({finger}, 0.0, Vec3::Zero(), Vec3(-2.0 * kHalf - kGap, 0.0, 0.025));
    host.addMotor(0, kSpeed, kForce / rate);
    host.host.addBody(host.host.makeBox(Vec3(2, 2, 0.1)), 0.0, Vec3(0, 0, -0.1));
    btRigidBody& cube = host.host.addCube(0.2, Vec3(0.0, 0.0, kHalf));
    cube.setSleepingThresholds(0, 0);
    SiteSettings settings;
    settings.peers = 1;
    if (has_site) {
      host.start(settings);
      host.site->share(cube);
    }
    host.run(1.0, rate);
    return Vec3(fromBullet(cube.getCenterOfMassPosition()).x(), host.q(0), 0.0);
  };
  const Vec3 fine = push(1000.0, false), ours = push(GetParam(), true);
  const double late = 0.5 * kSpeed * kSpeed * kFingerMass / kForce;  // way lost by its force
  EXPECT_NEAR(ours.x(), kSpeed - late - kGap, 1e-5);
  EXPECT_NEAR(ours.x(), fine.x(), 1e-4);
  EXPECT_NEAR(ours.y(), kSpeed - late, 1e-5);
}

TEST_P(ArmsAtRates, AFreeArmAndACubeKeepTheirMomentum) {
  ArmHost host(Vec3::Zero());
  ArmLinkPlan link;
  link.e = Vec3(0.05, 0.0, 0.0);
  link.half = Vec3(0.1, 0.02, 0.02);
  host.build({link}, 1.0, Vec3(0.05, 0.05, 0.05));
  btRigidBody& cube = host.host.addCube(0.2, Vec3(0.2, 0.0, 0.12));
  cube.setSleepingThresholds(0, 0);
  cube.setLinearVelocity(btVector3(0, 0, -1));
  SiteSettings settings;
  settings.peers = 1;
  settings.host_stall = 1.0;  // they stay near
  host.start(settings);
  host.site->share(cube);
  const auto momenta = [&] {
    const Vec3 p = fromBullet(cube.getCenterOfMassPosition());
    const Vec3 v = 0.2 * fromBullet(cube.getLinearVelocity());
    const Vec3 w =
        fromBullet(cube.getInvInertiaTensorWorld().inverse() * cube.getAngularVelocity());
    std::array<Vec3, 2> sum{v, Vec3(p.cross(v) + w)};
    for (const ArmHost::Motion& part : host.motions()) {
      // Its inertia about its axes, which stay parallel to the plane of the motion.
      const Vec3 turn = part.inertia.cwiseProduct(part.w_B);
      sum[0] += part.mass * part.v_W;
      sum[1] += part.mass * part.p_W.cross(part.v_W) + Vec3(0.0, turn.y(), 0.0);
    }
    return sum;
  };
  const auto before = momenta();
  host.run(0.5, GetParam());
  const auto after = momenta();
  EXPECT_EQ(host.site->counters().promoted - host.site->counters().demoted, 2U);
  EXPECT_GT(std::abs(host.u(0)), 0.1);
  EXPECT_LT((after[0] - before[0]).norm(), byWidth(1e-9, 1e-5));
  EXPECT_LT((after[1] - before[1]).norm(), byWidth(1e-6, 1e-4));
}

// Neither the hand nor a shared body is near.
TEST_P(ArmsAtRates, FarAwayStayBulletsToTheBit) {
  std::vector<double> ends;
  for (const bool has_site : {false, true}) {
    ArmHost host;
    host.build(makeChain(4));
    host.addMotor(1, 0.3, 0.1);
    host.addLimit(2, -0.4, 0.4);
    btRigidBody& cube = host.host.addCube(0.2, Vec3(20.0, 0.0, 0.0));
    if (has_site) {
      host.start();
      host.site->share(cube);
    }
    host.run(1.0, GetParam());
    for (int i = 0; i < 4; ++i) ends.push_back(host.q(i));
    for (int i = 0; i < 4; ++i) ends.push_back(host.u(i));
  }
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(ends[i], ends[i + 8]);
}

TEST_P(ArmsAtRates, FollowAHostThatSetsThem) {
  ArmHost host;
  host.build(makeChain(2));
  host.putHandBeside();
  host.start();
  host.run(0.3, GetParam());
  host.arm().setJointPos(0, btScalar(0.2));
  host.arm().setJointPos(1, btScalar(-0.4));
  host.arm().setJointVel(0, 0);
  host.arm().setJointVel(1, btScalar(0.5));
  host.showPose();
  const double before = host.energy();
  host.step(1.0 / GetParam());
  // A float's island was up to a tick ahead, with its old velocity.
  EXPECT_NEAR(host.q(0), 0.2, 60.0 / (GetParam() * GetParam()) + byWidth(0.0, 6e-3));
  host.run(0.3, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 2U);
  EXPECT_NEAR(host.energy(), before, byWidth(1e-6, 1e-2) * kUnit);
}

TEST(Arms, ComeBackAfterTheHostRemovedThem) {
  ArmHost host;
  host.build(makeChain(3));
  host.putHandBeside();
  host.start();
  host.run(0.2, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 3U);
  for (const auto& collider : host.host.colliders)
    host.host.world->removeCollisionObject(collider.get());
  host.host.multi()->removeMultiBody(&host.arm());
  const double q = host.q(0), u = host.u(0);
  host.run(0.2, 60.0);
  EXPECT_EQ(host.site->counters().demoted, 3U);
  EXPECT_EQ(host.q(0), q);
  EXPECT_EQ(host.u(0), u);
  host.host.multi()->addMultiBody(&host.arm());
  for (const auto& collider : host.host.colliders)
    host.host.world->addCollisionObject(collider.get(), 1, -1);
  host.run(0.2, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 6U);
  EXPECT_GT(std::abs(host.q(0) - q), 0.01);
}

TEST(Arms, LeaveTheIslandWithTheHand) {
  ArmHost host;
  host.build(makeChain(2));
  host.addMotor(0, 0.1, 5.0);
  host.putHandBeside();
  host.start();
  host.run(0.1, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 2U);
  host.device.sample.hip.p_W = Vec3(0.0, 3.0, 0.0);
  host.run(0.1, 60.0);
  EXPECT_EQ(host.site->counters().demoted, 2U);
  EXPECT_EQ(host.constraints[0]->getMaxAppliedImpulse(), btScalar(5));
  const double u = host.u(1);
  host.run(0.1, 60.0);
  EXPECT_NE(host.u(1), u);
}

/// A constraint of the host's own.
struct OwnPoint final : btMultiBodyPoint2Point {
  using btMultiBodyPoint2Point::btMultiBodyPoint2Point;
};

TEST(Arms, StayBulletsWithConstraintsOfOtherKinds) {
  ArmHost host;
  host.build(makeChain(2));
  btRigidBody* const nothing = nullptr;
  host.add<OwnPoint>(1, nothing, btVector3(btScalar(0.1), 0, 0), btVector3(btScalar(0.4), 0, 0));
  host.putHandBeside();
  host.start();
  host.run(0.2, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 0U);
  const std::vector<std::string> warnings = host.site->warnings();
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& line) {
    return line.find("multi-body") != std::string::npos &&
           line.find("constraint") != std::string::npos;
  }));
}

TEST(Arms, StayBulletsWithoutRoom) {
  ArmHost host;
  host.build(makeChain(3));
  host.putHandBeside();
  SiteSettings settings;
  settings.max_neighbours = 2;
  host.start(settings);
  host.run(0.2, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 0U);
}

// Importers of robots give each link a compound, with the inertial frame in its only child's pose.
TEST(Arms, TheHandFeelsALinkOfACompound) {
  ArmHost host(Vec3::Zero());
  host.build(makeChain(1));
  auto& compound = host.host.makeShape<btCompoundShape>();
  auto& box = host.host.makeBox(Vec3(0.02, 0.1, 0.02));
  box.setMargin(btScalar(0.001));
  compound.addChildShape(toBullet(Vec3(0.05, 0.0, 0.0), test::turn(0.5 * M_PI, Vec3::UnitZ())),
                         &box);
  host.arm().getLink(0).m_collider->setCollisionShape(&compound);
  host.host.world->updateAabbs();
  host.addMotor(0, 0.0, 10.0);
  const double radius = SiteSettings().hip_radius;
  host.device.sample.hip.p_W = Vec3(0.24, 0.0, 0.02 + radius - 0.001);  // beyond the link's centre
  host.start();
  host.run(0.2, 60.0);
  EXPECT_GT(host.device.force_W.z(), 0.5);
}

// A compound does not tell its owner that a child has moved.
TEST(Arms, TheHandFeelsThatAPartOfALinkHasMoved) {
  ArmHost host(Vec3::Zero());
  host.build(makeChain(1));
  auto& compound = host.host.makeShape<btCompoundShape>();
  auto& box = host.host.makeBox(Vec3(0.1, 0.02, 0.02));
  box.setMargin(btScalar(0.001));
  compound.addChildShape(btTransform::getIdentity(), &box);
  host.arm().getLink(0).m_collider->setCollisionShape(&compound);
  host.addMotor(0, 0.0, 10.0);
  const double radius = SiteSettings().hip_radius;
  host.device.sample.hip.p_W = Vec3(0.15, 0.0, 0.02 + radius - 0.001);
  host.start();
  host.run(0.2, 60.0);
  EXPECT_GT(host.device.force_W.z(), 0.5);
  compound.updateChildTransform(0, toBullet(Vec3(0.0, 0.0, -0.002), Quat::Identity()));
  host.run(0.2, 60.0);
  EXPECT_EQ(host.device.force_W, Vec3(Vec3::Zero()));
}

TEST(Arms, TheHandFeelsAFixedBase) {
  ArmHost host;
  host.build(makeChain(1), 0.0, Vec3(0.05, 0.05, 0.05));
  const double radius = SiteSettings().hip_radius;
  host.device.sample.hip.p_W = Vec3(-0.05 - radius + 0.001, 0.0, 0.0);
  host.start();
  host.run(0.2, 60.0);
  EXPECT_LT(host.device.force_W.x(), -0.5);
}

}  // namespace
}  // namespace tandem
