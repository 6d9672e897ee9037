#pragma once

#include <vector>

#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include "surroundings/regions.h"

namespace tandem {

/// The triangles of a mesh, height field or other concave shape in a region, copied in the order in
/// which the shape tells them. The host may delete its shape meanwhile.
///
/// A large mesh is not copied whole: the work is proportional to the triangles that are near.
class TriangleRun {
 public:
  struct Triangle {
    btVector3 corners[3];
  };

  /// Copies the triangles that reach into `region`, in the shape's frame. A small shape is copied
  /// whole, so that nothing leaves the copy for long. In the host's thread; allocates.
  void gather(const btConcaveShape& shape, const Region& region);
  /// Region of which all triangles are here; empty before gather().
  [[nodiscard]] const Region& gathered() const noexcept { return gathered_; }
  [[nodiscard]] std::size_t size() const noexcept { return triangles_.size(); }

  /// Chooses the triangles in a region for visitClose(). Real-time safe.
  void look(const Region& region) noexcept;
  /// Calls `visit(triangle)` for the chosen ones. Real-time safe.
  template <typename Visit>
  void visitClose(Visit visit) {
    for (const int i : close_) visit(triangles_[static_cast<std::size_t>(i)]);
  }

 private:
  /// Triangles in a row share a box, and such boxes another: what follows in a run is near in
  /// space.
  static constexpr std::size_t kInBox = 16;

  void fillBoxes();

  std::vector<Triangle> triangles_;
  std::vector<Region> boxes_, large_boxes_;  ///< of kInBox triangles, of kInBox boxes
  std::vector<int> close_;
  Region gathered_ = kNoRegion;
};

}  // namespace tandem
