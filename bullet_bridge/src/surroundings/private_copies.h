#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "coordination/src/island/collision_filter.h"
#include "coordination/src/island/contact_finder.h"
#include "surroundings/own_filters.h"
#include "surroundings/regions.h"

class btConcaveShape;
class btStaticPlaneShape;

namespace tandem {

/// Surface properties of an object, and its owner's user data, which callbacks of the host's may
/// turn into others.
struct Surface {
  btScalar friction = 0, rolling_friction = 0, spinning_friction = 0, restitution = 0;
  void* user_pointer = nullptr;
  int user_index = -1, user_index2 = -1, user_index3 = -1;

  [[nodiscard]] static Surface of(const btCollisionObject& object) noexcept;
  bool operator==(const Surface&) const noexcept = default;
};

/// Tells whether a shape was changed, or made anew at its address.
struct ShapeLook {
  const btCollisionShape* shape = nullptr;  ///< compare before reading
  btVector3 scaling{0, 0, 0};
  btScalar margin = 0;
  Region bounds{};   ///< in the shape's frame
  int revision = 0;  ///< of a compound

  [[nodiscard]] static ShapeLook of(const btCollisionShape& shape);
  bool operator==(const ShapeLook& other) const noexcept;
};

/// A convex shape, plane or mesh of a copied object, alone or out of a compound.
struct Part {
  std::unique_ptr<btCollisionShape> shape;    ///< null: a mesh
  const btConcaveShape* host_mesh = nullptr;  ///< for the host's thread only
  btScalar mesh_margin = 0;
  Region bounds{};           ///< of a mesh, in its frame
  btTransform pose;          ///< in its object
  Vec3 half = Vec3::Zero();  ///< half extents of the host's box, if it is one [m]
  std::unique_ptr<btCollisionShape> large = {};  ///< enlarge(*shape)
};

/// A pose from the private origin: as Bullet gets it, and the position in double.
struct PrivatePose {
  btTransform rounded;
  Vec3 p;
};

/// Private copy of a host's object for the contact search: same shape, own pose. It reads nothing
/// of the host's once made; of meshes TriangleRun copies what is near.
struct PrivateCopy {
  /// `index`: the island body, or kStanding.
  PrivateCopy(btCollisionObject& host_object, BodyIndex index);

  /// Pose of a standing original relative to `origin_W`.
  [[nodiscard]] PrivatePose findOriginal(const Vec3& origin_W) const;
  void place(const PrivatePose& pose);
  /// Places a body.
  void place(const Vec3& p, const Quat& q);
  /// False: a shape is none that can be copied. Its contact stays Bullet's.
  [[nodiscard]] bool isWhole() const noexcept { return !parts.empty(); }
  /// True if the original, which must be in its world, is that object and has the shape that was
  /// copied.
  [[nodiscard]] bool isAsCopied() const;
  /// Bounds of a part while its object is at `pose`.
  [[nodiscard]] static Region computeBounds(const Part& part, const btTransform& pose);
  /// False if the host made another object at its address. It must be in its world.
  [[nodiscard]] bool holdsOwnFilters() const {
    return OwnFilters::countIn(*original) == own_filters;
  }
  /// True if the host changed what the original may touch since the last call. It must exist.
  [[nodiscard]] bool hasNewFilters() noexcept;
  /// The same, and the next call says so again.
  [[nodiscard]] bool hasOtherFilters() const noexcept;

  btCollisionObject* original;  ///< the host may have deleted it: compare, do not read
  bool may_keep_filters;        ///< false: a link of a multi-body asks no list of ignored objects
  ShapeLook look;
  Surface surface;              ///< as last read
  bool is_new_surface = false;  ///< it changed when last read
  BodyIndex index;
  std::vector<Part> parts;
  bool is_compound = false;
  const btStaticPlaneShape* plane = nullptr;  ///< the only part if a plane, through its origin
  btScalar skin = 0;                          ///< excess over the host's shape, all round [m]
  btScalar breaking_threshold = 0;            ///< contact farther than this is none [m]
  bool asks_host = false;                     ///< the host's callback decides on its contact
  btCollisionObject object;                   ///< holds the pose; has no shape
  int world_index = -1;                       ///< last index of the original in the host's world
  CollisionFilter filter;                     ///< the host's group and mask at the last look
  int own_filters = 0;                        ///< that the original should hold (OwnFilters)
  int host_filters = 0;                       ///< of the host in it, at the last look
  Vec3 p_placed = Vec3::Zero();               ///< last position, from the private origin [m]
  Quat q_placed = Quat::Identity();
  Eigen::Matrix3d axes_placed = Eigen::Matrix3d::Identity();  ///< the same as a matrix
  Region bounds;  ///< box around the copy at its last pose

 private:
  void moveTo(const btTransform& pose);
};

/// True if the host changes contact points of the object by its callback.
[[nodiscard]] bool asksContactCallback(const btCollisionObject& object) noexcept;

}  // namespace tandem
