#include "scene/round_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/mesh_parts.h"

namespace tandem::view {
namespace {

constexpr double kPi = std::numbers::pi;

/// A direction in the plane of the outline, as its angle above the level [rad] and its two parts.
struct Normal {
  double angle = 0;
  btScalar radius = 0, height = 0;
};

/// A point of the grown outline. Two at one place, with two normals, make a sharp edge.
struct Ring {
  OutlinePoint at;
  Normal normal;
};

Normal makeNormal(double angle) {
  return {angle, static_cast<btScalar>(std::cos(angle)), static_cast<btScalar>(std::sin(angle))};
}

// The normals at the axis are exact, so that the poles are single points.
Normal downwards() { return {-kPi / 2, 0, -1}; }
Normal upwards() { return {kPi / 2, 0, 1}; }

Normal edgeNormal(const OutlinePoint& from, const OutlinePoint& to) {
  const btScalar out = to.height - from.height, up = from.radius - to.radius;
  if (out == 0) return up < 0 ? downwards() : upwards();
  const btScalar length = std::hypot(out, up);
  return {std::atan2(static_cast<double>(up), static_cast<double>(out)), out / length, up / length};
}

/// Number of straight pieces of an arc, so that it is as near to the true one as the strips around
/// the axis are. A shape that is not finite gets a finite number.
int countArcPieces(double angle, double margin, double widest) {
  if (!(angle > 0)) return 0;
  const double gap = widest * (1 - std::cos(kPi / kRoundSegments));
  if (!(margin > gap)) return 1;
  const double step = 2 * std::acos(1 - gap / margin);
  return std::max(1, static_cast<int>(std::ceil(angle / step - 1e-3)));
}

/// Rounds one corner of the outline by the margin.
void addArc(std::vector<Ring>& rings, const OutlinePoint& corner, const Normal& from,
            const Normal& to, btScalar margin, btScalar widest) {
  const double angle = to.angle - from.angle;
  const int pieces =
      countArcPieces(angle, static_cast<double>(margin), static_cast<double>(widest));
  for (int piece = 0; piece <= pieces; ++piece) {
    const bool is_end = piece == pieces;
    const Normal between = makeNormal(from.angle + angle * piece / std::max(pieces, 1));
    const Normal normal = piece == 0 ? from : is_end ? to : between;
    const OutlinePoint at = {corner.radius + margin * normal.radius,
                             corner.height + margin * normal.height};
    rings.push_back({at, normal});
  }
}

bool isSame(const OutlinePoint& a, const OutlinePoint& b) {
  return a.radius == b.radius && a.height == b.height;
}

std::vector<OutlinePoint> withoutRepeats(std::vector<OutlinePoint> outline) {
  outline.erase(std::unique(outline.begin(), outline.end(), isSame), outline.end());
  return outline;
}

std::vector<Ring> growOutline(const std::vector<OutlinePoint>& outline, btScalar margin) {
  btScalar widest = margin;
  for (const OutlinePoint& point : outline) widest = std::max(widest, point.radius + margin);

  std::vector<Ring> rings;
  Normal before = downwards();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const bool is_last = i + 1 == outline.size();
    const Normal after = is_last ? upwards() : edgeNormal(outline[i], outline[i + 1]);
    addArc(rings, outline[i], before, after, margin, widest);
    before = after;
  }
  return rings;
}

/// Turns outlines about an axis.
class Lathe {
 public:
  explicit Lathe(int axis) : axis_(axis) {
    for (std::size_t i = 0; i < kRoundSegments; ++i) {
      const double angle = 2 * kPi * static_cast<double>(i) / kRoundSegments;
      turns_[i] = {static_cast<btScalar>(std::cos(angle)), static_cast<btScalar>(std::sin(angle))};
    }
  }

  /// A point of the ring, or a direction, at one of the turns; the last turn is the first again.
  [[nodiscard]] btVector3 turn(btScalar radius, btScalar height, std::size_t at) const {
    const auto [cosine, sine] = turns_[at % kRoundSegments];
    btVector3 p;
    p[axis_] = height;
    p[(axis_ + 1) % 3] = radius * cosine;
    p[(axis_ + 2) % 3] = radius * sine;
    return p;
  }

  /// Adds the vertices of a ring and gives back the index of the first.
  std::uint32_t addRing(ShapeMesh& mesh, const Ring& ring) const {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::size_t i = 0; i < kRoundSegments; ++i) {
      addVertex(mesh, turn(ring.at.radius, ring.at.height, i),
                turn(ring.normal.radius, ring.normal.height, i));
    }
    return first;
  }

 private:
  struct Turn {
    btScalar cosine = 1, sine = 0;
  };
  std::array<Turn, kRoundSegments> turns_;
  int axis_;
};

/// Adds the strip between two rings. At a pole the strip's quads are triangles.
void addStrip(ShapeMesh& mesh, const Ring& low, std::uint32_t first_low, const Ring& high,
              std::uint32_t first_high) {
  if (isSame(low.at, high.at)) return;
  constexpr std::uint32_t kSegments = kRoundSegments;
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const std::uint32_t next = (i + 1) % kSegments;
    const auto a = first_low + i, b = first_low + next;
    const auto c = first_high + next, d = first_high + i;
    if (low.at.radius > 0) mesh.indices.insert(mesh.indices.end(), {a, b, c});
    if (high.at.radius > 0) mesh.indices.insert(mesh.indices.end(), {a, c, d});
  }
}

}  // namespace

ShapeMesh makeRoundMesh(const std::vector<OutlinePoint>& outline, btScalar margin, int axis) {
  const std::vector<Ring> rings = growOutline(withoutRepeats(outline), margin);
  const Lathe lathe(axis);
  ShapeMesh mesh;
  std::uint32_t first_low = 0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const std::uint32_t first = lathe.addRing(mesh, rings[i]);
    if (i > 0) addStrip(mesh, rings[i - 1], first_low, rings[i], first);
    first_low = first;
  }
  return mesh;
}

}  // namespace tandem::view
