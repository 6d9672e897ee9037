// Bullet's linear and angular factors: games in a plane and figures that may not turn. Each scene
// runs in Bullet alone, with its body shared, and with its body as a neighbour of a shared cube.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::byWidth;
using test::kGravity;
using test::NeighbourScene;

/// Who moves the body of a scene.
enum class Role { kBullet, kShared, kNeighbour };
constexpr Role kHeld[] = {Role::kShared, Role::kNeighbour};

constexpr double kFine = 1000.0;  // rate at which Bullet's own error is small [Hz]

/// A float's host step may end just behind a tick, and impulses act a tick later [s].
constexpr double kTickMore = 1.01e-3;

std::string nameOf(Role role) {
  return role == Role::kBullet ? "Bullet " : role == Role::kShared ? "shared " : "neighbour ";
}

/// A body of the host, and a partner beside it. One of them is shared by one site, so that masses
/// stay; the other is its neighbour.
struct Pair : NeighbourScene {
  btRigidBody& body;
  btRigidBody& partner;

  Pair(Role role, btCollisionShape& shape, std::unique_ptr<btCollisionShape> own, double mass,
       const Vec3& p_W, const Vec3& p_partner_W, bool has_weight = true)
      : NeighbourScene(has_weight),
        body(rig.addBody(shape, mass, p_W)),
        partner(addBox(p_partner_W)) {
    rig.shapes.push_back(std::move(own));
    body.setSleepingThresholds(0, 0);
    body.setFriction(partner.getFriction());
    settings.peers = 1;
    if (has_weight) addFloor();
    role_ = role;
  }

  /// Begins with the factors that the bodies have now.
  void begin() {
    if (role_ == Role::kBullet) return;
    cube = role_ == Role::kShared ? &body : &partner;
    start();
  }
  [[nodiscard]] static double angleOf(const btRigidBody& rigid) {
    return fromBullet(rigid.getOrientation()).angularDistance(Quat::Identity());
  }
  void expectHeld() const {
    if (role_ == Role::kBullet) return;
    EXPECT_TRUE(site->isHeld(0));
    EXPECT_EQ(site->neighbourCount(), 1);
    EXPECT_EQ(site->status(), kTickOk);
  }

 private:
  Role role_;
};

template <typename ShapeType, typename... Arguments>
std::unique_ptr<Pair> makePair(Role role, double mass, const Vec3& p_W, const Vec3& p_partner_W,
                               bool has_weight, Arguments... arguments) {
  auto shape = std::make_unique<ShapeType>(arguments...);
  btCollisionShape& reference = *shape;
  return std::make_unique<Pair>(role, reference, std::move(shape), mass, p_W, p_partner_W,
                                has_weight);
}

std::unique_ptr<Pair> makeBoxes(Role role, const Vec3& p_W, const Vec3& p_partner_W,
                                bool has_weight = true) {
  const auto half = static_cast<btScalar>(NeighbourScene::kHalf);
  return makePair<btBoxShape>(role, NeighbourScene::kBoxMass, p_W, p_partner_W, has_weight,
                              btVector3(half, half, half));
}

void holdInPlane(btRigidBody& body) {
  body.setLinearFactor(btVector3(1, 0, 1));
  body.setAngularFactor(btVector3(0, 1, 0));
}

/// A game in the plane of x and z. The host pushes one of two boxes against the other, which stands
/// a little behind.
std::unique_ptr<Pair> playInPlane(Role role, double rate) {
  constexpr double kHalf = NeighbourScene::kHalf;
  auto scene = makeBoxes(role, Vec3(0.0, 0.0, kHalf), Vec3(0.045, 0.006, kHalf));
  for (btRigidBody* box : {&scene->body, &scene->partner}) holdInPlane(*box);
  scene->begin();
  scene->run(0.1, rate);
  for (int i = 0; i < static_cast<int>(rate) / 2; ++i) {
    // Off its centre, and out of the plane.
    scene->body.activate(true);
    scene->body.applyForce(btVector3(2, btScalar(0.5), 0),
                           btVector3(0, btScalar(0.01), btScalar(-0.005)));
    scene->run(1.0 / rate, rate);
    scene->expectHeld();
  }
  return scene;
}

