// Bodies that Bullet puts onto a shared cube: it stands on its floor as firmly as without a site.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "host/any_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::WorldKind;

/// Ways to step the world: by Bullet alone, or by a site.
enum class PressBy { kBare, kHostStep, kCaller };
constexpr PressBy kSites[] = {PressBy::kHostStep, PressBy::kCaller};

constexpr double kHalfEdge = 0.02;    // of a cube [m]
constexpr double kCubeMass = 0.2;     // [kg]
constexpr double kTickPeriod = 1e-3;  // [s]

/// A cube on a floor that a site may share.
class PressScene {
 public:
  PressScene(PressBy way, double rate, int max_neighbours)
      : way_(way), step_(1.0 / rate), max_neighbours_(max_neighbours) {
    host_.addBody(host_.makeBox(Vec3(2, 2, 0.1)), 0.0, Vec3(0, 0, -0.1));
    cube_ = &addCube(kCubeMass, Vec3(0, 0, kHalfEdge));
  }
  ~PressScene() {
    site_.reset();
    for (auto& motor : motors_) host_.multi()->removeMultiBodyConstraint(motor.get());
  }
  PressScene(const PressScene&) = delete;
  PressScene& operator=(const PressScene&) = delete;

  [[nodiscard]] AnyHost& host() { return host_; }
  [[nodiscard]] btRigidBody& cube() const { return *cube_; }
  btRigidBody& addCube(double mass, const Vec3& p_W) {
    btRigidBody& cube = host_.addCube(mass, p_W);
    cube.setSleepingThresholds(0, 0);
    return cube;
  }
  /// Height of the centre [m].
  [[nodiscard]] static double height(const btRigidBody& body) {
    return static_cast<double>(body.getCenterOfMassPosition().z());
  }
  /// Makes a robot of cubic links on slides.
  btMultiBody& makeRobot(int links) {
    host_.multi_body =
        std::make_unique<btMultiBody>(links, btScalar(0), btVector3(0, 0, 0), true, false);
    return *host_.multi_body;
  }
  void addLink(int link, int parent, double mass, const Vec3& axis, const Vec3& p_parent) {
    btVector3 inertia;
    linkShape().calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    host_.multi_body->setupPrismatic(link, static_cast<btScalar>(mass), inertia, parent,
                                     btQuaternion::getIdentity(), toBullet(axis),
                                     toBullet(p_parent), btVector3(0, 0, 0), true);
  }
  void finishRobot(const Vec3& base_W, int first_collider) {
    btMultiBody& robot = *host_.multi_body;
    robot.setBasePos(toBullet(base_W));
    robot.finalizeMultiDof();
    robot.setUseGyroTerm(false);  // the island does not hold such a robot
    robot.setCanSleep(false);
    robot.setLinearDamping(0);
    host_.multi()->addMultiBody(&robot);
    btAlignedObjectArray<btQuaternion> turns;
    btAlignedObjectArray<btVector3> places;
    robot.forwardKinematics(turns, places);
    for (int link = first_collider; link < robot.getNumLinks(); ++link) {
      auto collider = std::make_unique<btMultiBodyLinkCollider>(&robot, link);
      collider->setCollisionShape(&linkShape());
      collider->setFriction(btScalar(0.8));
      host_.world->addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                                      btBroadphaseProxy::AllFilter);
      robot.getLink(link).m_collider = collider.get();
      host_.colliders.push_back(std::move(collider));
    }
    robot.updateCollisionObjectWorldTransforms(turns, places);
  }
  btMultiBodyJointMotor& addMotor(int link, double speed, double most) {
    motors_.push_back(std::make_unique<btMultiBodyJointMotor>(host_.multi_body.get(), link,
                                                              static_cast<btScalar>(speed),
                                                              static_cast<btScalar>(most * step_)));
    host_.multi()->addMultiBodyConstraint(motors_.back().get());
    return *motors_.back();
  }
  [[nodiscard]] Vec3 linkPosition(std::size_t collider) const {
    return fromBullet(host_.colliders[collider]->getWorldTransform().getOrigin());
  }
  [[nodiscard]] double step() const { return step_; }

  void start() {
    if (way_ == PressBy::kBare) return;
    SiteSettings settings;
    settings.peers = 1;
    settings.host_step = step_;
    settings.max_neighbours = max_neighbours_;
    if (way_ == PressBy::kCaller) settings.tick_source = TickSource::kCaller;
    site_ = std::make_unique<Site>(settings, *host_.world, device_);
    site_->share(*cube_);
  }

  /// Runs host steps, and ticks of 1 ms beside them; calls `each` after a host step.
  template <typename Each>
  void run(double duration, Each each) {
    for (const double end = time_ + duration; time_ < end - 1e-9; time_ += step_) {
      if (way_ == PressBy::kCaller && site_)
        for (; tick_ < time_ + step_ - 1e-9; tick_ += kTickPeriod) site_->tick(tick_);
      host_.step(step_);
      each();
    }
  }
  void run(double duration) {
    run(duration, [] {});
  }

 private:
  btCollisionShape& linkShape() {
    if (!link_shape_) link_shape_ = &host_.makeBox(Vec3::Constant(kHalfEdge));
    return *link_shape_;
  }

  PressBy way_;
  double step_;  // [s]
  int max_neighbours_;
  double time_ = 0.0, tick_ = 0.0;  // [s]
  AnyHost host_{WorldKind::kMultiBody, Vec3(0, 0, -9.81)};
  test::FakeDevice device_{Vec3(0.0, 0.0, 10.0)};
  btRigidBody* cube_ = nullptr;
  btCollisionShape* link_shape_ = nullptr;
  std::vector<std::unique_ptr<btMultiBodyJointMotor>> motors_;
  std::unique_ptr<Site> site_;
};

