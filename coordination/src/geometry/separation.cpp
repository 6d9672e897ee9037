#include "geometry/separation.h"

#include <limits>

#include "geometry/compound_parts.h"
#include "geometry/face_heights.h"
#include "geometry/held_face.h"
#include "geometry/round.h"

// Cylinders and hulls: a centre outside goes to the nearest point of the surface, a centre inside
// to the nearest face.

namespace tandem {
namespace {

/// Vector to an outside centre from the nearest point of the faces that it is in front of.
PlainVec comeFromFaces(const ConvexPolyhedron& solid, const PlainVec& c) noexcept {
  double least = std::numeric_limits<double>::infinity();
  PlainVec shortest;
  for (const ConvexPolyhedron::Face& face : solid.faces()) {
    const double height = heightOver(face, c);
    if (!(height > 0.0)) continue;
    bool is_over = true;
    const ConvexPolyhedron::Side* side = solid.sides(face);
    for (int i = 0; i < face.count; ++i) {
      const PlainVec from_start = c - PlainVec(side[i].start);
      if (!(dot(PlainVec(side[i].outward), from_start) > 0.0)) continue;
      is_over = false;
      const PlainVec along(side[i].along);
      const double t = std::clamp(dot(along, from_start), 0.0, side[i].length);
      const PlainVec way = from_start - t * along;
      const double square = dot(way, way);
      if (square < least) least = square, shortest = way;
    }
    if (is_over && height * height < least) {
      least = height * height;
      shortest = height * PlainVec(face.normal);
    }
  }
  return shortest;
}

}  // namespace

Separation separate(const PlainVec& c, const Cylinder& cylinder) noexcept {
  const detail::Round at = detail::lookAlong(c, cylinder.axis);
  const double over_side = at.across - cylinder.radius;
  const double over_end = std::abs(at.along) - cylinder.half_length;
  const PlainVec end = detail::pointAlong(cylinder.axis, at.along < 0.0 ? -1.0 : 1.0);
  if (over_side > 0.0 && over_end > 0.0) {
    const double distance = std::sqrt(over_side * over_side + over_end * over_end);
    if (distance * distance >= detail::kSmallestSquare)
      return {distance, (1.0 / distance) * (over_side * at.outwards + over_end * end)};
  }
  const bool is_inside = over_side <= 0.0 && over_end <= 0.0;
  if (over_side >= over_end)
    return {over_side, at.outwards, is_inside ? kSide : -1, 0.0, over_end <= 0.0 ? kSide : -1};
  const int end_face = at.along < 0.0 ? kLowerEnd : kUpperEnd;
  return {over_end, end, is_inside ? end_face : -1, 0.0, over_side <= 0.0 ? end_face : -1};
}

Separation leaveByFace(const PlainVec& c, const Cylinder& cylinder, int face) noexcept {
  const detail::Round at = detail::lookAlong(c, cylinder.axis);
  if (face == kSide) return {at.across - cylinder.radius, at.outwards, face};
  const double side = face == kUpperEnd ? 1.0 : -1.0;
  return {side * at.along - cylinder.half_length, detail::pointAlong(cylinder.axis, side), face};
}

double computeFaceLead(const PlainVec& c, const Cylinder& cylinder, int face) noexcept {
  const detail::Round at = detail::lookAlong(c, cylinder.axis);
  const double over_side = at.across - cylinder.radius;
  const double over_end = std::abs(at.along) - cylinder.half_length;
  if (face == kSide) return over_side < 0.0 ? over_side - over_end : -over_end;
  // The centre left through this end, which stays nearest while the centre is over it.
  const double own = (face == kUpperEnd ? at.along : -at.along) - cylinder.half_length;
  if (own >= 0.0) return -over_side;
  return own - std::max(over_side, -own - 2.0 * cylinder.half_length);
}

Separation separate(const PlainVec& c, const ConvexHull& hull) noexcept {
  const ConvexPolyhedron& solid = *hull.solid;
  const std::vector<ConvexPolyhedron::Face>& faces = solid.faces();
  std::size_t nearest = 0;
  double height = heightOver(faces[0], c);
  for (std::size_t i = 1; i < faces.size(); ++i)
    if (const double h = heightOver(faces[i], c); h > height) height = h, nearest = i;

  const ConvexPolyhedron::Face& face = faces[nearest];
  Separation found{height - hull.rounding, PlainVec(face.normal)};
  found.under = static_cast<int>(nearest);
  if (height <= 0.0) {
    found.face = found.under;
    return found;
  }
  // The highest face is the nearest one if the centre is right over it.
  if (computeWayBeside(solid, face, c) <= 0.0) return found;
  const PlainVec way = comeFromFaces(solid, c);
  const double distance = std::sqrt(dot(way, way));
  // At a smaller distance rounding hides the direction.
  found.under = -1;
  if (distance < detail::kOnCore) return found;
  return {distance - hull.rounding, way / distance};
}

Separation leaveByFace(const PlainVec& c, const ConvexHull& hull, int face) noexcept {
  const ConvexPolyhedron::Face& own = hull.solid->faces()[static_cast<std::size_t>(face)];
  const double height = heightOver(own, c);
  // Outside the solid but inside its rounding, the centre has no face to leave through.
  return {height - hull.rounding, PlainVec(own.normal), height < 0.0 ? face : -1};
}

double computeFaceLead(const PlainVec& c, const ConvexHull& hull, int face) noexcept {
  const ConvexPolyhedron& solid = *hull.solid;
  const auto own = static_cast<std::size_t>(face);
  const double height = heightOver(solid.faces()[own], c);
  if (height >= 0.0) return -computeWayBeside(solid, solid.faces()[own], c);
  double others = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < solid.faces().size(); ++i)
    if (i != own) others = std::max(others, heightOver(solid.faces()[i], c));
  // Faces in one plane count as one face.
  return height - others + detail::kOnCore;
}

Separation separate(const PlainVec& c, const Compound& compound) noexcept {
  Separation nearest{std::numeric_limits<double>::infinity(), {1.0, 0.0, 0.0}};
  for (const CompoundParts::Part& part : compound.parts->all()) {
    const Separation found = separate(part.toPart(c), part.shape);
    if (found.distance < nearest.distance) nearest = {found.distance, part.toBody(found.n)};
  }
  return nearest;
}

Separation leaveAnyByFace(const PlainVec& c, const Shape& shape, int piece, int face) noexcept {
  if (const auto* box = std::get_if<Box>(&shape))
    return detail::leaveByFace(c, box->half_extents, face);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return leaveByFace(c, *cylinder, face);
  if (const auto* hull = std::get_if<ConvexHull>(&shape)) return leaveByFace(c, *hull, face);
  if (const auto* cone = std::get_if<Cone>(&shape)) return leaveByFace(c, *cone, face);
  return leaveByFace(c, *std::get_if<Mesh>(&shape), piece, face);
}

double computeAnyFaceLead(const PlainVec& c, const Shape& shape, int piece, int face,
                          int touched) noexcept {
  if (piece < 0 && touched >= 0) return computeHeldLead(c, shape, face, touched);
  if (const auto* box = std::get_if<Box>(&shape)) return computeFaceLead(c, *box, face);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return computeFaceLead(c, *cylinder, face);
  if (const auto* hull = std::get_if<ConvexHull>(&shape)) return computeFaceLead(c, *hull, face);
  if (const auto* cone = std::get_if<Cone>(&shape)) return computeFaceLead(c, *cone, face);
  return computeFaceLead(c, *std::get_if<Mesh>(&shape), piece, face, touched);
}

}  // namespace tandem
