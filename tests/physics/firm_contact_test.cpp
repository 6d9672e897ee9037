// Contact and joints that stay Bullet's: a shared cube is held by robots' links and by joints as
// firmly as without a site.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "host/any_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::byWidth;
using test::WorldKind;

/// Ways to step the cube: by Bullet alone, or by a site.
enum class Way { kBare, kHostStep, kCaller };

constexpr double kHalf = 0.02;     // of the cube [m]
constexpr double kMass = 0.2;      // of the cube [kg]
constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kTick = 1e-3;     // [s]

/// A world with a robot, and a cube that a site may share.
class FirmScene {
 public:
  FirmScene(Way way, double rate) : way_(way), step_(1.0 / rate) {}

  [[nodiscard]] AnyHost& host() { return host_; }
  [[nodiscard]] const btRigidBody& cube() const { return *cube_; }
  [[nodiscard]] Vec3 position() const { return fromBullet(cube_->getCenterOfMassPosition()); }
  [[nodiscard]] const Site& site() const { return *site_; }
  [[nodiscard]] double finger() const { return static_cast<double>(robot_->getJointPos(0)); }

  void addFloor() { host_.addBody(host_.makeBox(Vec3(2, 2, 0.1)), 0.0, Vec3(0, 0, -0.1)); }
  void addCube(const Vec3& p_W) {
    cube_ = &host_.addCube(kMass, p_W);
    cube_->setSleepingThresholds(0, 0);
  }
  /// A cubic link of 4 cm on a slide along `axis`. Its motor keeps `speed` [m/s].
  void addRobot(const Vec3& p_W, const Vec3& axis, double speed) {
    btBoxShape& shape = host_.makeBox(Vec3::Constant(kHalf));
    btVector3 inertia;
    shape.calculateLocalInertia(btScalar(5), inertia);
    host_.multi_body =
        std::make_unique<btMultiBody>(1, btScalar(0), btVector3(0, 0, 0), true, false);
    robot_ = host_.multi_body.get();
    robot_->setBasePos(toBullet(p_W));
    robot_->setupPrismatic(0, btScalar(5), inertia, -1, btQuaternion::getIdentity(), toBullet(axis),
                           btVector3(0, 0, 0), btVector3(0, 0, 0), true);
    robot_->finalizeMultiDof();
    robot_->setUseGyroTerm(false);  // the island does not hold such a robot
    robot_->setCanSleep(false);
    host_.multi()->addMultiBody(robot_);
    auto collider = std::make_unique<btMultiBodyLinkCollider>(robot_, 0);
    collider->setCollisionShape(&shape);
    collider->setWorldTransform(btTransform(btQuaternion::getIdentity(), toBullet(p_W)));
    host_.world->addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                                    btBroadphaseProxy::AllFilter);
    robot_->getLink(0).m_collider = collider.get();
    host_.colliders.push_back(std::move(collider));
    motor_ = std::make_unique<btMultiBodyJointMotor>(robot_, 0, static_cast<btScalar>(speed),
                                                     btScalar(100));
    host_.multi()->addMultiBodyConstraint(motor_.get());
  }
  ~FirmScene() {
    site_.reset();
    if (motor_) host_.multi()->removeMultiBodyConstraint(motor_.get());
  }
  FirmScene(const FirmScene&) = delete;
  FirmScene& operator=(const FirmScene&) = delete;

  std::function<void()> onTick;  ///< after each tick

  void start() {
    if (way_ == Way::kBare) return;
    SiteSettings settings;
    settings.peers = 1;
    settings.host_step = step_;
    if (way_ == Way::kCaller) settings.tick_source = TickSource::kCaller;
    site_ = std::make_unique<Site>(settings, *host_.world, device_);
    site_->share(*cube_);
  }

  /// Runs host steps, and ticks of 1 ms beside them; calls `each` after a host step.
  template <typename Each>
  void run(double duration, Each each) {
    for (const double end = time_ + duration; time_ < end - 1e-9; time_ += step_) {
      if (way_ == Way::kCaller) {
        for (; tick_ < time_ + step_ - 1e-9; tick_ += kTick) {
          site_->tick(tick_);
          if (onTick) onTick();
        }
      }
      host_.step(step_);
      each();
    }
  }
  void run(double duration) {
    run(duration, [] {});
  }

 private:
  Way way_;
  double step_;                     // [s]
  double time_ = 0.0, tick_ = 0.0;  // [s]
  AnyHost host_{WorldKind::kMultiBody, Vec3(0, 0, -kGravity)};
  test::FakeDevice device_{Vec3(0.0, 0.0, 10.0)};
  btRigidBody* cube_ = nullptr;
  btMultiBody* robot_ = nullptr;
  std::unique_ptr<btMultiBodyJointMotor> motor_;
  std::unique_ptr<Site> site_;
};

/// Deepest overlap of a finger that pushes the cube over a floor [m].
double pushByFinger(Way way, double rate, double gap, double& way_of_cube) {
  FirmScene scene(way, rate);
  scene.addFloor();
  scene.addCube(Vec3(0.0, 0.0, kHalf));
  scene.addRobot(Vec3(-2.0 * kHalf - gap, 0.0, 0.03), Vec3::UnitX(), 0.1);
  scene.start();
  double overlap = 0.0;
  scene.run(1.0, [&] {
    const double face = scene.finger() - kHalf - gap;
    overlap = std::max(overlap, face - (scene.position().x() - kHalf));
  });
  way_of_cube = scene.position().x();
  return overlap;
}