/// Deepest overlaps of a scene [m], and what is left of them at its end.
struct Overlap {
  double deepest = 0.0, last = 0.0;
  double highest = 0.0;  ///< rise of the cube over its floor [m]
  double speed = 0.0;    ///< fastest of the cube, at the end [m/s]

  void see(double overlap) { last = overlap, deepest = std::max(deepest, overlap); }
};

/// A pile of `count` cubes of `mass` [kg] on the shared one, dropped from 1 mm.
Overlap pile(PressBy way, double rate, int count, double mass, int cap) {
  PressScene scene(way, rate, cap);
  std::vector<btRigidBody*> bodies{&scene.cube()};
  for (int i = 0; i < count; ++i)
    bodies.push_back(&scene.addCube(mass, Vec3(0, 0, (2 * i + 3) * kHalfEdge + 1e-3)));
  scene.start();
  Overlap o;
  double time = 0;
  scene.run(2.0, [&] {
    double most = kHalfEdge - PressScene::height(scene.cube());
    o.highest = std::max(o.highest, -most);
    for (std::size_t i = 1; i < bodies.size(); ++i)
      most = std::max(most, PressScene::height(*bodies[i - 1]) + 2 * kHalfEdge -
                                PressScene::height(*bodies[i]));
    o.see(most);
    if ((time += scene.step()) > 1.0)
      o.speed = std::max(o.speed, static_cast<double>(scene.cube().getLinearVelocity().length()));
  });
  return o;
}

/// A link of 5 kg comes down on the cube by its weight.
Overlap pressByLink(PressBy way, double rate) {
  PressScene scene(way, rate, 16);
  scene.makeRobot(1);
  scene.addLink(0, -1, 5.0, Vec3::UnitZ(), Vec3::Zero());
  scene.finishRobot(Vec3(0, 0, 3 * kHalfEdge + 1e-3), 0);
  scene.start();
  Overlap o;
  double time = 0;
  scene.run(2.0, [&] {
    const double below = kHalfEdge - PressScene::height(scene.cube());
    o.highest = std::max(o.highest, -below);
    o.see(std::max(below,
                   PressScene::height(scene.cube()) + 2 * kHalfEdge - scene.linkPosition(0).z()));
    if ((time += scene.step()) > 1.0)
      o.speed = std::max(o.speed, static_cast<double>(scene.cube().getLinearVelocity().length()));
  });
  return o;
}

