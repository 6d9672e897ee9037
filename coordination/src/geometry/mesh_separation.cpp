#include <array>
#include <limits>

#include "geometry/face_heights.h"
#include "geometry/held_face.h"
#include "geometry/mesh_pieces.h"
#include "geometry/triangle_mesh.h"

// clang-format off
// Each feature of a triangle (its face, or an edge or corner that it owns) has a region. It pushes
// a centre inside its region, where all margins of the region are positive.
//
//                |  face of A  |  edge  /
//                |    region   |  of A / face of B
//         -------+-------------+      /
//                      A        \    /
//                              B \  /
// clang-format on

namespace tandem {
namespace {

using Meeting = TriangleMesh::Meeting;

/// Within this distance of the plane between two regions, a fixed tiny shift decides the region
/// [m]. The centre is then in exactly one, however many planes meet there.
constexpr double kOnPlane = 1e-12;

/// Rounding error of a depth [m].
constexpr double kSameDepth = 1e-12;

/// Height of c over the plane through p, never 0. `normal` and its opposite give opposite heights.
double computeMargin(const PlainVec& c, const Vec3& p, const Vec3& normal) noexcept {
  const double height = dot(PlainVec(normal), c - PlainVec(p));
  if (std::abs(height) > kOnPlane) return height;
  const double moved =
      normal.x() != 0.0 ? normal.x() : (normal.y() != 0.0 ? normal.y() : normal.z());
  return moved > 0.0 ? kOnPlane : -kOnPlane;
}

const TriangleMesh::Edge& edgeAt(const TriangleMesh& mesh, int place) noexcept {
  return triangleAt(mesh, place / 3).edges[static_cast<std::size_t>(place % 3)];
}

/// True if the centre is beyond a concave edge: the face's region continues behind the other wall.
bool goesOnBehind(const TriangleMesh::Edge& edge, const PlainVec& c) noexcept {
  return edge.meeting == Meeting::kConcave && computeMargin(c, edge.start, edge.inward) < 0.0;
}

/// Margin of the face's region, counting only the triangle and its neighbours [m]. An open surface
/// that was touched pushes from any depth.
double computeOwnMargin(const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle,
                        const PlainVec& c, int touched) noexcept {
  std::array<bool, 3> behind;
  for (std::size_t k = 0; k < 3; ++k) behind[k] = goesOnBehind(triangle.edges[k], c);
  const bool is_beyond = behind[0] || behind[1] || behind[2];
  double margin = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const TriangleMesh::Edge& edge = triangle.edges[k];
    if (behind[k]) {
      margin = std::min(margin, -heightOver(triangleAt(mesh, edge.mate / 3), c));
      // Limited by the ends of the edge, unless the face also continues behind the next wall there.
      const bool is_turned = edge.start != triangle.corners[k].p;
      if (!behind[(k + (is_turned ? 1 : 2)) % 3])
        margin = std::min(margin, computeMargin(c, edge.start, edge.along));
      if (!behind[(k + (is_turned ? 2 : 1)) % 3])
        margin = std::min(margin, -computeMargin(c, edge.end, edge.along));
    } else if (edge.meeting != Meeting::kConcave &&
               !(is_beyond && edge.meeting == Meeting::kFlat)) {
      margin = std::min(margin, computeMargin(c, edge.start, edge.inward));
    }
  }
  if (!mesh.isClosed() && touched < 0)
    margin = std::min(margin, heightOver(triangle, c) + TriangleMesh::kDeepest);
  return margin;
}

double computeEdgeMargin(const TriangleMesh& mesh, const TriangleMesh::Edge& edge,
                         const PlainVec& c) noexcept {
  double margin =
      std::min(computeMargin(c, edge.start, edge.along), -computeMargin(c, edge.end, edge.along));
  margin = std::min(margin, -computeMargin(c, edge.start, edge.inward));
  if (edge.mate >= 0) {
    const TriangleMesh::Edge& mate = edgeAt(mesh, edge.mate);
    margin = std::min(margin, -computeMargin(c, mate.start, mate.inward));
  }
  return margin;
}

double computeCornerMargin(const TriangleMesh& mesh, const TriangleMesh::Corner& corner,
                           const PlainVec& c) noexcept {
  double margin = std::numeric_limits<double>::infinity();
  const Vec3* direction = mesh.directions(corner);
  for (int i = 0; i < corner.count; ++i)
    margin = std::min(margin, -computeMargin(c, corner.p, direction[i]));
  return margin;
}

/// Margin of a triangle's feature [m]; -infinity if the triangle does not own it.
double computeFeatureMargin(const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle,
                            int feature, const PlainVec& c, int touched) noexcept {
  if (feature == kMeshFace) return computeOwnMargin(mesh, triangle, c, touched);
  if (feature < kMeshCorner) {
    const auto& edge = triangle.edges[static_cast<std::size_t>(feature - kMeshEdge)];
    return edge.is_owner ? computeEdgeMargin(mesh, edge, c) : -HUGE_VAL;
  }
  const auto& corner = triangle.corners[static_cast<std::size_t>(feature - kMeshCorner)];
  return corner.is_owner ? computeCornerMargin(mesh, corner, c) : -HUGE_VAL;
}

/// Separation by one feature, valid wherever the centre is.
Separation leaveByFeature(const TriangleMesh::Triangle& triangle, int feature,
                          const PlainVec& c) noexcept {
  const PlainVec normal(triangle.normal);
  if (feature == kMeshFace) return {heightOver(triangle, c), normal, feature};
  PlainVec way;
  if (feature < kMeshCorner) {
    const auto& edge = triangle.edges[static_cast<std::size_t>(feature - kMeshEdge)];
    const PlainVec along(edge.along), from_start = c - PlainVec(edge.start);
    way = from_start - dot(along, from_start) * along;
  } else {
    way = c - PlainVec(triangle.corners[static_cast<std::size_t>(feature - kMeshCorner)].p);
  }
  const double distance = std::sqrt(dot(way, way));
  if (distance < detail::kOnCore) return {distance, normal, feature};
  return {distance, way / distance, feature};
}

struct Claim {
  int feature = -1;
  double margin = -HUGE_VAL;  ///< of `feature`, or the largest if there is none [m]
};

/// The feature whose region holds the centre, counting only the triangle and its neighbours.
Claim findClaim(const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle, const PlainVec& c,
                int touched) noexcept {
  Claim claim;
  for (int feature = kMeshFace; feature < kMeshFeatures; ++feature) {
    const double margin = computeFeatureMargin(mesh, triangle, feature, c, touched);
    if (margin > claim.margin) claim.margin = margin;
    if (margin > 0.0) return {feature, margin};
  }
  return claim;
}

/// How much nearer the plane of `behind` is than any other triangle that claims the centre [m]. The
/// centre is `depth` behind that plane. Negative: the centre leaves through another triangle.
double computeLeadOverOthers(const TriangleMesh& mesh, int piece,
                             const TriangleMesh::Triangle& behind, double depth, const PlainVec& c,
                             int touched) noexcept {
  double lead = std::numeric_limits<double>::infinity();
  // The search reaches farther, so that an approaching triangle shows up before it is the nearest.
  mesh.forEachNear(c.toVec3(), 1.1 * depth + kSameDepth, [&](int place, double) {
    const TriangleMesh::Triangle& other = triangleAt(mesh, place);
    // A triangle in front of that plane is the other side of a groove: both push.
    if (place == piece || !(heightOver(behind, PlainVec(other.middle)) < -kSameDepth)) return;
    if (isHidden(c, mesh, touched, place)) return;
    const Claim claim = findClaim(mesh, other, c, touched);
    if (claim.feature < 0) return;
    const double theirs = std::abs(leaveByFeature(other, claim.feature, c).distance);
    // Ties go to the lower index, so that exactly one of several equally near faces wins.
    double ahead = theirs - depth;
    if (ahead == 0.0) ahead = piece < place ? kSameDepth : -kSameDepth;
    lead = std::min(lead, ahead);
  });
  return lead;
}

/// Margin of the face's region among all triangles [m]; a centre inside leaves through the nearest.
double computeFaceMargin(const TriangleMesh& mesh, int piece, const PlainVec& c,
                         int touched) noexcept {
  // It may push when the centre is in front of the touched triangle again.
  if (isHidden(c, mesh, touched, piece)) return heightOver(triangleAt(mesh, touched), c);
  const TriangleMesh::Triangle& triangle = triangleAt(mesh, piece);
  double margin = computeOwnMargin(mesh, triangle, c, touched);
  if (!(margin > 0.0)) return margin;
  const double height = heightOver(triangle, c);
  if (height < 0.0)
    margin = std::min(margin, computeLeadOverOthers(mesh, piece, triangle, -height, c, touched));
  for (const TriangleMesh::Edge& edge : triangle.edges) {
    if (!goesOnBehind(edge, c)) continue;
    const TriangleMesh::Triangle& wall = triangleAt(mesh, edge.mate / 3);
    margin = std::min(margin,
                      computeLeadOverOthers(mesh, piece, wall, -heightOver(wall, c), c, touched));
  }
  return margin;
}

}  // namespace

