#include "tandem/coordination/shape.h"

#include <cmath>
#include <limits>

#include "bad_value.h"

namespace tandem {
namespace {

// Wide enough for a normal that was made unit in single precision.
constexpr double kUnitTolerance = 1e-6;

double boundingRadius(const Sphere& sphere) noexcept { return sphere.radius; }
double boundingRadius(const Box& box) noexcept { return box.half_extents.norm(); }
double boundingRadius(const Capsule& capsule) noexcept {
  return capsule.half_length + capsule.radius;
}
double boundingRadius(const Plane&) noexcept { return std::numeric_limits<double>::infinity(); }

void checkPositive(const char* name, double value) {
  if (!(std::isfinite(value) && value > 0.0)) throwBadValue(name, value, "finite and above 0 m");
}

void check(const Sphere& sphere) { checkPositive("sphere radius", sphere.radius); }

void check(const Box& box) {
  checkPositive("box half_extents.x", box.half_extents.x());
  checkPositive("box half_extents.y", box.half_extents.y());
  checkPositive("box half_extents.z", box.half_extents.z());
}

void check(const Capsule& capsule) {
  checkPositive("capsule radius", capsule.radius);
  const double half_length = capsule.half_length;
  if (!(std::isfinite(half_length) && half_length >= 0.0))
    throwBadValue("capsule half_length", half_length, "finite and not below 0 m");
}

void check(const Plane& plane) {
  const double length = plane.normal_B.norm();
  if (!(std::abs(length - 1.0) <= kUnitTolerance))
    throwBadValue("length of plane normal_B", length, "1 within 1e-6; normalise it");
  if (!std::isfinite(plane.offset)) throwBadValue("plane offset", plane.offset, "finite");
}

}  // namespace

double computeBoundingRadius(const Shape& shape) noexcept {
  return std::visit([](const auto& s) { return boundingRadius(s); }, shape);
}

void checkShape(const Shape& shape) {
  std::visit([](const auto& s) { check(s); }, shape);
}

}  // namespace tandem