/// A gantry grips the cube with two fingers at 20 N, and then lifts it at 0.1 m/s.
Overlap grip(PressBy way, double rate, double& lifted) {
  PressScene scene(way, rate, 16);
  scene.makeRobot(3);
  const double apart = 2 * kHalfEdge + 2e-3;
  scene.addLink(0, -1, 1.0, Vec3::UnitZ(), Vec3::Zero());
  const double below = 0.1;  // of the gantry's head [m]
  scene.addLink(1, 0, 0.5, Vec3::UnitX(), Vec3(-apart, 0, -below));
  scene.addLink(2, 0, 0.5, Vec3::UnitX(), Vec3(apart, 0, -below));
  scene.finishRobot(Vec3(0, 0, kHalfEdge + 5e-3 + below), 0);
  btMultiBodyJointMotor& lift = scene.addMotor(0, 0.0, 200);
  scene.addMotor(1, 0.2, 20);
  scene.addMotor(2, -0.2, 20);
  scene.start();
  Overlap o;
  const auto look = [&] {
    const double x = static_cast<double>(scene.cube().getCenterOfMassPosition().x());
    o.see(std::max({kHalfEdge - PressScene::height(scene.cube()),
                    scene.linkPosition(1).x() + 2 * kHalfEdge - x,
                    x + 2 * kHalfEdge - scene.linkPosition(2).x()}));
  };
  scene.run(0.5, look);
  lift.setVelocityTarget(btScalar(0.1));
  const double start = PressScene::height(scene.cube());
  scene.run(1.0, look);
  lifted = PressScene::height(scene.cube()) - start;
  return o;
}

/// Checks a scene with both kinds of ticks against Bullet alone, at 60 and 240 Hz.
template <typename Scene>
void expectAsFirm(Scene scene) {
  for (const double rate : {60.0, 240.0}) {
    SCOPED_TRACE(rate);
    const Overlap bare = scene(PressBy::kBare, rate);
    for (const PressBy way : kSites) {
      const Overlap shared = scene(way, rate);
      EXPECT_LT(shared.deepest, 1.5 * bare.deepest);
      EXPECT_LT(shared.last, 1.5 * bare.last + 1e-4);
      EXPECT_LT(shared.highest, 2e-4);
      EXPECT_LT(shared.speed, 0.02);
    }
  }
}

TEST(Press, ALinkPressesTheCubeOntoTheFloor) { expectAsFirm(pressByLink); }

TEST(Press, ACubeBeyondTheCapStandsOnTheSharedOne) {
  expectAsFirm([](PressBy way, double rate) { return pile(way, rate, 1, kCubeMass, 0); });
}

TEST(Press, APileBeyondTheCapStandsOnTheSharedOne) {
  for (const int cap : {0, 2})
    expectAsFirm([=](PressBy way, double rate) { return pile(way, rate, 3, kCubeMass, cap); });
}

/// In Bullet alone it tips over at 60 Hz.
TEST(Press, ABodyOf25TimesTheMassStands) {
  const Overlap bare = pile(PressBy::kBare, 240.0, 1, 5.0, 0);
  for (const PressBy way : kSites)
    EXPECT_LT(pile(way, 240.0, 1, 5.0, 0).deepest, 1.5 * bare.deepest);
}

