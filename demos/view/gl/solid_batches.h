#pragma once

#include <vector>

#include "gl/mesh_store.h"
#include "gl/shadow_frame.h"

namespace tandem::view {

/// A body's pose and colour on the graphics card.
struct SolidInstance {
  float origin[3];  ///< p_WB [m]
  float turn[4];    ///< q_WB as x, y, z, w
  float colour[3];  ///< linear
};

/// Bodies with one mesh, drawn by one call.
struct SolidBatch {
  StoredMesh* mesh = nullptr;  ///< stays valid until the store's next frame
  bool has_grid = false;
  std::vector<SolidInstance> instances;  ///< from near to far
};

/// A draw list, ready to be drawn.
struct SolidBatches {
  std::vector<SolidBatch> batches;  ///< in the order in which the list first names their meshes
  std::vector<BoundingBall> casters;
  std::vector<Line> ghost_lines;
};

/// Groups the bodies of a list. Bodies without a mesh or with a pose that is not finite are left
/// out.
[[nodiscard]] SolidBatches groupSolids(const DrawList& list, const Eye& eye, MeshStore& store);

}  // namespace tandem::view
