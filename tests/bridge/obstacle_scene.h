#pragma once

#include <vector>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/surroundings/obstacles.h"

namespace tandem::test {

/// True if a body at `at`, with that index and reach, could touch any obstacle.
inline bool isNear(Obstacles& obstacles, BodyIndex body, const RigidState& at, double reach) {
  const auto i = static_cast<std::size_t>(body);
  const std::vector<RigidState> states(8, at);
  std::vector<double> reaches(states.size(), -1.0);
  std::vector<char> awake(states.size(), 0), near(states.size(), 0);
  reaches[i] = reach;
  awake[i] = 1;
  obstacles.lookAround(states, reaches, awake, near);
  return near[i] != 0;
}

/// A 4 cm cube of 0.1 kg with friction 1, alone in an island among obstacles. Obstacles are
/// searched at 240 Hz.
class ObstacleScene {
 public:
  static constexpr double kHalf = 0.02;  // [m]
  static constexpr double kMass = 0.1;   // [kg]
  static constexpr double kGravity = 9.81;

  explicit ObstacleScene(const Vec3& origin = Vec3::Zero()) : origin_(origin) {}

  btRigidBody& addObstacle(btCollisionShape& shape, double friction, const Vec3& p = Vec3::Zero(),
                           const Quat& q = Quat::Identity()) {
    btRigidBody& body = rig.addBody(shape, 0.0, origin_ + p, q);
    body.setFriction(static_cast<btScalar>(friction));
    return body;
  }
  /// A floor with its surface at y = 0.
  btRigidBody& addPlane(double friction) {
    return addObstacle(rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)),
                       friction);
  }
  btRigidBody& addBoxFloor(double friction) {
    return addObstacle(rig.makeShape<btBoxShape>(btVector3(5, btScalar(0.5), 5)), friction,
                       Vec3(0, -0.5, 0));
  }

  /// Puts the cube there and starts the search for obstacles.
  void start(const Vec3& p, const Quat& q = Quat::Identity(), double restitution = 0.0) {
    btRigidBody& cube = rig.addCube(kMass, kHalf, origin_ + p, q);
    cube.setFriction(1);
    cube.setRestitution(static_cast<btScalar>(restitution));
    inertia = fromBullet(cube.getLocalInertia()).x();
    obstacles.addBody(0, cube);
    state.p_W = fromBullet(cube.getCenterOfMassPosition());
    state.q_WB = fromBullet(cube.getOrientation());
    search();
  }

  void search() { obstacles.update({state}, 0.04); }

  /// Moves the cube for `duration` [s] under its weight (unless `weightless`) and `force`. Calls
  /// `each` after every inner step.
  template <typename Each>
  void run(double duration, double dt, const Vec3& force, Each each) {
    const int steps = static_cast<int>(duration / dt + 0.5);
    const int per_search = static_cast<int>(1.0 / 240.0 / dt + 0.5);
    Island island = makeIsland(dt);
    const Vec3 weight = weightless ? Vec3(0, 0, 0) : Vec3(0, -kMass * kGravity, 0);
    island.setExternalWrench(0, force + weight, Vec3::Zero());
    for (int i = 0; i < steps; ++i) {
      if (i % std::max(per_search, 1) == 0) search();
      island.setState(0, state);
      island.advance(dt);
      state = island.state(0);
      each();
    }
  }
  void run(double duration, double dt, const Vec3& force = Vec3::Zero()) {
    run(duration, dt, force, [] {});
  }

  /// An island with the cube as its only body, which moves by `dt` in one inner step.
  [[nodiscard]] Island makeIsland(double dt) {
    IslandSettings settings;
    settings.haptic_period = settings.inner_step = dt;
    Island island(settings);
    IslandBody cube;
    cube.shape = Box{Vec3::Constant(kHalf)};
    cube.mass = kMass;
    cube.inertia_B = Vec3::Constant(inertia);
    cube.is_rigid = true;
    cube.start = state;
    island.addBody(cube);
    island.setContactFinder(&obstacles);
    island.prepare();
    return island;
  }

  [[nodiscard]] Vec3 position() const { return state.p_W - origin_; }
  [[nodiscard]] double energy() const {
    return 0.5 * kMass * state.v_W.squaredNorm() + 0.5 * inertia * state.w_W.squaredNorm() +
           kMass * kGravity * position().y();
  }

  BulletRig rig;
  Obstacles obstacles{rig.world};
  RigidState state;
  double inertia = 0.0;
  bool weightless = false;

 private:
  Vec3 origin_;
};

}  // namespace tandem::test
