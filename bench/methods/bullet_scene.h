#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "bench/methods/bullet_joints.h"
#include "bench/methods/method.h"

namespace tandem::demos::bench {

/// Options of a scene in Bullet.
struct BulletSceneOptions {
  bool has_tools = true;     ///< tools become rigid bodies
  bool tools_touch = false;  ///< tools touch bodies by Bullet's own contact
  /// Keeps bodies in the x-z plane. Bullet's boxes otherwise creep sideways under load, with or
  /// without friction.
  bool keeps_plane = true;
  double shared_mass_factor = 1.0;  ///< factor on mass and inertia of shared bodies
};

/// A scene as a plain btDiscreteDynamicsWorld. Gravity acts on bodies, not on tools. Bullet
/// multiplies the friction of two bodies, so each has the root of the scene's; tools have 0.
class BulletScene {
 public:
  BulletScene(const BenchScene& scene, const BulletSceneOptions& options);
  ~BulletScene();
  BulletScene(const BulletScene&) = delete;
  BulletScene& operator=(const BulletScene&) = delete;

  [[nodiscard]] const BenchScene& scene() const { return scene_; }
  [[nodiscard]] btDiscreteDynamicsWorld& world() { return world_; }
  [[nodiscard]] btRigidBody& tool(std::size_t i) { return *tools_[i]; }
  [[nodiscard]] btRigidBody& body(std::size_t i) { return *bodies_[i]; }
  [[nodiscard]] const btRigidBody& body(std::size_t i) const { return *bodies_[i]; }

  /// Moves belts, which are kinematic bodies, and steps the world by `h` [s] at once.
  void step(double h);

  /// Reads states of bodies, and of tools if there are any.
  void read(SceneState& state) const;

 private:
  btRigidBody& add(std::vector<std::unique_ptr<btRigidBody>>& list,
                   std::unique_ptr<btCollisionShape> shape, double mass, const Vec3& inertia,
                   const RigidState& start, double friction, int group, int mask);

  const BenchScene& scene_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> tools_, bodies_;
  std::unique_ptr<BulletJoints> joints_;
  double time_ = 0.0;  ///< of steps [s]
};

[[nodiscard]] PointState pointOf(const btRigidBody& body);
[[nodiscard]] RigidState stateOf(const btRigidBody& body);

}  // namespace tandem::demos::bench
