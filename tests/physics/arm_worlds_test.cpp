// Drawn worlds with multi-bodies, whose hosts do to them what hosts do.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointLimit.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>

#include "tandem/plugin/site.h"

#include "physics/arm_host.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::ArmHost;
using test::ArmLinkPlan;

/// Numbers of a drawn world.
struct Draw : test::Random {
  using Random::Random;
  double real(double low, double high) { return uniform(low, high); }
  int count(int low, int high) { return low + below(high - low + 1); }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }
};

btScalar bullet(double number) { return static_cast<btScalar>(number); }

ArmLinkPlan drawLink(Draw& draw, int index) {
  ArmLinkPlan link;
  const double kind = draw.real(0.0, 1.0);
  link.joint = kind < 0.5    ? btMultibodyLink::eRevolute
               : kind < 0.65 ? btMultibodyLink::ePrismatic
               : kind < 0.8  ? btMultibodyLink::eSpherical
               : kind < 0.9  ? btMultibodyLink::eFixed
                             : btMultibodyLink::ePlanar;
  link.axis = draw.direction();
  link.mass = draw.real(0.05, 2.0);
  link.half = Vec3(draw.real(0.02, 0.1), draw.real(0.01, 0.03), draw.real(0.01, 0.03));
  link.d = link.joint == btMultibodyLink::ePlanar ? Vec3(Vec3::Zero()) : Vec3(link.half.x(), 0, 0);
  link.e = Vec3(index == 0 ? 0.0 : 0.06, draw.real(-0.02, 0.02), 0.0);
  link.parent = draw.chance(0.8) ? index - 1 : draw.count(-1, index - 1);
  link.has_shape = draw.chance(0.9);
  return link;
}

/// A drawn world, and what its host and user do.
class ArmWorld {
 public:
  explicit ArmWorld(std::uint64_t seed) : draw_(seed), host_(Vec3(0.0, 0.0, -ArmHost::kGravity)) {
    const int count = draw_.count(0, 8);
    const bool is_free = count == 0 || draw_.chance(0.3);
    std::vector<ArmLinkPlan> plan;
    for (int i = 0; i < count; ++i) plan.push_back(drawLink(draw_, i));
    const Vec3 base = is_free || draw_.chance(0.5) ? Vec3(0.05, 0.04, 0.03) : Vec3(Vec3::Zero());
    host_.build(plan, is_free ? draw_.real(0.2, 3.0) : 0.0, base, Vec3(0.0, 0.0, 0.3));
    if (draw_.chance(0.5)) host_.arm().setLinearDamping(btScalar(0.04));
    if (draw_.chance(0.5)) host_.arm().setAngularDamping(btScalar(0.04));
    host_.arm().setHasSelfCollision(false);
    host_.arm().setCanSleep(draw_.chance(0.3));
    rate_ = draw_.chance(0.3) ? 60.0 : draw_.chance(0.5) ? 240.0 : 1000.0;
    for (int i = 0; i < count; ++i) {
      const auto joint = plan[static_cast<std::size_t>(i)].joint;
      if (joint == btMultibodyLink::eSpherical) addToBall(i);
      if (joint != btMultibodyLink::eRevolute && joint != btMultibodyLink::ePrismatic) continue;
      if (draw_.chance(0.6))
        motors_.push_back(&host_.addMotor(i, draw_.real(-1, 1), drawImpulse()));
      if (draw_.chance(0.4)) host_.addLimit(i, draw_.real(-1.0, -0.05), draw_.real(0.05, 1.0));
    }
    for (int i = draw_.count(1, 4); i-- > 0;)
      cubes_.push_back(&host_.host.addCube(
          draw_.real(0.05, 1.0), Vec3(draw_.real(-0.3, 0.3), draw_.real(-0.3, 0.3), 0.5)));
    if (draw_.chance(0.3)) cubes_.back()->setAnisotropicFriction(btVector3(1, btScalar(0.5), 1));
    if (draw_.chance(0.5))
      for (int i = draw_.count(1, 2); i-- > 0;) addTie();
    hand_ = Vec3(draw_.real(-0.2, 0.4), draw_.real(-0.1, 0.1), draw_.real(0.2, 0.45));
    host_.device.sample.hip.p_W = hand_;
    SiteSettings settings;
    settings.peers = draw_.count(1, 2);
    if (draw_.chance(0.3)) {
      settings.tick_source = TickSource::kCaller;
      settings.host_step = 1.0 / rate_;
      ticks_itself_ = true;
    }
    host_.start(settings);
    if (draw_.chance(0.7)) host_.site->share(*cubes_.front());
  }

