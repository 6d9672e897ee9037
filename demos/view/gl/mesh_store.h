#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "gl/gl_object.h"
#include "gl/mesh_edges.h"
#include "scene/shape_mesh.h"

namespace tandem::view {

/// A mesh on the graphics card.
struct StoredMesh {
  GlVertexArray array;  ///< has points and normals; instances are set for each use
  GlBuffer vertices, indices;
  int index_count = 0;
  double radius = 0.0;  ///< of the sphere about the body's origin that holds it [m]
  std::optional<std::vector<MeshEdge>> edges;  ///< made when a ghost first needs them
  std::uint64_t last_use = 0;                  ///< counts frames
};

/// Keeps meshes on the graphics card from frame to frame. It knows a mesh by its owner as well as
/// its address, so a new mesh at a freed one's address is a new mesh. It shares no ownership.
class MeshStore {
 public:
  /// Begins a frame. Drops meshes that are gone or have not been used for 300 frames.
  void beginFrame();
  /// Gives the stored form of a mesh, which stays in place until the next frame.
  [[nodiscard]] StoredMesh& find(const std::shared_ptr<const ShapeMesh>& mesh);
  [[nodiscard]] std::size_t size() const noexcept { return meshes_.size(); }

 private:
  struct Key {
    std::weak_ptr<const ShapeMesh> owner;
    const ShapeMesh* address = nullptr;  // compared only

    bool operator<(const Key& other) const noexcept {
      if (owner.owner_before(other.owner)) return true;
      return !other.owner.owner_before(owner) && std::less<>()(address, other.address);
    }
  };

  std::map<Key, StoredMesh> meshes_;
  std::uint64_t frame_ = 0;
};

}  // namespace tandem::view
