#include "geometry/flat_faces.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tandem {
namespace {

/// A triangle of less height than so many tolerances of a plane has no reliable normal.
constexpr double kThinTriangle = 10.0;

class FlatFaces {
 public:
  FlatFaces(const std::vector<Vec3>& points, const HullTriangles& hull)
      : points_(points),
        all_(hull.triangles),
        in_plane_(5.0 * hull.on_face),
        folded_(10.0 * hull.on_face),
        is_doubtful_(hull.has_left_some),
        face_of_(all_.size(), kAlone),
        was_tried_(all_.size()) {
    faces_.corners.reserve(3 * all_.size());
    faces_.ends.reserve(all_.size());
    std::vector<int> doubtful;
    for (int t = 0; t < count(); ++t)
      if (const Look look = lookAround(t); look.is_flat || look.is_folded) doubtful.push_back(t);
    // A thin triangle joins others rather than to give them its plane.
    for (const int t : doubtful)
      if (!isThin(t)) join(t);
    for (const int t : doubtful) join(t);
    for (const int t : doubtful) is_doubtful_ |= lookAround(t).is_folded;
    for (int t = 0; t < count(); ++t) {
      is_doubtful_ |= isThin(t);
      if (faceOf(t) == kAlone) append(at(t).corners.begin(), at(t).corners.end());
    }
    if (!doubtful.empty()) dropPointsOnEdges();
  }

  [[nodiscard]] std::optional<FaceList> take() {
    // A closed surface that is convex at each side and goes around once is convex.
    if (!goesAroundOnce() || (is_doubtful_ && !isConvex())) return std::nullopt;
    return std::move(faces_);
  }

 private:
  static constexpr int kAlone = -1;

  struct Look {
    bool is_flat = false;    ///< a triangle beside is in the same plane
    bool is_folded = false;  ///< one is in front of it, or folded onto it
  };

  [[nodiscard]] int count() const { return static_cast<int>(all_.size()); }
  [[nodiscard]] const HullTriangle& at(int t) const { return all_[static_cast<std::size_t>(t)]; }
  [[nodiscard]] int& faceOf(int t) { return face_of_[static_cast<std::size_t>(t)]; }
  [[nodiscard]] const Vec3& point(int i) const { return points_[static_cast<std::size_t>(i)]; }

  [[nodiscard]] static std::size_t sideTo(const HullTriangle& triangle, int beyond) {
    return triangle.beyond[0] == beyond ? 0 : triangle.beyond[1] == beyond ? 1 : 2;
  }
  /// Height of the far corner of the triangle beyond side k [m].
  [[nodiscard]] double heightBeyond(int t, std::size_t k) const {
    const HullTriangle& other = at(at(t).beyond[k]);
    return at(t).height(point(other.corners[(sideTo(other, t) + 2) % 3]));
  }

  [[nodiscard]] Look lookAround(int t) const {
    Look look;
    for (std::size_t k = 0; k < 3; ++k) {
      const double height = heightBeyond(t, k);
      const bool is_flat = std::abs(height) <= in_plane_;
      const bool turns_back = is_flat && !(dot(at(t).normal, at(at(t).beyond[k]).normal) > 0.0);
      look.is_flat |= is_flat;
      look.is_folded |= height > folded_ || turns_back;
    }
    return look;
  }

  [[nodiscard]] bool isThin(int t) const {
    const Vec3 &a = point(at(t).corners[0]), &b = point(at(t).corners[1]),
               &c = point(at(t).corners[2]);
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    const double least = kThinTriangle * in_plane_;
    return !((b - a).cross(c - a).squaredNorm() > least * least * longest);
  }

  /// Joins a triangle with those around it in its plane that are not joined yet. Where points are
  /// scattered about a plane by as much as the tolerance, that may be no convex face: then they
  /// stay triangles.
  void join(int seed) {
    if (faceOf(seed) != kAlone || was_tried_[static_cast<std::size_t>(seed)]) return;
    const auto place = static_cast<int>(faces_.ends.size());
    members_.assign(1, seed);
    faceOf(seed) = place;
    std::size_t sides = 0;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      for (const int beyond : at(members_[i]).beyond) {
        if (faceOf(beyond) == place) continue;
        if (faceOf(beyond) == kAlone && isInPlane(seed, beyond)) {
          faceOf(beyond) = place;
          members_.push_back(beyond);
        }
      }
    }
    for (const int t : members_)
      sides += static_cast<std::size_t>(std::count_if(at(t).beyond.begin(), at(t).beyond.end(),
                                                      [&](int b) { return faceOf(b) != place; }));
    if (members_.size() > 1 && sides >= 3 && traceRim(place, sides) && isRimConvex(seed)) {
      append(corners_.begin(), corners_.end());
      return;
    }
    is_doubtful_ |= members_.size() > 1;
    for (const int t : members_) {
      faceOf(t) = kAlone;
      if (!isThin(seed)) was_tried_[static_cast<std::size_t>(t)] = true;
    }
  }

  [[nodiscard]] bool isInPlane(int seed, int t) const {
    for (const int corner : at(t).corners)
      if (std::abs(at(seed).height(point(corner))) > in_plane_) return false;
    return dot(at(seed).normal, at(t).normal) > 0.0 || isThin(t);
  }

