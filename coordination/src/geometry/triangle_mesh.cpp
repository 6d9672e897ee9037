#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace tandem {
namespace {

/// Corners nearer to each other than this share of the size are merged.
constexpr double kWeld = 1e-6;
/// Faces whose normals differ by less are coplanar [rad].
constexpr double kFlat = 1e-5;
/// Cosine of the angle between normals, 60 degrees. At a sharper concave edge both faces push.
constexpr double kSharpCosine = 0.5;
constexpr int kTrianglesPerLeaf = 4;

/// Gives coincident corners the same number.
class Welder {
 public:
  Welder(const Vec3& low, double reach) : low_(low), reach_(reach) {}

  int find(const Vec3& p) {
    const Vec3 cell = ((p - low_) / (2.0 * reach_)).array().floor();
    const std::int64_t x = static_cast<std::int64_t>(cell.x()),
                       y = static_cast<std::int64_t>(cell.y()),
                       z = static_cast<std::int64_t>(cell.z());
    // The point's own cell comes first: most coincident corners are equal to the last bit.
    if (const int known = findIn(x, y, z, p); known >= 0) return known;
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz)
          if (const int known = findIn(x + dx, y + dy, z + dz, p); known >= 0) return known;
    cells_[hash(x, y, z)].push_back(static_cast<int>(points_.size()));
    points_.push_back(p);
    return static_cast<int>(points_.size()) - 1;
  }
  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }

 private:
  static std::uint64_t hash(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
           static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu ^
           static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u;
  }
  int findIn(std::int64_t x, std::int64_t y, std::int64_t z, const Vec3& p) const {
    const auto cell = cells_.find(hash(x, y, z));
    if (cell == cells_.end()) return -1;
    for (const int i : cell->second)
      if ((points_[static_cast<std::size_t>(i)] - p).norm() <= reach_) return i;
    return -1;
  }

  Vec3 low_;
  double reach_;
  std::vector<Vec3> points_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

}  // namespace

TriangleMesh::TriangleMesh(const std::vector<Vec3>& corners) {
  if (corners.empty() || corners.size() % 3 != 0)
    throw std::invalid_argument("a triangle mesh needs three corners for each triangle");
  Vec3 low = corners.front(), high = low;
  for (const Vec3& p : corners) {
    if (!p.allFinite()) throw std::invalid_argument("a triangle mesh has a corner not finite");
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).norm();
  if (!(size > 0.0)) throw std::invalid_argument("a triangle mesh has no triangle with an area");
  Welder welder(low, kWeld * size);
  std::vector<int> vertices;  // three per triangle kept
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const int v[3] = {welder.find(corners[i]), welder.find(corners[i + 1]),
                      welder.find(corners[i + 2])};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    const auto p = [&](int k) { return welder.points()[static_cast<std::size_t>(v[k])]; };
    const Vec3 area = (p(1) - p(0)).cross(p(2) - p(0));
    const double longest = std::max({(p(1) - p(0)).norm(), (p(2) - p(1)).norm(),  //
                                     (p(0) - p(2)).norm()});
    // A triangle lower than the weld distance is a line.
    if (!(area.norm() > kWeld * size * longest)) continue;
    vertices.insert(vertices.end(), v, v + 3);
    Triangle triangle;
    triangle.normal = area.normalized();
    triangle.offset = triangle.normal.dot(p(0));
    triangle.middle = (p(0) + p(1) + p(2)) / 3.0;
    for (int k = 0; k < 3; ++k) {
      triangle.corners[k].p = p(k);
      bounding_radius_ = std::max(bounding_radius_, p(k).norm());
    }
    triangles_.push_back(triangle);
  }
  if (triangles_.empty())
    throw std::invalid_argument("a triangle mesh has no triangle with an area");
  join(vertices, size);
  makeDirections(vertices, static_cast<int>(welder.points().size()));
  for (std::size_t i = 0; i < triangles_.size(); ++i) order_.push_back(static_cast<int>(i));
  makeNode(0, static_cast<int>(triangles_.size()));
}