TEST(FirmContact, AFingerPushesASharedCubeAsFarAsAnyOther) {
  for (const double rate : {60.0, 240.0}) {
    // No multiple of a step: rounding would decide about a touch.
    for (const double gap : {0.0042, 0.0046, 0.0054, 0.0058}) {
      double bare_way = 0.0;
      const double bare = pushByFinger(Way::kBare, rate, gap, bare_way);
      for (const Way way : {Way::kHostStep, Way::kCaller}) {
        double pushed = 0.0;
        EXPECT_LT(pushByFinger(way, rate, gap, pushed), 1.1 * bare) << rate << " Hz " << gap;
        EXPECT_NEAR(pushed, bare_way, 2e-3) << rate << " Hz " << gap;
      }
    }
  }
}

/// Lowest and last height of a cube's lower face over a link that it stands on [m].
std::pair<double, double> standOnLink(Way way, double rate) {
  FirmScene scene(way, rate);
  scene.addRobot(Vec3::Zero(), Vec3::UnitZ(), 0.0);
  scene.addCube(Vec3(0.0, 0.0, 2.0 * kHalf + 0.001));
  scene.start();
  double lowest = 1.0;
  const auto gap = [&] { return scene.position().z() - 2.0 * kHalf - scene.finger(); };
  scene.run(2.0, [&] { lowest = std::min(lowest, gap()); });
  return {lowest, gap()};
}

TEST(FirmContact, ACubeStandsOnALink) {
  const auto bare = standOnLink(Way::kBare, 60.0);
  for (const Way way : {Way::kHostStep, Way::kCaller}) {
    const auto shared = standOnLink(way, 60.0);
    EXPECT_GT(shared.first, 1.5 * bare.first);
    EXPECT_NEAR(shared.second, bare.second, 1e-5);
  }
}

/// In the island the cube stays where it stands between the host's steps, too.
TEST(FirmContact, ACubeOnALinkDoesNotShake) {
  FirmScene scene(Way::kCaller, 60.0);
  scene.addRobot(Vec3::Zero(), Vec3::UnitZ(), 0.0);
  scene.addCube(Vec3(0.0, 0.0, 2.0 * kHalf));
  scene.start();
  scene.run(1.0);
  double low = 1.0, high = 0.0;
  scene.onTick = [&] {
    const double z = scene.site().object(0).p_W.z();
    low = std::min(low, z);
    high = std::max(high, z);
  };
  scene.run(0.5);
  EXPECT_LT(high - low, 2e-4);  // a free fall between two steps is 1.4 mm
}

/// Measures of a swinging body.
struct Swing {
  double gap = 0.0;                 ///< largest one of the joint [m]
  double least = 1e9, most = -1e9;  ///< energy, zero at the start [J]
};

template <typename Joint>
Swing swing(Way way, double rate, const Vec3& start_W, Joint makeJoint) {
  FirmScene scene(way, rate);
  scene.addCube(start_W);
  btRigidBody& cube = const_cast<btRigidBody&>(scene.cube());
  scene.host().joints.push_back(makeJoint(cube));
  scene.host().world->addConstraint(scene.host().joints.back().get());
  scene.start();
  const btVector3 pin_B = toBullet(Vec3(-start_W));
  Swing swing;
  scene.run(10.0, [&] {
    swing.gap =
        std::max(swing.gap, static_cast<double>((cube.getWorldTransform() * pin_B).length()));
    const double v = static_cast<double>(cube.getLinearVelocity().length());
    const double w = static_cast<double>(cube.getAngularVelocity().length());
    const double inertia = 1.0 / static_cast<double>(cube.getInvInertiaDiagLocal().x());
    const double energy = kMass * (0.5 * v * v + kGravity * (scene.position().z() - start_W.z())) +
                          0.5 * inertia * w * w;
    swing.least = std::min(swing.least, energy);
    swing.most = std::max(swing.most, energy);
  });
  return swing;
}

// Bullet alone loses a tenth of it in ten seconds, and opens the joint by up to 1 mm.
template <typename Joint>
void expectFirm(const Vec3& start_W, Joint makeJoint) {
  constexpr double kUnit = kMass * kGravity * 0.1;
  for (const double rate : {60.0, 240.0, 1000.0}) {
    SCOPED_TRACE(rate);
    for (const Way way : {Way::kHostStep, Way::kCaller}) {
      const Swing shared = swing(way, rate, start_W, makeJoint);
      EXPECT_LT(shared.gap, byWidth(1e-9, 1e-6));
      EXPECT_LT(shared.most, byWidth(1e-7, 1e-4) * kUnit);
      EXPECT_GT(shared.least, -byWidth(1e-7, 1e-4) * kUnit);
    }
  }
}

TEST(FirmContact, APendulumKeepsItsEnergy) {
  const Vec3 start_W(0.1, 0.0, 0.0);
  expectFirm(start_W, [&](btRigidBody& cube) {
    return std::make_unique<btPoint2PointConstraint>(cube, toBullet(Vec3(-start_W)));
  });
}

TEST(FirmContact, ADoorKeepsItsEnergy) {
  const Vec3 start_W(0.1, 0.0, 0.05);
  expectFirm(start_W, [&](btRigidBody& cube) {
    return std::make_unique<btHingeConstraint>(cube, toBullet(Vec3(-start_W)), btVector3(0, 1, 0));
  });
}

}  // namespace
}  // namespace tandem
