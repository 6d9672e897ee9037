#include "geometry/compound_parts.h"

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "bad_value.h"

namespace tandem {
namespace {

/// A ball around the box that holds a shape, in the shape's frame.
struct Ball {
  Vec3 middle;
  double radius;
};

Ball findBall(const Shape& shape) {
  Vec3 high, low;
  for (int axis = 0; axis < 3; ++axis) {
    high[axis] = computeReach(shape, Vec3::Unit(axis));
    low[axis] = -computeReach(shape, -Vec3::Unit(axis));
  }
  const Ball around_box{0.5 * (low + high), 0.5 * (high - low).norm()};
  const Ball around_origin{Vec3::Zero(), computeBoundingRadius(shape)};
  return around_box.radius < around_origin.radius ? around_box : around_origin;
}

void checkPose(const ShapePart& part) {
  if (!part.p_BC.allFinite())
    throwBadValue("position of a part", part.p_BC.transpose(), "finite [m]");
  if (!part.q_BC.coeffs().allFinite() || !(part.q_BC.norm() > 0.0))
    throwBadValue("orientation of a part", part.q_BC.coeffs().transpose(), "finite and not 0");
}

}  // namespace

CompoundParts::CompoundParts(const std::vector<ShapePart>& shapes) {
  for (const ShapePart& shape : shapes) add(shape);
  if (parts_.empty()) throw std::invalid_argument("a compound needs a shape");
}

void CompoundParts::add(const ShapePart& part) {
  checkPose(part);
  checkShape(part.shape);
  if (std::holds_alternative<Plane>(part.shape))
    throw std::invalid_argument("a plane cannot be part of a compound; give it a body of its own");
  const Quat q_BC = part.q_BC.normalized();
  if (const auto* compound = std::get_if<Compound>(&part.shape)) {
    for (const Part& inner : compound->parts->all())
      add({inner.shape, part.p_BC + q_BC * inner.p_BC, q_BC * inner.q_BC});
    return;
  }
  const Ball ball = findBall(part.shape);
  const Vec3 middle_B = part.p_BC + q_BC * ball.middle;
  parts_.push_back({part.shape, part.p_BC, q_BC, PlainRotation(q_BC), middle_B, ball.radius});
  const double from_origin = part.p_BC.norm() + computeBoundingRadius(part.shape);
  bounding_radius_ =
      std::max(bounding_radius_, std::min(from_origin, middle_B.norm() + ball.radius));
}

Compound makeCompound(const std::vector<ShapePart>& shapes) {
  return {std::make_shared<const CompoundParts>(shapes)};
}

}  // namespace tandem