// The length of its step is the only difference: Bullet alone is 23 mm off at 60 Hz.
TEST(Factors, AGameInAPlaneStaysInIt) {
  const auto alone = playInPlane(Role::kBullet, kFine);
  for (const Role role : kHeld)
    for (const double rate : {60.0, kFine}) {
      SCOPED_TRACE(nameOf(role) + std::to_string(rate));
      const auto scene = playInPlane(role, rate);
      EXPECT_NEAR(Pair::positionOf(scene->body).y(), 0.0, 1e-12);
      EXPECT_NEAR(Pair::positionOf(scene->partner).y(), 0.006, byWidth(1e-12, 1e-9));
      for (const btRigidBody* box : {&scene->body, &scene->partner})
        EXPECT_LT(Pair::angleOf(*box), 0.02);
      EXPECT_NEAR(Pair::positionOf(scene->body).x(), Pair::positionOf(alone->body).x(), 3e-3);
      EXPECT_NEAR(Pair::positionOf(scene->partner).x(), Pair::positionOf(alone->partner).x(), 3e-3);
    }
}

TEST(Factors, AHandTurnsABoxOfAPlanarGameInItsPlane) {
  NeighbourScene scene(true);
  scene.addFloor();
  scene.addCube(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  holdInPlane(*scene.cube);
  scene.start();
  scene.device.sample.hip.p_W = Vec3(-0.04, 0.008, 0.035);
  scene.run(0.3);
  scene.run(0.2, 60.0, [&] { scene.device.sample.hip.p_W.x() += 0.003; });
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).y(), 0.0, 1e-12);
  const Vec3 w_W = fromBullet(scene.cube->getAngularVelocity());
  EXPECT_EQ(w_W.x(), 0.0);
  EXPECT_EQ(w_W.z(), 0.0);
  EXPECT_GT(NeighbourScene::positionOf(*scene.cube).x(), 0.005);
}

constexpr double kWalk = 0.15;  // [m/s]

/// A figure that may not turn walks against a box for a second.
std::unique_ptr<Pair> walk(Role role, double rate) {
  auto scene = makePair<btCapsuleShapeZ>(role, 1.0, Vec3(-0.06, 0.004, 0.05),
                                         Vec3(0.0, 0.0, NeighbourScene::kHalf), true,
                                         btScalar(0.02), btScalar(0.06));
  scene->body.setAngularFactor(0);
  scene->body.setDamping(btScalar(0.1), btScalar(0.1));
  scene->begin();
  scene->run(1.0, rate, [&] {
    const btVector3 v = scene->body.getLinearVelocity();
    scene->body.setLinearVelocity(btVector3(btScalar(kWalk), v.y(), v.z()));
  });
  return scene;
}

TEST(Factors, AFigureThatMayNotTurnWalksUpright) {
  for (const double rate : {60.0, kFine}) {
    const auto alone = walk(Role::kBullet, rate);
    for (const Role role : kHeld) {
      SCOPED_TRACE(nameOf(role) + std::to_string(rate));
      const auto scene = walk(role, rate);
      scene->expectHeld();
      EXPECT_EQ(Pair::angleOf(scene->body), 0.0);
      EXPECT_NEAR(Pair::positionOf(scene->body).z(), 0.05, 1e-3);
      // Bullet brakes before it moves, and so loses mu g dt / 2 of the speed.
      const double allowed = 2e-3 + 0.5 * NeighbourScene::kFriction * kGravity / rate;
      EXPECT_NEAR(Pair::positionOf(scene->body).x(), Pair::positionOf(alone->body).x(), allowed);
      EXPECT_NEAR(Pair::positionOf(scene->partner).x(), Pair::positionOf(alone->partner).x(),
                  allowed);
    }
  }
}

// Bullet turns a body without angular factor on at the velocity that the host gave it.
TEST(Factors, AFigureIsTurnedByItsHost) {
  for (const Role role : kHeld) {
    SCOPED_TRACE(nameOf(role));
    auto scene = makeBoxes(role, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.048), false);
    scene->body.setAngularFactor(0);
    scene->begin();
    scene->run(0.1);
    scene->body.setAngularVelocity(btVector3(0, 0, 1));
    scene->run(0.5);
    scene->expectHeld();
    EXPECT_NEAR(Pair::angleOf(scene->body), 0.5, byWidth(1e-6, kTickMore));
  }
}