  /// Collects the corners around the members. False if that does not pass all `sides`.
  bool traceRim(int place, std::size_t sides) {
    const auto is_outer = [&](int t, std::size_t k) { return faceOf(at(t).beyond[k]) != place; };
    int t = members_[0];
    std::size_t k = 0;
    for (const int member : members_)
      for (std::size_t side = 0; side < 3; ++side)
        if (is_outer(member, side)) t = member, k = side;
    corners_.clear();
    while (corners_.size() < sides) {
      corners_.push_back(at(t).corners[k]);
      k = (k + 1) % 3;
      while (!is_outer(t, k)) {
        const int next = at(t).beyond[k];
        k = (sideTo(at(next), t) + 1) % 3;
        t = next;
      }
      if (at(t).corners[k] == corners_[0]) break;
    }
    return corners_.size() == sides;
  }

  [[nodiscard]] bool isRimConvex(int seed) const {
    const Vec3 up = at(seed).normal.toVec3();
    const std::size_t count = corners_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 &a = point(corners_[i]), &b = point(corners_[(i + 1) % count]),
                 &c = point(corners_[(i + 2) % count]);
      if (up.dot((b - a).cross(c - b)) < -in_plane_ * (c - a).norm()) return false;
    }
    return true;
  }

  /// A point of two faces is on the edge between them. Both lose it.
  void dropPointsOnEdges() {
    std::vector<int> named(points_.size(), 0);
    for (const int corner : faces_.corners) ++named[static_cast<std::size_t>(corner)];
    FaceList kept;
    kept.corners.reserve(faces_.corners.size());
    int first = 0;
    for (const int end : faces_.ends) {
      const std::size_t before = kept.corners.size();
      for (int i = first; i < end; ++i)
        if (const int corner = faces_.corners[static_cast<std::size_t>(i)];
            named[static_cast<std::size_t>(corner)] > 2)
          kept.corners.push_back(corner);
      if (kept.corners.size() - before < 3) kept.corners.resize(before);
      if (kept.corners.size() > before) kept.ends.push_back(static_cast<int>(kept.corners.size()));
      first = end;
    }
    faces_ = std::move(kept);
  }

  template <typename Iterator>
  void append(Iterator begin, Iterator end) {
    faces_.corners.insert(faces_.corners.end(), begin, end);
    faces_.ends.push_back(static_cast<int>(faces_.corners.size()));
  }

  /// True if the surface goes around its middle once. Rounding may wind it around a corner twice,
  /// though it is convex at each side.
  [[nodiscard]] bool goesAroundOnce() const {
    PlainVec middle;
    for (const HullTriangle& t : all_)
      for (const int i : t.corners)
        middle = middle + PlainVec(point(i)) / static_cast<double>(3 * all_.size());
    const auto corner = [&](const HullTriangle& t, std::size_t k) {
      return PlainVec(point(t.corners[k])) - middle;
    };
    const auto ray = [&](const HullTriangle& t) {
      return corner(t, 0) + corner(t, 1) + corner(t, 2);
    };
    // A ray from the middle through a triangle meets no other.
    std::size_t aim = 0;
    while (aim + 1 < all_.size() && isThin(static_cast<int>(aim))) ++aim;
    const PlainVec along = ray(all_[aim]);
    int hits = 0;
    for (const HullTriangle& t : all_) {
      if (!(t.height(middle.toVec3()) < 0.0)) return false;
      if (!(dot(t.normal, along) > 0.0)) continue;
      const PlainVec a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
      if (dot(cross(a, b), along) > 0.0 && dot(cross(b, c), along) > 0.0 &&
          dot(cross(c, a), along) > 0.0)
        ++hits;
    }
    return hits == 1;
  }

  /// True if all points are behind all faces, as makeHull() has these.
  [[nodiscard]] bool isConvex() const {
    int first = 0;
    for (const int end : faces_.ends) {
      const int* corners = faces_.corners.data() + first;
      const Vec3 normal = computeArea(points_, corners, end - first).normalized();
      const double most = normal.dot(point(corners[0])) + folded_;
      for (const Vec3& p : points_)
        if (!(normal.dot(p) <= most)) return false;
      first = end;
    }
    return true;
  }

  const std::vector<Vec3>& points_;
  const std::vector<HullTriangle>& all_;
  double in_plane_;   ///< a corner that is nearer to a plane is in it [m]
  double folded_;     ///< a corner may be so far in front of a face [m]
  bool is_doubtful_;  ///< heights at sides do not tell whether the surface is convex
  std::vector<int> face_of_;
  std::vector<bool> was_tried_;
  std::vector<int> members_, corners_;
  FaceList faces_;
};

}  // namespace

Vec3 computeArea(const std::vector<Vec3>& points, const int* corners, int count) {
  const auto corner = [&](int i) -> const Vec3& {
    return points[static_cast<std::size_t>(corners[i])];
  };
  Vec3 area = Vec3::Zero();
  for (int i = 1; i + 1 < count; ++i)
    area += (corner(i) - corner(0)).cross(corner(i + 1) - corner(0));
  return area;
}

std::optional<FaceList> joinFlatFaces(const std::vector<Vec3>& points, const HullTriangles& hull) {
  return FlatFaces(points, hull).take();
}

}  // namespace tandem
