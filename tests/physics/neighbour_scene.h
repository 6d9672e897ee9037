#pragma once

#include <memory>
#include <vector>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem::test {

inline constexpr double kGravity = 9.81;  // [m/s^2], along -z

/// A host's world of 4 cm boxes with one shared cube of 0.1 kg (the copy), and a hand.
struct NeighbourScene {
  static constexpr double kHalf = 0.02;     // [m]
  static constexpr double kCubeMass = 0.1;  // mass of the copy [kg]
  static constexpr double kBoxMass = 0.2;   // mass of each other box [kg]
  static constexpr double kFriction = 0.3;  // coefficient of every pair

  BulletRig rig;
  test::FakeDevice device{Vec3(0.0, 0.0, 10.0)};
  SiteSettings settings;
  btRigidBody* cube = nullptr;
  std::vector<btRigidBody*> boxes;
  std::unique_ptr<Site> site;

  explicit NeighbourScene(bool has_weight = false)
      : rig(has_weight ? Vec3(0.0, 0.0, -kGravity) : Vec3(0.0, 0.0, 0.0)) {
    settings.contact = {2000.0, 10.0};
    settings.coordination = {0.0, 0.0};
  }

  btRigidBody& addFloor() {
    // Bullet's own boxes of this size rattle on a plane: the floor is a box.
    const btVector3 half(2, 2, btScalar(0.1));
    return rub(rig.addBody(rig.makeShape<btBoxShape>(half), 0.0, Vec3(0.0, 0.0, -0.1)));
  }
  btRigidBody& addWall(double x) {
    const btVector3 half(btScalar(0.05), btScalar(0.2), btScalar(0.2));
    return rub(rig.addBody(rig.makeShape<btBoxShape>(half), 0.0, Vec3(x + 0.05, 0.0, 0.0)));
  }
  btRigidBody& addBox(const Vec3& p_W, double mass = kBoxMass) {
    boxes.push_back(&rub(rig.addCube(mass, kHalf, p_W)));
    // Bullet would put a body to sleep that drifts at 0.5 m/s, and stop it.
    boxes.back()->setSleepingThresholds(0, 0);
    return *boxes.back();
  }
  void addCube(const Vec3& p_W) { cube = &rub(rig.addCube(2.0 * kCubeMass, kHalf, p_W)); }
  /// Shares a cube there, unless there is one. All other bodies should be in place first.
  void start(const Vec3& p_W = Vec3::Zero()) {
    if (cube == nullptr) addCube(p_W);
    site = std::make_unique<Site>(settings, rig.world, device);
    site->share(*cube);
  }
  void run(double duration, double rate = 60.0) {
    run(duration, rate, [] {});
  }
  template <typename Each>
  void run(double duration, double rate, Each each) {
    const int steps = static_cast<int>(duration * rate + 0.5);
    for (int i = 0; i < steps; ++i) {
      rig.step(1.0 / rate);
      each();
    }
  }

  /// Momentum of the cube and all boxes in the host's world.
  [[nodiscard]] Vec3 momentum() const {
    Vec3 sum = kCubeMass * fromBullet(cube->getLinearVelocity());
    for (const btRigidBody* box : boxes)
      sum += fromBullet(box->getLinearVelocity()) / static_cast<double>(box->getInvMass());
    return sum;
  }
  /// Kinetic energy, and potential energy under the scene's weight [J].
  [[nodiscard]] double energy() const {
    double sum = energyOf(*cube);
    for (const btRigidBody* box : boxes) sum += energyOf(*box);
    return sum;
  }
  [[nodiscard]] double energyOf(const btRigidBody& body) const {
    const double mass = 1.0 / static_cast<double>(body.getInvMass());
    const Vec3 v = fromBullet(body.getLinearVelocity());
    const Vec3 w_B =
        fromBullet(body.getOrientation()).conjugate() * fromBullet(body.getAngularVelocity());
    return 0.5 * mass * v.squaredNorm() +
           0.5 * w_B.dot(fromBullet(body.getLocalInertia()).cwiseProduct(w_B)) -
           mass * fromBullet(rig.world.getGravity()).dot(positionOf(body));
  }
  [[nodiscard]] static Vec3 positionOf(const btRigidBody& body) {
    return fromBullet(body.getCenterOfMassPosition());
  }
  [[nodiscard]] static Vec3 velocityOf(const btRigidBody& body) {
    return fromBullet(body.getLinearVelocity());
  }

 private:
  /// Bullet multiplies the friction of the two bodies.
  static btRigidBody& rub(btRigidBody& body) {
    body.setFriction(static_cast<btScalar>(std::sqrt(kFriction)));
    return body;
  }
};

}  // namespace tandem::test
