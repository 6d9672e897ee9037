#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "scene/draw_list.h"
#include "scene/world_lines.h"

namespace tandem::view {

/// How a body is called and painted.
struct BodyLook {
  std::string name;
  Colour colour;
};

/// Only the addresses are used, so a body may be gone.
using BodyLooks = std::unordered_map<const btCollisionObject*, BodyLook>;

/// Makes the draw list of a world of Bullet, whatever is in it.
///
/// Each collision object with a surface gives one solid, in Bullet's order. Objects without contact
/// response are ghosts. Objects whose pose is not finite are left out. An object that is not in the
/// table gets a name of its kind and a number, such as `dynamic 2`, and a calm colour: grey for
/// static ones, blue-grey for kinematic ones, one of eight by its number for the others. An object
/// keeps its number while it is in the world.
///
/// Meshes are kept while a shape is used and made anew when computeShapeKey() changes. Use one
/// WorldLook for each world, in the thread that steps it. The lists may go to other threads.
class WorldLook {
 public:
  explicit WorldLook(BodyLooks looks = {}) : looks_(std::move(looks)) {}

  /// Replaces the table of names and colours.
  void setBodyLooks(BodyLooks looks) { looks_ = std::move(looks); }

  /// Makes the list of what is in the world now. The world's state does not change. Allocates.
  [[nodiscard]] DrawList look(btDiscreteDynamicsWorld& world, const WorldDetails& details = {});

  /// Makes all meshes anew at the next look. For a host that changed the vertices of a mesh or the
  /// heights of a field in place, which no key shows.
  void forgetMeshes() { meshes_.clear(); }

  [[nodiscard]] std::size_t meshCount() const { return meshes_.size(); }

 private:
  struct KeptMesh {
    std::shared_ptr<const ShapeMesh> mesh;
    std::uint64_t last_look = 0;
  };
  struct KeptNumber {
    std::uint32_t number = 0;
    std::uint64_t last_look = 0;
  };

  std::shared_ptr<const ShapeMesh> meshOf(const btCollisionShape& shape);
  std::uint32_t numberOf(const btCollisionObject& object);
  BodyLook lookOf(const btCollisionObject& object);
  void addSolid(DrawList& list, const btCollisionObject& object);
  void dropUnused();

  BodyLooks looks_;
  std::unordered_map<std::uint64_t, KeptMesh> meshes_;  // by computeShapeKey()
  std::unordered_map<const btCollisionObject*, KeptNumber> numbers_;
  std::uint32_t next_number_ = 0;
  std::uint64_t look_count_ = 0;
};

}  // namespace tandem::view
