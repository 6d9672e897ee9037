#include "geometry/quick_hull.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

// The hull grows from a tetrahedron. The point farthest outside a face becomes a corner; new
// triangles to it replace the faces that it sees. Each point that is still outside is kept with one
// face, so a step looks only at what it replaces.

namespace tandem {
namespace {

constexpr int kNone = -1;
/// Points nearer to a plane than this share of their size are all in it.
constexpr double kFlat = 1e-5;

class QuickHull {
 public:
  QuickHull(const std::vector<Vec3>& points, double precision)
      : points_(points), marks_(points.size()) {
    for (const Vec3& p : points) middle_ += p / static_cast<double>(points.size());
    for (const Vec3& p : points) size_ = std::max(size_, 2.0 * (p - middle_).norm());
    if (!(std::isfinite(size_) && middle_.allFinite()))
      throw std::invalid_argument("a convex hull needs points that are finite");
    on_face_ = precision * size_;
    startWithTetrahedron();
    while (is_closed_ && !pending_.empty()) {
      const int f = pending_.back();
      pending_.pop_back();
      if (face(f).first_outside != kNone) add(face(f).farthest, f);
    }
  }

  [[nodiscard]] std::optional<HullTriangles> take() {
    if (!is_closed_) return std::nullopt;
    std::vector<int> place(faces_.size(), kNone);
    HullTriangles found;
    found.on_face = on_face_;
    found.has_left_some = has_left_some_;
    found.triangles.reserve(faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!faces_[f].is_alive) continue;
      place[f] = static_cast<int>(found.triangles.size());
      found.triangles.push_back(faces_[f].triangle);
    }
    for (HullTriangle& triangle : found.triangles)
      for (int& beyond : triangle.beyond) beyond = place[static_cast<std::size_t>(beyond)];
    return found;
  }

 private:
  struct Face {
    HullTriangle triangle;
    int first_outside = kNone;  ///< of the points that are kept with this face
    int farthest = kNone;       ///< of these
    double most = 0.0;          ///< height of that one [m]
    bool is_alive = true, is_seen = false;
  };
  /// A side of a face that stays, where a new face begins.
  struct Rim {
    int from, to, beyond;
    std::size_t side;  ///< of the face beyond
  };
  struct PointMark {
    int next_outside = kNone;  ///< the next point that is kept with the same face
    int rim = kNone;           ///< the place in rim_ that starts here, if made in this step
    int step = 0;
  };
  struct Plane {
    PlainVec normal;
    double offset;
    int face;
  };

  [[nodiscard]] const Vec3& at(int point) const { return points_[static_cast<std::size_t>(point)]; }
  [[nodiscard]] Face& face(int f) { return faces_[static_cast<std::size_t>(f)]; }
  [[nodiscard]] PointMark& mark(int point) { return marks_[static_cast<std::size_t>(point)]; }

  /// True if a point is farther than the best so far. Of equally far points, the one farthest from
  /// the middle: a corner of the hull, not on its edge.
  [[nodiscard]] bool isFarther(double value, int point, double far, int best) const {
    if (std::abs(value - far) > 1e-3 * on_face_) return value > far;
    return (at(point) - middle_).squaredNorm() > (at(best) - middle_).squaredNorm();
  }

  template <typename Measure>
  [[nodiscard]] int findFarthest(Measure measure) const {
    int best = 0;
    double far = measure(points_[0]);
    for (int i = 1; i < static_cast<int>(points_.size()); ++i) {
      const double value = measure(at(i));
      if (isFarther(value, i, far, best)) best = i, far = value;
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
    if (!(std::abs(out) > kFlat * size_))
      throw std::invalid_argument("a convex hull needs points that are not all in one plane");
    const int left = out > 0.0 ? b : c, right = out > 0.0 ? c : b;
    makeFace({a, right, left}, {3, 2, 1});
    makeFace({a, left, d}, {0, 2, 3});
    makeFace({left, right, d}, {0, 3, 1});
    makeFace({right, a, d}, {0, 1, 2});
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) giveToFace(i);
  }

  int makeFace(const std::array<int, 3>& corners, const std::array<int, 3>& beyond) {
    const int f = free_.empty() ? static_cast<int>(faces_.size()) : free_.back();
    if (free_.empty())
      faces_.emplace_back();
    else
      free_.pop_back();
    const PlainVec p(at(corners[0]));
    const PlainVec area = cross(PlainVec(at(corners[1])) - p, PlainVec(at(corners[2])) - p);
    const double length = std::sqrt(dot(area, area));
    Face& made = face(f);
    made = Face{};
    made.triangle.corners = corners;
    made.triangle.beyond = beyond;
    made.triangle.normal = length > 0.0 ? area / length : area;
    made.triangle.offset = dot(made.triangle.normal, p);
    fresh_.push_back({made.triangle.normal, made.triangle.offset, f});
    return f;
  }