// v = L g t, L f t / m and A t / I: to rounding.
TEST(Factors, OtherFactorsScaleForcesAsInBullet) {
  for (const double rate : {60.0, 250.0}) {
    Vec3 v_W[3], w_W[3];
    for (const Role role : {Role::kBullet, Role::kShared, Role::kNeighbour}) {
      auto scene = makeBoxes(role, Vec3(0.0, 0.0, 1.0), Vec3(0.0, 0.046, 1.0));
      scene->partner.setGravity(btVector3(0, 0, 0));
      scene->body.setLinearFactor(btVector3(btScalar(0.5), 0, btScalar(0.05)));
      scene->body.setAngularFactor(btVector3(0, btScalar(0.25), 2));
      scene->begin();
      scene->run(0.1, rate);
      scene->expectHeld();
      scene->body.applyCentralImpulse(btVector3(btScalar(0.01), btScalar(0.01), 0));
      scene->body.applyTorqueImpulse(btVector3(btScalar(1e-5), 0, btScalar(2e-6)));
      for (int i = 0; i < 10; ++i) {
        scene->body.applyCentralForce(btVector3(btScalar(0.2), btScalar(0.3), 0));
        scene->body.applyTorque(btVector3(btScalar(1e-4), btScalar(1e-4), 0));
        scene->run(1.0 / rate, rate);
      }
      scene->run(0.1, rate);
      const auto i = static_cast<std::size_t>(role);
      v_W[i] = Pair::velocityOf(scene->body);
      w_W[i] = fromBullet(scene->body.getAngularVelocity());
    }
    EXPECT_GT(v_W[0].x(), 0.02);
    EXPECT_GT(w_W[0].y(), 0.01);
    for (const int held : {1, 2}) {
      EXPECT_NEAR((v_W[held] - v_W[0]).norm(), 0.0, byWidth(1e-10, 1e-5)) << rate;
      EXPECT_NEAR((w_W[held] - w_W[0]).norm(), 0.0, byWidth(1e-6, 1e-4)) << rate;
      EXPECT_EQ(v_W[held].y(), 0.0);
    }
  }
}

TEST(Factors, AreFollowedAtRunTime) {
  for (const Role role : kHeld) {
    SCOPED_TRACE(nameOf(role));
    auto scene = makeBoxes(role, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.048), false);
    scene->begin();
    scene->run(0.1);
    const auto push = [&] {
      scene->body.activate(true);
      scene->body.applyCentralForce(btVector3(btScalar(0.2), 0, 0));
      scene->body.applyTorque(btVector3(btScalar(1e-5), 0, 0));
    };
    push();
    scene->run(0.1);
    const Vec3 v_W = Pair::velocityOf(scene->body);
    const Vec3 w_W = fromBullet(scene->body.getAngularVelocity());
    EXPECT_GT(v_W.x(), 0.01);
    EXPECT_GT(w_W.x(), 0.001);
    scene->body.setLinearFactor(btVector3(0, 1, 1));
    scene->body.setAngularFactor(btVector3(0, 1, 1));
    for (int i = 0; i < 12; ++i) push(), scene->run(1.0 / 60.0);
    scene->expectHeld();
    EXPECT_NEAR(Pair::velocityOf(scene->body).x(), v_W.x(), byWidth(1e-12, 1e-6));
    EXPECT_NEAR(fromBullet(scene->body.getAngularVelocity()).x(), w_W.x(), byWidth(1e-12, 1e-6));
    scene->body.setLinearFactor(btVector3(1, 1, 1));
    for (int i = 0; i < 6; ++i) push(), scene->run(1.0 / 60.0);
    EXPECT_NEAR(Pair::velocityOf(scene->body).x(), v_W.x() + 0.1, 0.03);
  }
}

// A locked axis ignores forces, but not the host.
TEST(Factors, AHostSetsTheVelocityAlongALockedAxis) {
  for (const Role role : kHeld) {
    SCOPED_TRACE(nameOf(role));
    auto scene = makeBoxes(role, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.048), false);
    scene->body.setLinearFactor(btVector3(0, 1, 1));
    scene->begin();
    scene->run(0.1);
    scene->body.setLinearVelocity(btVector3(btScalar(0.01), 0, 0));
    scene->run(0.5);
    EXPECT_NEAR(Pair::velocityOf(scene->body).x(), 0.01, byWidth(1e-12, 1e-8));
    EXPECT_NEAR(Pair::positionOf(scene->body).x(), 0.005, byWidth(1e-9, 0.01 * kTickMore));
  }
}

}  // namespace
}  // namespace tandem
