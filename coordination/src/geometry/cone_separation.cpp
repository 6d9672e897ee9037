#include <algorithm>
#include <cmath>

#include "geometry/round.h"
#include "geometry/separation.h"

// clang-format off
// Half of a cone's section. A centre outside goes to the nearest point of tip, side, rim or base, a
// centre inside to the nearer of side and base.
//
//         up ^  tip
//            |\         slope: distance from the tip down the side
//            | \  side
//            |  \ .
//            |   \      out of the side
//            +----\--> across
//             base  rim
// clang-format on

namespace tandem {
namespace {

/// A centre beside a cone's core, which has no rounding.
struct BesideCone {
  detail::Round at;
  double length;     ///< of the side, from tip to rim [m]
  PlainVec up;       ///< unit vector from base to tip
  PlainVec n_side;   ///< out of the side, right beside the centre
  double over_side;  ///< height over the side [m]
  double over_base;  ///< height below the base [m]
  double slope;      ///< of the nearest point of the side's line [m]
};

BesideCone lookBeside(const PlainVec& c, const Cone& cone) noexcept {
  const double r = cone.radius, height = 2.0 * cone.half_length;
  BesideCone beside;
  beside.at = detail::lookAlong(c, cone.axis);
  beside.length = std::sqrt(r * r + height * height);
  beside.up = detail::pointAlong(cone.axis, 1.0);
  const double across = height / beside.length, along = r / beside.length;
  const double from_tip = beside.at.along - cone.half_length;
  beside.n_side = across * beside.at.outwards + along * beside.up;
  beside.over_side = across * beside.at.across + along * from_tip;
  beside.over_base = -cone.half_length - beside.at.along;
  beside.slope = along * beside.at.across - across * from_tip;
  return beside;
}

/// Separation of an outside centre that is not right below the base.
Separation comeFromSide(const BesideCone& beside, const Cone& cone) noexcept {
  const double slope = std::clamp(beside.slope, 0.0, beside.length);
  if (slope == beside.slope)
    return {beside.over_side - cone.rounding, beside.n_side, -1, 0.0, kConeSide};
  const bool is_over_tip = slope == 0.0;
  const double across = beside.at.across - (is_over_tip ? 0.0 : cone.radius);
  const double along = beside.at.along - (is_over_tip ? 1.0 : -1.0) * cone.half_length;
  const double square = across * across + along * along;
  if (square < detail::kSmallestSquare) return {beside.over_side - cone.rounding, beside.n_side};
  const double distance = std::sqrt(square);
  return {distance - cone.rounding,
          (1.0 / distance) * (across * beside.at.outwards + along * beside.up)};
}

}  // namespace

Separation separate(const PlainVec& c, const Cone& cone) noexcept {
  const BesideCone beside = lookBeside(c, cone);
  const bool is_inside = beside.over_side <= 0.0 && beside.over_base <= 0.0;
  if (is_inside && beside.over_side >= beside.over_base)
    return {beside.over_side - cone.rounding, beside.n_side, kConeSide};
  if (is_inside || (beside.over_base > 0.0 && beside.at.across <= cone.radius))
    return {beside.over_base - cone.rounding, -1.0 * beside.up, is_inside ? kConeBase : -1, 0.0,
            kConeBase};
  return comeFromSide(beside, cone);
}

Separation leaveByFace(const PlainVec& c, const Cone& cone, int face) noexcept {
  const BesideCone beside = lookBeside(c, cone);
  const double height = face == kConeSide ? beside.over_side : beside.over_base;
  // Outside the core but inside its rounding, the centre has no face to leave through.
  return {height - cone.rounding, face == kConeSide ? beside.n_side : -1.0 * beside.up,
          height < 0.0 ? face : -1};
}

bool isBesideFace(const PlainVec& c, const Cone& cone, int face) noexcept {
  const BesideCone beside = lookBeside(c, cone);
  if (face == kConeBase) return beside.at.across > cone.radius;
  return beside.slope < 0.0 || beside.slope > beside.length;
}

double computeFaceLead(const PlainVec& c, const Cone& cone, int face) noexcept {
  const BesideCone beside = lookBeside(c, cone);
  if (face == kConeSide) {
    if (beside.over_side < 0.0) return beside.over_side - beside.over_base;
    return std::min(beside.slope, beside.length - beside.slope);
  }
  if (beside.over_base < 0.0) return beside.over_base - beside.over_side;
  return cone.radius - beside.at.across;
}

}  // namespace tandem
