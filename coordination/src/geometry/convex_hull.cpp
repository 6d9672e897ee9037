#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "geometry/convex_polyhedron.h"

// The hull grows from a tetrahedron. The point farthest outside a face becomes a corner; new
// triangles to it replace the faces that it sees.

namespace tandem {
namespace {

/// Points within this share of the size from a face are on it.
constexpr double kOnFace = 1e-7;

class Hull {
 public:
  explicit Hull(const std::vector<Vec3>& points) : points_(points) {
    for (const Vec3& p : points) middle_ += p / static_cast<double>(points.size());
    for (const Vec3& p : points) size_ = std::max(size_, 2.0 * (p - middle_).norm());
    if (!(std::isfinite(size_) && middle_.allFinite()))
      throw std::invalid_argument("a convex hull needs points that are finite");
    startWithTetrahedron();
    for (auto face = faces_.begin(); face != faces_.end();) {
      const int farthest = findFarthest([&](const Vec3& p) { return height(*face, p); });
      face->is_done = height(*face, at(farthest)) <= kOnFace * size_;
      if (!face->is_done) add(farthest);
      face = std::find_if(faces_.begin(), faces_.end(),
                          [](const Face& other) { return !other.is_done; });
    }
  }

  [[nodiscard]] ConvexPolyhedron make() const {
    std::vector<int> place(points_.size(), -1);
    std::vector<Vec3> corners;
    std::vector<std::vector<int>> faces;
    for (const Face& face : faces_) {
      faces.emplace_back();
      for (const int corner : face.corners) {
        int& known = place[static_cast<std::size_t>(corner)];
        if (known < 0) {
          known = static_cast<int>(corners.size());
          corners.push_back(at(corner));
        }
        faces.back().push_back(known);
      }
    }
    return ConvexPolyhedron(std::move(corners), faces);
  }

 private:
  struct Face {
    std::array<int, 3> corners;
    Vec3 normal;
    double offset;
    bool is_done = false;  ///< no point is outside
  };

  [[nodiscard]] const Vec3& at(int point) const { return points_[static_cast<std::size_t>(point)]; }
  [[nodiscard]] static double height(const Face& face, const Vec3& p) {
    return face.normal.dot(p) - face.offset;
  }

  /// The farthest point by `measure`. Of equally far points, the one farthest from the middle: a
  /// corner of the hull, not on its edge.
  template <typename Measure>
  [[nodiscard]] int findFarthest(Measure measure) const {
    int best = 0;
    double far = measure(points_[0]);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const double value = measure(points_[i]);
      const bool is_tie = std::abs(value - far) <= 1e-3 * kOnFace * size_;
      const bool is_outer =
          (points_[i] - middle_).squaredNorm() > (at(best) - middle_).squaredNorm();
      if (is_tie ? is_outer : value > far) best = static_cast<int>(i), far = value;
    }
    return best;
  }

  void startWithTetrahedron() {
    const int a = findFarthest([&](const Vec3& p) { return (p - middle_).norm(); });
    const int b = findFarthest([&](const Vec3& p) { return (p - at(a)).norm(); });
    const Vec3 along = (at(b) - at(a)).normalized();
    const int c = findFarthest([&](const Vec3& p) { return along.cross(p - at(a)).norm(); });
    const Vec3 normal = along.cross(at(c) - at(a)).normalized();
    const int d = findFarthest([&](const Vec3& p) { return std::abs(normal.dot(p - at(a))); });
    const double out = normal.dot(at(d) - at(a));
    if (!(std::abs(out) > 100.0 * kOnFace * size_))
      throw std::invalid_argument("a convex hull needs points that are not all in one plane");
    const int left = out > 0.0 ? b : c, right = out > 0.0 ? c : b;
    for (const std::array<int, 3>& corners :
         {std::array{a, right, left}, {a, left, d}, {left, right, d}, {right, a, d}})
      addFace(corners);
  }

  void addFace(const std::array<int, 3>& corners) {
    const Vec3& p = at(corners[0]);
    const Vec3 normal = (at(corners[1]) - p).cross(at(corners[2]) - p).normalized();
    faces_.push_back({corners, normal, normal.dot(p), false});
  }

  void add(int point) {
    std::map<std::pair<int, int>, int> rim;
    const double least = 1e-2 * kOnFace * size_;  // less is rounding, in the face's plane
    const auto is_seen = [&](const Face& face) { return height(face, at(point)) > least; };
    for (const Face& face : faces_) {
      if (!is_seen(face)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = face.corners[k], to = face.corners[(k + 1) % 3];
        if (rim.erase({to, from}) == 0) rim[{from, to}] = 1;
      }
    }
    faces_.erase(std::remove_if(faces_.begin(), faces_.end(), is_seen), faces_.end());
    for (const auto& [edge, one] : rim) addFace({edge.first, edge.second, point});
  }

  const std::vector<Vec3>& points_;
  Vec3 middle_ = Vec3::Zero();
  double size_ = 0.0;
  std::vector<Face> faces_;
};

}  // namespace

ConvexPolyhedron ConvexPolyhedron::makeHull(const std::vector<Vec3>& points) {
  if (points.size() < 4) throw std::invalid_argument("a convex hull needs at least four points");
  return Hull(points).make();
}

}  // namespace tandem