  void run(double duration) {
    const int steps = static_cast<int>(duration * rate_);
    for (int i = 0; i < steps; ++i, ++step_) {
      const double time = static_cast<double>(step_) / rate_;
      if (draw_.chance(4.0 / rate_)) act();
      host_.device.sample.hip.p_W =
          hand_ + 0.15 * Vec3(std::sin(3.0 * time), std::sin(2.3 * time), std::sin(1.7 * time));
      for (; ticks_itself_ && tick_ < time - 1e-9; tick_ += 1e-3) host_.site->tick(tick_);
      const bool is_held = host_.site->neighbourCount() > 0;
      const double before = findSpeed();
      host_.step(1.0 / rate_);
      // Bullet alone throws such arms now and then. Then the world has nothing more to tell.
      if (!(before < kFast)) return;
      const bool is_fast = !(findSpeed() < 2.0 * kFast) || !host_.device.force_W.allFinite();
      if (is_held && is_fast) return void(is_broken_ = true);
    }
  }
  /// False if something was thrown while the island held it.
  [[nodiscard]] bool isSane() const { return !is_broken_; }
  /// True if the host has all that is its own.
  [[nodiscard]] bool isGivenBack() {
    host_.site.reset();
    bool is_back = host_.arm().getMaxCoordinateVelocity() == btScalar(100);
    for (const auto& constraint : host_.constraints)
      is_back = is_back && constraint->getMaxAppliedImpulse() > 0;
    for (const btRigidBody* cube : cubes_)
      is_back = is_back && cube->getNumObjectsWithoutCollision() == 0;
    return is_back;
  }
  /// The host's acts, as steps and kinds.
  [[nodiscard]] const std::string& story() const { return story_; }
  [[nodiscard]] const Site& site() const { return *host_.site; }

 private:
  static constexpr double kFast = 100.0;  // [m/s]

  /// Greatest speed of links and cubes [m/s].
  [[nodiscard]] double findSpeed() const {
    double speed = 0.0;
    const auto take = [&](const Vec3& v_W) {
      speed = v_W.allFinite() ? std::max(speed, v_W.norm()) : HUGE_VAL;
    };
    for (const ArmHost::Motion& link : host_.motions()) take(link.v_W);
    for (const btRigidBody* cube : cubes_) take(fromBullet(cube->getLinearVelocity()));
    return speed;
  }
  double drawImpulse() { return draw_.real(0.1, 20.0) / rate_; }
  [[nodiscard]] int drawJoint() {
    const int links = host_.arm().getNumLinks();
    return links == 0 ? -1 : draw_.count(0, links - 1);
  }
  btVector3 drawPlace(double reach) { return toBullet(draw_.inCube(reach)); }
  void addToBall(int link) {
    if (draw_.chance(0.6)) {
      auto& motor = host_.add<btMultiBodySphericalJointMotor>(link, bullet(drawImpulse()));
      motor.setPositionTarget(
          toBullet(Quat(Eigen::AngleAxisd(draw_.real(0.0, 2.0), draw_.direction()))),
          bullet(draw_.real(0.0, 1.0)));
      if (draw_.chance(0.5)) motor.setDamping(btVector3(1, 1, 1) * bullet(draw_.real(0.1, 1.0)));
    }
    if (draw_.chance(0.4))
      host_.add<btMultiBodySphericalJointLimit>(
          link, bullet(draw_.real(0.1, 1.5)), bullet(draw_.real(0.1, 1.5)),
          bullet(draw_.real(0.1, 3.0)), bullet(100.0 / rate_));
  }
  /// Connects a link with a cube, with another link, or with the world, about where they are.
  void addTie() {
    const btMultiBody& arm = host_.arm();
    const int a = drawJoint(), kind = draw_.count(0, 2);
    const bool to_cube = draw_.chance(0.4), to_link = !to_cube && draw_.chance(0.5);
    const int b = to_link ? drawJoint() : -1;
    if (to_link && a == b) return;
    btRigidBody* cube =
        to_cube
            ? cubes_[static_cast<std::size_t>(draw_.count(0, static_cast<int>(cubes_.size()) - 1))]
            : nullptr;
    const btVector3 on_a = drawPlace(0.05), place = arm.localPosToWorld(a, on_a) + drawPlace(0.01);
    const btMatrix3x3 straight = btMatrix3x3::getIdentity();
    btMatrix3x3 frame = arm.localFrameToWorld(a, straight);
    btVector3 on_b = cube ? drawPlace(0.05) : place;
    if (cube && draw_.chance(0.7))
      cube->setWorldTransform(toBullet(fromBullet(place - on_b), Quat::Identity()));
    if (to_link) {
      on_b = const_cast<btMultiBody&>(arm).worldPosToLocal(b, place);
      frame = arm.localFrameToWorld(b, straight).transpose() * frame;
    }
    if (cube) frame = straight;
    const btVector3 along = toBullet(draw_.direction());
    if (to_link) {
      if (kind == 0) host_.add<btMultiBodyPoint2Point>(a, &host_.arm(), b, on_a, on_b);
      if (kind == 1)
        host_.add<btMultiBodyFixedConstraint>(a, &host_.arm(), b, on_a, on_b, straight, frame);
      if (kind == 2)
        host_.add<btMultiBodySliderConstraint>(a, &host_.arm(), b, on_a, on_b, straight, frame,
                                               along);
    } else {
      if (kind == 0) host_.add<btMultiBodyPoint2Point>(a, cube, on_a, on_b);
      if (kind == 1) host_.add<btMultiBodyFixedConstraint>(a, cube, on_a, on_b, straight, frame);
      if (kind == 2)
        host_.add<btMultiBodySliderConstraint>(a, cube, on_a, on_b, straight, frame, along);
    }
    ties_.push_back(host_.constraints.back().get());
    if (draw_.chance(0.5)) ties_.back()->setMaxAppliedImpulse(bullet(500.0 / rate_));
  }
  void act() {
    btMultiBody& arm = host_.arm();
    const int link = drawJoint();
    const int dofs = link < 0 ? 0 : arm.getLink(link).m_dofCount;
    const int what = draw_.count(0, 12);
    story_ += ", " + std::to_string(step_) + ": " + std::to_string(what);
    if (what == 0 && dofs == 1) {
      arm.setJointPos(link, static_cast<btScalar>(draw_.real(-0.5, 0.5)));
      host_.showPose();
    } else if (what == 1 && dofs > 0) {
      for (int k = 0; k < dofs; ++k)
        arm.getJointVelMultiDof(link)[k] = static_cast<btScalar>(draw_.real(-1.0, 1.0));
    } else if (what == 2 && dofs > 0) {
      for (int k = 0; k < dofs; ++k)
        arm.addJointTorqueMultiDof(link, k, static_cast<btScalar>(draw_.real(-2.0, 2.0)));
    } else if (what == 3 && link >= 0) {
      arm.addLinkForce(link, toBullet(draw_.inCube(5.0)));
    } else if (what == 4 && !motors_.empty()) {
      motors_[static_cast<std::size_t>(draw_.count(0, static_cast<int>(motors_.size()) - 1))]
          ->setVelocityTarget(static_cast<btScalar>(draw_.real(-2.0, 2.0)),
                              static_cast<btScalar>(draw_.chance(0.5) ? 1.0 : 0.5));
    } else if (what == 5 && !motors_.empty()) {
      motors_.front()->setPositionTarget(static_cast<btScalar>(draw_.real(-0.5, 0.5)),
                                         btScalar(0.1));
    } else if (what == 6) {
      leave_ = !leave_;
      if (leave_) {
        for (btMultiBodyConstraint* tie : ties_) host_.host.multi()->removeMultiBodyConstraint(tie);
        for (const auto& collider : host_.host.colliders)
          host_.host.world->removeCollisionObject(collider.get());
        host_.host.multi()->removeMultiBody(&arm);
      } else {
        host_.host.multi()->addMultiBody(&arm);
        for (const auto& collider : host_.host.colliders)
          host_.host.world->addCollisionObject(collider.get(), 1, -1);
        for (btMultiBodyConstraint* tie : ties_) host_.host.multi()->addMultiBodyConstraint(tie);
      }
    } else if (what == 7) {
      cubes_.back()->setWorldTransform(
          toBullet(Vec3(draw_.real(-0.3, 0.3), draw_.real(-0.3, 0.3), 0.3), Quat::Identity()));
      cubes_.back()->activate(true);
    } else if (what == 8) {
      arm.setLinearDamping(static_cast<btScalar>(draw_.real(0.0, 0.1)));
    } else if (what == 9 && !arm.hasFixedBase()) {
      arm.setBaseVel(toBullet(draw_.inCube(0.5)));
    } else if (what == 10 && !ties_.empty() && !leave_) {
      ties_.front()->setMaxAppliedImpulse(bullet(draw_.real(0.1, 500.0) / rate_));
    } else if (what == 11 && !ties_.empty() && !leave_) {
      const Vec3 to =
          draw_.inCube(0.05) + (ties_.front()->getMultiBodyB() ? 0.0 : 0.3) * Vec3::UnitZ();
      ties_.front()->setPivotInB(toBullet(to));
    } else if (what == 12 && !ties_.empty() && !leave_) {
      host_.remove(*ties_.back());
      ties_.pop_back();
    }
  }

