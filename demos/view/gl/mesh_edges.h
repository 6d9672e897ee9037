#pragma once

#include <vector>

#include "scene/draw_list.h"

namespace tandem::view {

/// An edge of a surface, with the outward normals of its two faces; in the body's frame [m].
struct MeshEdge {
  Vec3 from_B, to_B;
  Vec3 n1_B, n2_B;
  bool is_sharp =
      false;  ///< drawn from everywhere: faces meet at more than 35 degrees, or it is open
};

/// Edges of a mesh at which its shading breaks. Flat faces and round surfaces have none inside.
/// Vertices at the same place are one. Allocates; costs about as much as a sort of the triangles.
[[nodiscard]] std::vector<MeshEdge> computeMeshEdges(const ShapeMesh& mesh);

/// Appends the lines by which a body is drawn as a ghost: its sharp edges and its outline as seen
/// from the eye. `edges` are those of its mesh.
void appendGhostLines(const Solid& solid, const std::vector<MeshEdge>& edges, const Vec3& p_WEye,
                      std::vector<Line>& lines);

}  // namespace tandem::view
