#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/coordination/types.h"

namespace tandem::demos::bench {

/// Action of the hand.
enum class SpeedTouch {
  kNothing,  ///< holds still, away from all bodies
  kCube,     ///< presses the first shared cube, which floats, and a remote user's proxy presses
             ///< back
  kOnFloor,  ///< the same, the cube on the floor
  kRow,      ///< pushes that cube along the floor into three boxes of the host's
};

/// A host's world to be timed, and its use.
struct SpeedScene {
  int bodies = 0;      ///< boxes of the host's on the floor, away from the rest
  bool awake = false;  ///< these never sleep; else they never wake
  int objects = 1;     ///< shared cubes, also on the floor
  SpeedTouch touch = SpeedTouch::kNothing;
  int users = 2;  ///< all but one are remote; the first of these touches the cube, too
};

[[nodiscard]] inline bool isPressed(const SpeedScene& scene) {
  return scene.touch == SpeedTouch::kCube || scene.touch == SpeedTouch::kOnFloor;
}

inline constexpr double kSpeedHalfEdge = 0.02;  ///< half edge of all cubes [m]
inline constexpr double kSpeedRadius = 0.01;    ///< radius of device and proxy [m]
inline constexpr double kSpeedMass = 0.1;       ///< mass of cubes and of the proxy [kg]

/// The world of a scene without Tandem: floor, host's boxes, cubes that may be shared, perhaps a
/// row of three. Cubes sleep except the touched one.
class SpeedWorld {
 public:
  /// `shared_mass_factor`: peers that carry a shared cube; a site takes a share of its mass.
  SpeedWorld(const SpeedScene& scene, double shared_mass_factor);
  ~SpeedWorld();
  SpeedWorld(const SpeedWorld&) = delete;
  SpeedWorld& operator=(const SpeedWorld&) = delete;

  [[nodiscard]] btDiscreteDynamicsWorld& world() { return world_; }
  [[nodiscard]] const std::vector<btRigidBody*>& cubes() const { return cubes_; }
  /// Adds a remote user's sphere as a body of the world: asleep or never asleep.
  btRigidBody& addProxy(const Vec3& p_W, bool awake);
  /// Steps the world without a hand [s].
  void step(double dt) { world_.stepSimulation(static_cast<btScalar>(dt), 0); }

 private:
  btRigidBody& addBody(btCollisionShape& shape, double mass, const Vec3& p_W);

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btStaticPlaneShape floor_shape_{btVector3(0, 0, 1), 0};
  btBoxShape box_shape_{toBullet(Vec3(Vec3::Constant(kSpeedHalfEdge)))};
  btSphereShape sphere_shape_{static_cast<btScalar>(kSpeedRadius)};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btRigidBody*> cubes_;
};

/// State of hand and remote user at a time [s].
[[nodiscard]] PointState handAt(const SpeedScene& scene, double time);
[[nodiscard]] PointState remoteAt(const SpeedScene& scene, double time);

}  // namespace tandem::demos::bench