TEST(Press, ARobotGripsTheCubeAndLiftsIt) {
  for (const double rate : {60.0, 240.0}) {
    SCOPED_TRACE(rate);
    double bare_way = 0.0;
    const Overlap bare = grip(PressBy::kBare, rate, bare_way);
    for (const PressBy way : kSites) {
      double lifted = 0.0;
      EXPECT_LT(grip(way, rate, lifted).deepest, 1.5 * bare.deepest);
      EXPECT_NEAR(lifted, bare_way, 3e-3);
    }
  }
}

// A planar game: the supports of a tilted body that a stranger presses turn it in the plane only.
TEST(Press, TurnsNobodyOutOfItsPlane) {
  for (const PressBy way : kSites) {
    PressScene scene(way, 240.0, 0);
    scene.makeRobot(1);
    scene.addLink(0, -1, 2.0, Vec3::UnitZ(), Vec3::Zero());
    scene.finishRobot(Vec3(0.01, 0, 4 * kHalfEdge), 0);
    btRigidBody& cube = scene.cube();
    cube.setWorldTransform(toBullet(Vec3(0, 0, 1.5 * kHalfEdge),
                                    Quat(Eigen::AngleAxisd(0.4, Vec3(1, 0.5, 0.2).normalized()))));
    cube.setLinearFactor(btVector3(1, 0, 1));
    cube.setAngularFactor(btVector3(0, 1, 0));
    cube.updateInertiaTensor();
    scene.start();
    double turned = 0.0;
    scene.run(0.5, [&] {
      const Vec3 w_W = fromBullet(cube.getAngularVelocity());
      turned = std::max(turned, std::abs(w_W.y()));
      ASSERT_LT(std::hypot(w_W.x(), w_W.z()), test::byWidth(1e-9, 1e-3));
      ASSERT_LT(std::abs(static_cast<double>(cube.getLinearVelocity().y())), 1e-9);
    });
    EXPECT_GT(turned, 0.1);
  }
}

/// Highest speed of a leaning capsule that rubs on its floor along a slide, in 0.2 s [m/s].
double rubAlongASlide(bool shares, double rate) {
  constexpr double kLean = 0.23, kRadius = 0.017, kArm = 0.1;  // [rad, m, m]
  test::BulletRig rig(Vec3(0, 0, -9.81));
  rig.addBody(rig.makeShape<btBoxShape>(btVector3(2, 2, btScalar(0.1))), 0.0, Vec3(0, 0, -0.1));
  btCollisionShape& shape = rig.makeShape<btCapsuleShapeZ>(btScalar(kRadius), btScalar(0.028));
  const Quat lean(Eigen::AngleAxisd(kLean, Vec3::UnitY()));
  const Vec3 p_W(0, 0, kRadius + 0.014 * std::cos(kLean));
  const Vec3 way_W = lean * Vec3(2.0 * kArm, 0, 0);
  btRigidBody& body = rig.addBody(shape, 0.1, p_W, lean);
  btRigidBody& base = rig.addBody(shape, 0.0, p_W + way_W, lean);
  btSliderConstraint slide(body, base, toBullet(Vec3(kArm, 0, 0), Quat::Identity()),
                           toBullet(Vec3(-kArm, 0, 0), Quat::Identity()), true);
  rig.world.addConstraint(&slide, true);
  test::FakeDevice device(Vec3(0, 0, 10));
  SiteSettings settings;
  settings.peers = 1;
  settings.host_step = 1.0 / rate;
  std::optional<Site> site;
  if (shares) site.emplace(settings, rig.world, device).share(body);
  body.setLinearVelocity(btVector3(btScalar(-0.045), btScalar(-0.01), 0));
  body.setAngularVelocity(btVector3(btScalar(1.5), btScalar(0.2), 0));
  double most = 0.0;
  for (int i = 0; i < static_cast<int>(0.2 * rate); ++i) {
    rig.step(1.0 / rate);
    most = std::max(most, static_cast<double>(body.getLinearVelocity().length()));
  }
  site.reset();
  rig.world.removeConstraint(&slide);
  return most;
}

