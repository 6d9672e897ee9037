#include "geometry/convex_polyhedron.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "geometry/flat_faces.h"

namespace tandem {
namespace {

/// Share of the size that a corner may be in front of a face: rounding of single-precision hulls.
constexpr double kTolerance = 1e-6;
constexpr double kShortest = 1e-12;

[[noreturn]] void refuse(const char* what) {
  throw std::invalid_argument(std::string("a convex polyhedron ") + what);
}

}  // namespace

ConvexPolyhedron::ConvexPolyhedron(std::vector<Vec3> vertices,
                                   const std::vector<std::vector<int>>& faces)
    : vertices_(std::move(vertices)) {
  if (faces.size() < 4 || vertices_.size() < 4) refuse("needs at least four faces and corners");
  for (const Vec3& v : vertices_)
    if (!v.allFinite()) refuse("has a corner that is not finite");
  checkClosed(faces);
  FaceList list;
  for (const std::vector<int>& corners : faces) {
    list.corners.insert(list.corners.end(), corners.begin(), corners.end());
    list.ends.push_back(static_cast<int>(list.corners.size()));
  }
  takeFaces(list);
  checkConvex();
}

ConvexPolyhedron::ConvexPolyhedron(std::vector<Vec3> vertices, const FaceList& faces)
    : vertices_(std::move(vertices)) {
  takeFaces(faces);
}

void ConvexPolyhedron::takeFaces(const FaceList& faces) {
  for (const Vec3& v : vertices_) bounding_radius_ = std::max(bounding_radius_, v.norm());
  const double size = computeSize();
  faces_.reserve(faces.ends.size());
  sides_.reserve(faces.corners.size());
  int first = 0;
  for (const int end : faces.ends) {
    addFace(faces.corners.data() + first, end - first, size);
    first = end;
  }
}

double ConvexPolyhedron::computeSize() const {
  Vec3 low = vertices_.front(), high = low;
  for (const Vec3& v : vertices_) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return (high - low).norm();
}

/// Requires that each side of a face is also a side of another face, in opposite direction.
void ConvexPolyhedron::checkClosed(const std::vector<std::vector<int>>& faces) const {
  std::set<std::pair<int, int>> sides;
  for (const std::vector<int>& corners : faces) {
    if (corners.size() < 3) refuse("has a face of fewer than three corners");
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const int from = corners[i], to = corners[(i + 1) % corners.size()];
      if (from < 0 || from >= static_cast<int>(vertices_.size()))
        refuse("has a face with a corner that does not exist");
      if (!sides.emplace(from, to).second) refuse("has a side that two faces run along alike");
    }
  }
  for (const auto& [from, to] : sides)
    if (!sides.count({to, from})) refuse("is not closed");
}

void ConvexPolyhedron::checkConvex() const {
  const double tolerance = kTolerance * computeSize();
  for (const Face& face : faces_) {
    double highest = face.offset, lowest = face.offset;
    for (const Vec3& v : vertices_) {
      highest = std::max(highest, face.normal.dot(v));
      lowest = std::min(lowest, face.normal.dot(v));
    }
    if (highest - face.offset > tolerance) refuse("is not convex");
    if (!(face.offset - lowest > tolerance)) refuse("is flat");
  }
}

void ConvexPolyhedron::addFace(const int* corners, int count, double size) {
  const auto corner = [&](int i) -> const Vec3& {
    return vertices_[static_cast<std::size_t>(corners[i])];
  };
  const Vec3 area = computeArea(vertices_, corners, count);
  if (!(area.norm() > kShortest * size * size)) refuse("has a face without area");

  Face face;
  face.normal = area.normalized();
  face.first = static_cast<int>(sides_.size());
  face.offset = face.normal.dot(corner(0));
  for (int i = 0; i < count; ++i) {
    const Vec3 way = corner(i + 1 < count ? i + 1 : 0) - corner(i);
    Side side;
    side.start = corner(i);
    side.length = way.norm();
    if (!(side.length > kShortest * size)) continue;
    side.along = way / side.length;
    side.outward = side.along.cross(face.normal).normalized();
    sides_.push_back(side);
  }
  face.count = static_cast<int>(sides_.size()) - face.first;
  faces_.push_back(face);
}

}  // namespace tandem