Separation separate(const PlainVec& c, const Mesh& mesh, int piece, int touched) noexcept {
  const TriangleMesh& surface = *mesh.surface;
  const TriangleMesh::Triangle& triangle = triangleAt(surface, piece);
  Claim claim = findClaim(surface, triangle, c, touched);
  if (claim.feature == kMeshFace) {
    claim.margin = computeFaceMargin(surface, piece, c, touched);
    if (!(claim.margin > 0.0)) claim.feature = -1;
  }
  Separation found = leaveByFeature(triangle, std::max(claim.feature, int{kMeshFace}), c);
  found.distance -= mesh.skin;
  found.face = claim.feature;
  found.aside = -claim.margin;
  return found;
}

Separation leaveByFace(const PlainVec& c, const Mesh& mesh, int piece, int feature) noexcept {
  Separation found = leaveByFeature(triangleAt(*mesh.surface, piece), feature, c);
  found.distance -= mesh.skin;
  return found;
}

double computeFaceLead(const PlainVec& c, const Mesh& mesh, int piece, int feature,
                       int touched) noexcept {
  if (feature == kMeshFace) return computeFaceMargin(*mesh.surface, piece, c, touched);
  return computeFeatureMargin(*mesh.surface, triangleAt(*mesh.surface, piece), feature, c, touched);
}

Separation separate(const PlainVec& c, const Mesh& mesh) noexcept {
  const double far = std::numeric_limits<double>::infinity();
  const double nearest = mesh.surface->findNearest(c.toVec3(), far);
  Separation found{far, {1.0, 0.0, 0.0}};
  mesh.surface->forEachNear(c.toVec3(), nearest * (1.0 + 1e-9) + kSameDepth,
                            [&](int piece, double) {
                              const Separation at = separate(c, mesh, piece, -1);
                              if (at.face >= 0 && at.distance < found.distance) found = at;
                            });
  return found;
}

}  // namespace tandem
