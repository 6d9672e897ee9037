#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "world/scene_bodies.h"
#include "world/scene_frame.h"
#include "world/scene_shapes.h"

namespace tandem::demos {

/// A body of one site's world, for pictures.
struct SceneBody {
  std::string name;
  std::string role;                   ///< object, proxy, device, neighbour or obstacle
  std::string colour;                 ///< "#rrggbb"; empty: that of its role
  const btRigidBody* body = nullptr;  ///< null: the device, which has no body in Bullet
  bool is_box = false;                ///< else a ball
  Vec3 half_extents = Vec3::Zero();  ///< of a box, or of the bounds of what is neither box nor ball
  double radius = 0.0;               ///< of a ball [m]
  bool is_static = false;
};

/// Bodies that begin elsewhere than the scenario says, by name.
using BodyPlaces = std::map<std::string, RigidState>;

/// A body of a scene in its Bullet world.
struct PlacedBody {
  PlannedBody plan;
  btRigidBody* body = nullptr;
};

/// A Bullet world with the bodies and joints of a scenario, as a host would have them.
class SceneWorld {
 public:
  /// Throws UsageError for a hull without volume.
  explicit SceneWorld(const Scenario& scenario, const BodyPlaces& places = {});
  ~SceneWorld();
  SceneWorld(const SceneWorld&) = delete;
  SceneWorld& operator=(const SceneWorld&) = delete;

  [[nodiscard]] btDiscreteDynamicsWorld& world() noexcept { return world_; }
  [[nodiscard]] const SceneFrame& frame() const noexcept { return frame_; }
  [[nodiscard]] const std::vector<PlacedBody>& bodies() const noexcept { return placed_; }

 private:
  void addBody(const PlannedBody& plan, double friction, const BodyPlaces& places);
  void addJoint(const JointScenario& joint, double host_step);

  SceneFrame frame_;
  SceneShapes shapes_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<PlacedBody> placed_;
};

/// A picture needs to know this of a body.
[[nodiscard]] SceneBody describeBody(const PlacedBody& placed);

}  // namespace tandem::demos
