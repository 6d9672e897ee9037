#include "gl/mesh_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace tandem::view {
namespace {

constexpr double kSharpCosine = 0.82;       // of 35 degrees
constexpr double kFlatCosine = 1 - 1e-6;    // of 0.08 degrees
constexpr double kSmoothCosine = 1 - 1e-4;  // of 0.8 degrees
constexpr double kJoined = 1e-5;            // vertices this close are one [size of the mesh]
constexpr float kGhostWidth = 1.5F;         // [pixel]

Vec3 pointOf(const ShapeMesh::Vertex& vertex) { return {vertex.p[0], vertex.p[1], vertex.p[2]}; }
Vec3 normalOf(const ShapeMesh::Vertex& vertex) { return {vertex.n[0], vertex.n[1], vertex.n[2]}; }

// Each vertex's first twin at the same place: faces with normals of their own do not share any.
std::vector<std::uint32_t> findTwins(const ShapeMesh& mesh) {
  // Rounding joins what differs in the last bits, such as the many points of a ball's pole.
  double size = 0.0;
  for (const ShapeMesh::Vertex& vertex : mesh.vertices)
    size = std::max(size, pointOf(vertex).cwiseAbs().maxCoeff());
  const double cell = std::max(kJoined * size, 1e-12);
  std::map<std::array<long long, 3>, std::uint32_t> first_in;
  std::vector<std::uint32_t> twins;
  for (const ShapeMesh::Vertex& vertex : mesh.vertices) {
    std::array<long long, 3> place = {};
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] = std::llround(static_cast<double>(vertex.p[axis]) / cell);
    const auto index = static_cast<std::uint32_t>(twins.size());
    twins.push_back(first_in.try_emplace(place, index).first->second);
  }
  return twins;
}

// A triangle as one of its edges sees it.
struct Side {
  Vec3 face_normal;
  std::array<Vec3, 2> shading_normals;  // at the edge's ends
};

using Sides = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>>;

void addSide(const ShapeMesh& mesh, std::uint32_t from, std::uint32_t to,
             const std::vector<std::uint32_t>& twins, const Vec3& face_normal, Sides& sides) {
  if (twins[from] > twins[to]) std::swap(from, to);
  sides[{twins[from], twins[to]}].push_back(
      {.face_normal = face_normal,
       .shading_normals = {normalOf(mesh.vertices[from]), normalOf(mesh.vertices[to])}});
}

// Zero for a triangle without an area, such as one with two corners in a ball's pole.
Vec3 computeFaceNormal(const ShapeMesh& mesh, const std::array<std::uint32_t, 3>& corners,
                       const std::vector<std::uint32_t>& twins) {
  const std::uint32_t a = twins[corners[0]], b = twins[corners[1]], c = twins[corners[2]];
  if (a == b || b == c || c == a) return Vec3::Zero();
  const Vec3 p_BA = pointOf(mesh.vertices[a]);
  return (pointOf(mesh.vertices[b]) - p_BA)
      .cross(pointOf(mesh.vertices[c]) - p_BA)
      .stableNormalized();
}

// The triangles at each edge; those without an area are left out.
Sides findSides(const ShapeMesh& mesh) {
  const std::vector<std::uint32_t> twins = findTwins(mesh);
  Sides sides;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> corners = {mesh.indices[i], mesh.indices[i + 1],
                                                  mesh.indices[i + 2]};
    const Vec3 normal = computeFaceNormal(mesh, corners, twins);
    if (normal.isZero()) continue;
    for (std::size_t k = 0; k < 3; ++k)
      addSide(mesh, corners[k], corners[(k + 1) % 3], twins, normal, sides);
  }
  return sides;
}

bool isSmooth(const Side& one, const Side& other) {
  return one.shading_normals[0].dot(other.shading_normals[0]) > kSmoothCosine &&
         one.shading_normals[1].dot(other.shading_normals[1]) > kSmoothCosine;
}

// Where the surface between shading normals turns from the eye: a straight piece in each triangle
// that it crosses. `facing` is positive at the corners that face the eye.
std::vector<Vec3> cutTriangle(const std::array<Vec3, 3>& corners,
                              const std::array<double, 3>& facing) {
  std::vector<Vec3> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if ((facing[k] > 0.0) == (facing[next] > 0.0)) continue;
    const double part = facing[k] / (facing[k] - facing[next]);
    ends.emplace_back(corners[k] + part * (corners[next] - corners[k]));
  }
  return ends;
}

class GhostLines {
 public:
  GhostLines(const Solid& solid, std::vector<Line>& lines) : solid_(solid), lines_(lines) {}

  void add(const Vec3& from_B, const Vec3& to_B) {
    lines_.push_back({.from_W = solid_.p_WB + solid_.q_WB * from_B,
                      .to_W = solid_.p_WB + solid_.q_WB * to_B,
                      .colour = solid_.colour,
                      .width = kGhostWidth});
  }

 private:
  const Solid& solid_;
  std::vector<Line>& lines_;
};

void addRoundOutline(const ShapeMesh& mesh, const Vec3& p_BEye, GhostLines& lines) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<Vec3, 3> corners;
    std::array<double, 3> facing = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const ShapeMesh::Vertex& vertex = mesh.vertices[mesh.indices[i + k]];
      corners[k] = pointOf(vertex);
      facing[k] = normalOf(vertex).dot(p_BEye - corners[k]);
    }
    const std::vector<Vec3> ends = cutTriangle(corners, facing);
    if (ends.size() == 2) lines.add(ends[0], ends[1]);
  }
}

}  // namespace

std::vector<MeshEdge> computeMeshEdges(const ShapeMesh& mesh) {
  std::vector<MeshEdge> edges;
  for (const auto& [ends, sides] : findSides(mesh)) {
    const Side &first = sides.front(), &last = sides.back();
    const double cosine = first.face_normal.dot(last.face_normal);
    const bool has_two = sides.size() == 2;
    if (has_two && (cosine > kFlatCosine || isSmooth(first, last))) continue;
    edges.push_back({.from_B = pointOf(mesh.vertices[ends.first]),
                     .to_B = pointOf(mesh.vertices[ends.second]),
                     .n1_B = first.face_normal,
                     .n2_B = last.face_normal,
                     .is_sharp = !has_two || cosine < kSharpCosine});
  }
  return edges;
}

void appendGhostLines(const Solid& solid, const std::vector<MeshEdge>& edges, const Vec3& p_WEye,
                      std::vector<Line>& lines) {
  const Vec3 p_BEye = solid.q_WB.conjugate() * (p_WEye - solid.p_WB);
  GhostLines ghost(solid, lines);
  for (const MeshEdge& edge : edges) {
    const Vec3 to_eye = p_BEye - edge.from_B;
    const bool is_outline = (edge.n1_B.dot(to_eye) > 0.0) != (edge.n2_B.dot(to_eye) > 0.0);
    if (edge.is_sharp || is_outline) ghost.add(edge.from_B, edge.to_B);
  }
  addRoundOutline(*solid.mesh, p_BEye, ghost);
}

}  // namespace tandem::view