// Friction that is solved after the joints had opened the slide, more in each step: 17 m/s.
TEST(Press, FrictionOfSupportsLeavesASlideClosed) {
  for (const double rate : {60.0, 240.0, 720.0}) {
    const double bare = rubAlongASlide(false, rate);
    EXPECT_LT(rubAlongASlide(true, rate), 2.0 * bare) << rate;
  }
}

TEST(Press, LeavesTheCubeWhereItIsWhenItGoes) {
  for (const PressBy way : kSites) {
    PressScene scene(way, 60.0, 0);
    btRigidBody& other = scene.addCube(1.0, Vec3(0, 0, 3 * kHalfEdge));
    scene.start();
    scene.run(1.0);
    const int sweeps = scene.host().world->getSolverInfo().m_numIterations;
    EXPECT_EQ(sweeps, btContactSolverInfo().m_numIterations);
    EXPECT_EQ(scene.host().world->getNumConstraints(), 0);
    scene.host().world->removeRigidBody(&other);
    scene.run(0.5, [&] {
      EXPECT_NEAR(PressScene::height(scene.cube()), kHalfEdge, 1e-5);
      EXPECT_LT(static_cast<double>(scene.cube().getLinearVelocity().length()), 1e-3);
    });
    scene.host().world->addRigidBody(&other);
  }
}

// A ram pushes a pinned figure off its pin, and that touches a ball. Bullet holds the figure by
// itself against the pin, and gave the ball the ram's whole force as well: 40 m/s.
TEST(Press, ThrowsNoNeighbourOfAPinnedFigure) {
  constexpr double kRadius = 0.025, kLow = 0.012, kHalfRam = 0.02, kGap = 0.05,
                   kPace = 0.6;  // [m], [m/s]
  test::BulletRig rig(Vec3(0, 0, -9.81));
  rig.addBody(rig.makeShape<btBoxShape>(btVector3(2, 2, btScalar(0.1))), 0.0, Vec3(0, 0, -0.1));
  btCollisionShape& round = rig.makeShape<btSphereShape>(btScalar(kRadius));
  btRigidBody& figure = rig.addBody(round, 1.6, Vec3(0, 0, kRadius));
  figure.setAngularFactor(btVector3(0, 0, 0));
  figure.setLinearFactor(btVector3(1, 0, 1));
  btRigidBody& ball = rig.addBody(round, 0.6, Vec3(2.0 * kRadius + kGap, 0, kRadius));
  const auto placeOfRam = [&](double time) {
    return toBullet(Vec3(-kRadius - kHalfRam + kPace * time, 0, kLow), Quat::Identity());
  };
  btCollisionShape& block = rig.makeShape<btSphereShape>(btScalar(kHalfRam));
  btRigidBody& ram = rig.addBody(block, 0.0, fromBullet(placeOfRam(0.0).getOrigin()));
  rig.world.removeRigidBody(&ram);
  ram.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  ram.setActivationState(DISABLE_DEACTIVATION);
  rig.world.addRigidBody(&ram);
  btPoint2PointConstraint pin(figure, btVector3(0, 0, 0));
  rig.world.addConstraint(&pin);
  test::FakeDevice device(Vec3(0, 0, 10));
  SiteSettings settings;
  settings.max_neighbours = 0;
  settings.host_step = 1e-3;
  std::optional<Site> site;
  site.emplace(settings, rig.world, device);
  site->share(figure);
  site->share(ball);
  double fastest = 0.0;
  for (int i = 1; i <= 150; ++i) {
    ram.setWorldTransform(placeOfRam(i * settings.host_step));
    rig.step(settings.host_step);
    fastest = std::max(fastest, static_cast<double>(ball.getLinearVelocity().length()));
  }
  EXPECT_LT(fastest, 10.0 * kPace);
  site.reset();
  rig.world.removeConstraint(&pin);
}

}  // namespace
}  // namespace tandem