  Draw draw_;
  ArmHost host_;
  std::vector<btRigidBody*> cubes_;
  std::vector<btMultiBodyJointMotor*> motors_;
  std::vector<btMultiBodyConstraint*> ties_;
  std::string story_;
  Vec3 hand_ = Vec3::Zero();
  double rate_ = 60.0, tick_ = 0.0;
  int step_ = 0;
  bool ticks_itself_ = false, leave_ = false, is_broken_ = false;
};

TEST(ArmWorlds, NothingBreaks) {
  std::uint64_t promoted = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    ArmWorld world(seed);
    world.run(1.5);
    promoted += world.site().counters().promoted;
    EXPECT_TRUE(world.isSane()) << "seed " << seed << world.story();
    EXPECT_TRUE(world.isGivenBack()) << "seed " << seed << world.story();
  }
  EXPECT_GT(promoted, 150U);
}

// Weak motors, limits and ties of a loop ask for what no joint can do. Rows that held pulled each
// other by 1e9 N, 1e7 times what a motor has, and then threw the arm: in one world of 400.
TEST(ArmWorlds, MotorsThatContradictEachOtherLetGo) {
  ArmWorld world(396);
  world.run(1.5);
  EXPECT_TRUE(world.isSane()) << world.story();
  EXPECT_TRUE(world.isGivenBack()) << world.story();
}

}  // namespace
}  // namespace tandem