/// Finds the two triangles of each edge. If more than two meet, or two run along it in the same
/// direction, the edge stays open for the later ones.
void TriangleMesh::join(const std::vector<int>& vertices, double size) {
  std::map<std::pair<int, int>, int> open;  // edge (from, to) -> 3 triangle + k
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      Triangle& triangle = triangles_[t];
      const std::size_t next = (k + 1) % 3;
      const int from = vertices[3 * t + k], to = vertices[3 * t + next];
      Edge& edge = triangle.edges[k];
      edge.start = triangle.corners[k].p;
      edge.end = triangle.corners[next].p;
      edge.along = (edge.end - edge.start).normalized();
      edge.inward = triangle.normal.cross(edge.along).normalized();
      edge.is_owner = true;
      const auto mate = open.find({to, from});
      if (mate == open.end()) {
        open.insert({{from, to}, static_cast<int>(3 * t + k)});
        continue;
      }
      edge.mate = mate->second;
      Triangle& other = triangles_[static_cast<std::size_t>(edge.mate / 3)];
      Edge& theirs = other.edges[static_cast<std::size_t>(edge.mate % 3)];
      theirs.mate = static_cast<int>(3 * t + k);
      open.erase(mate);
      // Both triangles use the same numbers, so that each place is on exactly one side.
      edge.start = theirs.start;
      edge.end = theirs.end;
      edge.along = theirs.along;
      const double rise = other.normal.dot(triangle.corners[(k + 2) % 3].p - edge.start);
      const double far = (triangle.corners[(k + 2) % 3].p - edge.start).norm();
      const double cosine = triangle.normal.dot(other.normal);
      Meeting meeting = Meeting::kFlat;
      if (rise < -kFlat * far || (cosine < 0.0 && rise <= kWeld * size))
        meeting = Meeting::kConvex;
      else if (rise > kFlat * far && cosine <= kSharpCosine)
        meeting = Meeting::kConcave;
      edge.meeting = theirs.meeting = meeting;
      edge.is_owner = false;
      theirs.is_owner = meeting == Meeting::kConvex;
      if (meeting == Meeting::kFlat) {
        // The plane through the edge, halfway between the normals.
        const Vec3 inward = (theirs.inward - edge.inward).normalized();
        theirs.inward = inward;
        edge.inward = -inward;
      }
    }
  }
  is_closed_ = open.empty();
}

/// Collects the edge directions of each corner and decides which triangle owns it.
void TriangleMesh::makeDirections(const std::vector<int>& vertices, int vertex_count) {
  std::vector<std::vector<Vec3>> leaving(static_cast<std::size_t>(vertex_count));
  std::vector<char> may_push(leaving.size(), 0);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Edge& edge = triangles_[i / 3].edges[i % 3];
    const bool pushes = edge.meeting == Meeting::kConvex || edge.meeting == Meeting::kOpen;
    const std::size_t from = i / 3 * 3 + i % 3, to = i / 3 * 3 + (i + 1) % 3;
    const auto a = static_cast<std::size_t>(vertices[from]),
               b = static_cast<std::size_t>(vertices[to]);
    may_push[a] |= pushes;
    may_push[b] |= pushes;
    // Each edge counts once.
    if (edge.mate >= 0 && edge.mate < static_cast<int>(i)) continue;
    leaving[a].push_back(edge.along);
    leaving[b].push_back(-edge.along);
  }
  std::vector<int> first(leaving.size());
  for (std::size_t v = 0; v < leaving.size(); ++v) {
    first[v] = static_cast<int>(directions_.size());
    directions_.insert(directions_.end(), leaving[v].begin(), leaving[v].end());
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto v = static_cast<std::size_t>(vertices[i]);
    Corner& corner = triangles_[i / 3].corners[i % 3];
    corner.first = first[v];
    corner.count = static_cast<int>(leaving[v].size());
    corner.is_owner = may_push[v];
    may_push[v] = 0;
  }
}

int TriangleMesh::makeNode(int first, int count) {
  const int at = static_cast<int>(nodes_.size());
  Node node;
  node.low = node.high = triangles_[static_cast<std::size_t>(order_[first])].corners[0].p;
  for (int i = first; i < first + count; ++i) {
    for (const Corner& corner : triangles_[static_cast<std::size_t>(order_[i])].corners) {
      node.low = node.low.cwiseMin(corner.p);
      node.high = node.high.cwiseMax(corner.p);
    }
  }
  node.triangle = first;
  node.count = count;
  nodes_.push_back(node);
  if (count <= kTrianglesPerLeaf) return at;
  int axis = 0;
  (node.high - node.low).maxCoeff(&axis);
  const int half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    const double x = triangles_[static_cast<std::size_t>(a)].middle[axis],
                 y = triangles_[static_cast<std::size_t>(b)].middle[axis];
    return x != y ? x < y : a < b;
  });
  makeNode(first, half);
  const int second = makeNode(first + half, count - half);
  nodes_[static_cast<std::size_t>(at)].second = second;
  return at;
}

double TriangleMesh::computeDistance(const Vec3& c, int place) const noexcept {
  const Triangle& triangle = triangles_[static_cast<std::size_t>(place)];
  bool is_over = true;
  double square = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = triangle.corners[k].p, &b = triangle.corners[(k + 1) % 3].p;
    const Vec3 way = b - a, from_a = c - a;
    if (triangle.normal.cross(way).dot(from_a) >= 0.0) continue;
    is_over = false;
    const double t = std::clamp(way.dot(from_a) / way.squaredNorm(), 0.0, 1.0);
    square = std::min(square, (from_a - t * way).squaredNorm());
  }
  return is_over ? std::abs(triangle.normal.dot(c) - triangle.offset) : std::sqrt(square);
}

double TriangleMesh::findNearest(const Vec3& c, double most) const noexcept {
  double nearest = most;
  forEachLeaf(
      c, [&](double square) { return square < nearest * nearest; },
      [&](int triangle) { nearest = std::min(nearest, computeDistance(c, triangle)); });
  return nearest;
}

}  // namespace tandem
