#include "geometry/held_face.h"

#include <limits>

#include "geometry/face_heights.h"

namespace tandem {
namespace {

/// Cosine of the angle at which faces are turned away from each other: 90 degrees, with rounding.
constexpr double kTurnedAway = -1e-6;

/// Rounding error of a height [m].
constexpr double kSameHeight = 1e-12;

/// Faces of a box: 2 axis + (side < 0).
struct BoxFaces {
  const PlainVec& c;
  const Vec3& half_extents;

  [[nodiscard]] int count() const { return 6; }
  [[nodiscard]] double height(int face) const {
    return detail::leaveByFace(c, half_extents, face).distance;
  }
  [[nodiscard]] bool isHidden(int face, int touched) const { return face == (touched ^ 1); }
  [[nodiscard]] bool isBeside(int) const { return false; }
};

/// Faces of a cylinder: LeaveCylinder.
struct CylinderFaces {
  const PlainVec& c;
  const Cylinder& cylinder;

  [[nodiscard]] int count() const { return 3; }
  [[nodiscard]] double height(int face) const { return leaveByFace(c, cylinder, face).distance; }
  [[nodiscard]] bool isHidden(int face, int touched) const {
    return face != kSide && touched != kSide && face != touched;
  }
  [[nodiscard]] bool isBeside(int) const { return false; }
};

/// Faces of a cone: LeaveCone. They are turned away from each other, however flat the cone is.
struct ConeFaces {
  const PlainVec& c;
  const Cone& cone;

  [[nodiscard]] int count() const { return 2; }
  [[nodiscard]] double height(int face) const {
    return leaveByFace(c, cone, face).distance + cone.rounding;
  }
  [[nodiscard]] bool isHidden(int face, int touched) const { return face != touched; }
  [[nodiscard]] bool isBeside(int face) const { return isBesideFace(c, cone, face); }
};

struct HullFaces {
  const PlainVec& c;
  const ConvexPolyhedron& solid;

  [[nodiscard]] const ConvexPolyhedron::Face& at(int face) const {
    return solid.faces()[static_cast<std::size_t>(face)];
  }
  [[nodiscard]] int count() const { return static_cast<int>(solid.faces().size()); }
  [[nodiscard]] double height(int face) const { return heightOver(at(face), c); }
  [[nodiscard]] bool isHidden(int face, int touched) const {
    return at(face).normal.dot(at(touched).normal) < kTurnedAway;
  }
  /// True if the centre's foot is beside a face whose neighbours are turned away from it.
  [[nodiscard]] bool isBeside(int face) const { return computeWayBeside(solid, at(face), c) > 0.0; }
};

/// Heights of the centre over the faces of a convex solid, as a centre behind `touched` needs them.
struct Heights {
  bool is_through = false;  ///< the centre is out by a face that is turned away
  int highest = -1;         ///< of the faces that are not turned away, except one
  double height = -std::numeric_limits<double>::infinity();
};

template <typename Faces>
Heights look(const Faces& faces, int touched, int except) noexcept {
  Heights found;
  for (int face = 0; face < faces.count(); ++face) {
    const double height = faces.height(face);
    if (faces.isHidden(face, touched))
      found.is_through |= height >= 0.0;
    else if (face != except && height > found.height)
      found.highest = face, found.height = height;
  }
  return found;
}

template <typename Faces>
int follow(const Faces& faces, int touched) noexcept {
  const Heights found = look(faces, touched, -1);
  if (!(found.height < 0.0)) return -1;
  if (!found.is_through) return found.highest;
  return faces.isBeside(touched) ? -1 : touched;
}

template <typename Faces>
double computeLead(const Faces& faces, int face, int touched) noexcept {
  const Heights others = look(faces, touched, face);
  const double own = faces.height(face);
  // Right under its face, or out by another side, the centre stays until it is beside the face.
  if (own >= 0.0 || others.is_through) return -others.height;
  // Faces in one plane count as one face.
  return own - others.height + kSameHeight;
}

/// Calls `visit` with the faces of a shape that has some.
template <typename Visit>
auto withFaces(const PlainVec& c, const Shape& shape, Visit visit) noexcept {
  if (const auto* box = std::get_if<Box>(&shape)) return visit(BoxFaces{c, box->half_extents});
  if (const auto* round = std::get_if<Cylinder>(&shape)) return visit(CylinderFaces{c, *round});
  if (const auto* cone = std::get_if<Cone>(&shape)) return visit(ConeFaces{c, *cone});
  return visit(HullFaces{c, *std::get_if<ConvexHull>(&shape)->solid});
}

}  // namespace

int followFace(const PlainVec& c, const Shape& shape, int touched) noexcept {
  return withFaces(c, shape, [&](const auto& faces) { return follow(faces, touched); });
}

double computeHeldLead(const PlainVec& c, const Shape& shape, int face, int touched) noexcept {
  return withFaces(c, shape, [&](const auto& faces) { return computeLead(faces, face, touched); });
}

bool isBehind(const PlainVec& c, const TriangleMesh& mesh, int triangle) noexcept {
  return heightOver(triangleAt(mesh, triangle), c) < 0.0;
}

bool isHidden(const PlainVec& c, const TriangleMesh& mesh, int touched, int triangle) noexcept {
  if (touched < 0 || !isBehind(c, mesh, touched)) return false;
  const TriangleMesh::Triangle &in_touch = triangleAt(mesh, touched),
                               &other = triangleAt(mesh, triangle);
  if (!(in_touch.normal.dot(other.normal) < kTurnedAway)) return false;
  const PlainVec foot = c - heightOver(in_touch, c) * PlainVec(in_touch.normal);
  return heightOver(other, foot) < -kSameHeight;
}

}  // namespace tandem