  /// Keeps a point with the one of the new faces of which it is farthest outside.
  void giveToFace(int point) {
    const PlainVec p(at(point));
    double most = on_face_;
    int best = kNone;
    for (const Plane& plane : fresh_) {
      const double value = dot(plane.normal, p) - plane.offset;
      if (value > most) most = value, best = plane.face;
    }
    if (best == kNone) return;
    Face& owner = face(best);
    if (owner.first_outside == kNone) {
      pending_.push_back(best);
      owner.farthest = point, owner.most = most;
    } else if (isFarther(most, point, owner.most, owner.farthest)) {
      owner.farthest = point, owner.most = most;
    }
    mark(point).next_outside = owner.first_outside;
    owner.first_outside = point;
  }

  void add(int point, int seen_face) {
    findSeen(point, seen_face);
    if (!isRimOneLoop()) return leaveOut(point, seen_face);
    orphans_.clear();
    for (const int f : seen_) {
      for (int i = face(f).first_outside; i != kNone; i = mark(i).next_outside)
        if (i != point) orphans_.push_back(i);
      face(f).is_alive = false;
      face(f).first_outside = kNone;
      free_.push_back(f);
    }
    fresh_.clear();
    for (const Rim& rim : rim_) {
      const int f = makeFace({rim.from, rim.to, point}, {rim.beyond, kNone, kNone});
      face(rim.beyond).triangle.beyond[rim.side] = f;
    }
    for (std::size_t r = 0; r < rim_.size(); ++r) {
      const auto after = static_cast<std::size_t>(mark(rim_[r].to).rim);
      face(fresh_[r].face).triangle.beyond[1] = fresh_[after].face;
      face(fresh_[after].face).triangle.beyond[2] = fresh_[r].face;
    }
    for (const int i : orphans_) giveToFace(i);
  }

  /// Collects the faces that a point sees, which hang together, and their rim.
  void findSeen(int point, int first) {
    const double least = 1e-2 * on_face_;  // less is rounding, in the face's plane
    const Vec3 p = at(point);
    seen_.assign(1, first);
    face(first).is_seen = true;
    rim_.clear();
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const HullTriangle here = face(seen_[i]).triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        Face& other = face(here.beyond[k]);
        if (other.is_seen) continue;
        if (other.triangle.height(p) > least) {
          other.is_seen = true;
          seen_.push_back(here.beyond[k]);
          continue;
        }
        std::size_t side = 0;
        while (side < 2 && other.triangle.beyond[side] != seen_[i]) ++side;
        rim_.push_back({here.corners[k], here.corners[(k + 1) % 3], here.beyond[k], side});
      }
    }
  }

  /// True if the rim goes around once. Rounding may break it.
  [[nodiscard]] bool isRimOneLoop() {
    if (rim_.size() < 3) return false;
    ++step_;
    for (std::size_t r = 0; r < rim_.size(); ++r) {
      PointMark& start = mark(rim_[r].from);
      if (start.step == step_) return false;
      start.step = step_;
      start.rim = static_cast<int>(r);
    }
    std::size_t at_rim = 0;
    for (std::size_t count = 1;; ++count) {
      const PointMark& next = mark(rim_[at_rim].to);
      if (next.step != step_) return false;
      at_rim = static_cast<std::size_t>(next.rim);
      if (at_rim == 0) return count == rim_.size();
    }
  }

  /// Forgets a point that cannot be added, if it is hardly outside.
  void leaveOut(int point, int seen_face) {
    has_left_some_ = true;
    is_closed_ = face(seen_face).most <= 10.0 * on_face_;
    for (const int f : seen_) face(f).is_seen = false;
    orphans_.clear();
    for (int i = face(seen_face).first_outside; i != kNone; i = mark(i).next_outside)
      if (i != point) orphans_.push_back(i);
    Face& owner = face(seen_face);
    owner.first_outside = owner.farthest = kNone;
    fresh_.assign(1, {owner.triangle.normal, owner.triangle.offset, seen_face});
    for (const int i : orphans_) giveToFace(i);
  }

  const std::vector<Vec3>& points_;
  std::vector<PointMark> marks_;
  Vec3 middle_ = Vec3::Zero();
  double size_ = 0.0, on_face_ = 0.0;  // [m]
  bool is_closed_ = true, has_left_some_ = false;
  int step_ = 0;
  std::vector<Face> faces_;
  std::vector<int> free_, pending_, seen_, orphans_;
  std::vector<Rim> rim_;
  std::vector<Plane> fresh_;  ///< planes of the faces of this step
};

}  // namespace

std::optional<HullTriangles> makeHullTriangles(const std::vector<Vec3>& points, double precision) {
  if (points.size() < 4) throw std::invalid_argument("a convex hull needs at least four points");
  return QuickHull(points, precision).take();
}

}  // namespace tandem
