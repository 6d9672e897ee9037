#include "tandem/coordination/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bad_value.h"
#include "geometry/compound_parts.h"
#include "geometry/convex_polyhedron.h"
#include "geometry/triangle_mesh.h"

namespace tandem {
namespace {

// Large enough for a normal that was normalised in single precision.
constexpr double kUnitTolerance = 1e-6;

double boundingRadius(const Sphere& sphere) noexcept { return sphere.radius; }
double boundingRadius(const Box& box) noexcept { return box.half_extents.norm(); }
double boundingRadius(const Capsule& capsule) noexcept {
  return capsule.half_length + capsule.radius;
}
double boundingRadius(const Plane&) noexcept { return std::numeric_limits<double>::infinity(); }
double boundingRadius(const Cylinder& cylinder) noexcept {
  return std::hypot(cylinder.radius, cylinder.half_length);
}
double boundingRadius(const Cone& cone) noexcept {
  return std::hypot(cone.radius, cone.half_length) + cone.rounding;
}
double boundingRadius(const ConvexHull& hull) noexcept {
  return hull.solid->boundingRadius() + hull.rounding;
}
double boundingRadius(const Mesh& mesh) noexcept {
  return mesh.surface->boundingRadius() + mesh.skin;
}
double boundingRadius(const Compound& compound) noexcept {
  return compound.parts->boundingRadius();
}

double reach(const Sphere& sphere, const Vec3&) noexcept { return sphere.radius; }
double reach(const Box& box, const Vec3& d) noexcept { return box.half_extents.dot(d.cwiseAbs()); }
double reach(const Capsule& capsule, const Vec3& d) noexcept {
  return capsule.radius + capsule.half_length * std::abs(d[static_cast<int>(capsule.axis)]);
}
double reach(const Plane&, const Vec3&) noexcept { return std::numeric_limits<double>::infinity(); }
double reach(const Cylinder& cylinder, const Vec3& d) noexcept {
  const double along = std::abs(d[static_cast<int>(cylinder.axis)]);
  const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
  return cylinder.radius * across + cylinder.half_length * along;
}
double reach(const Cone& cone, const Vec3& d) noexcept {
  const double along = d[static_cast<int>(cone.axis)];
  const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
  return std::max(cone.half_length * along, cone.radius * across - cone.half_length * along) +
         cone.rounding;
}
double reach(const ConvexHull& hull, const Vec3& d) noexcept {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Vec3& v : hull.solid->vertices()) farthest = std::max(farthest, d.dot(v));
  return farthest + hull.rounding;
}
double reach(const Mesh& mesh, const Vec3&) noexcept { return boundingRadius(mesh); }
double reach(const Compound& compound, const Vec3& d) noexcept {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const CompoundParts::Part& part : compound.parts->all())
    farthest =
        std::max(farthest, d.dot(part.p_BC) + computeReach(part.shape, part.q_BC.conjugate() * d));
  return farthest;
}

void checkPositive(const char* name, double value) {
  if (!(std::isfinite(value) && value > 0.0)) throwBadValue(name, value, "finite and above 0 m");
}

void checkNotNegative(const char* name, double value) {
  if (!(std::isfinite(value) && value >= 0.0))
    throwBadValue(name, value, "finite and not below 0 m");
}

void check(const Sphere& sphere) { checkPositive("sphere radius", sphere.radius); }

void check(const Box& box) {
  checkPositive("box half_extents.x", box.half_extents.x());
  checkPositive("box half_extents.y", box.half_extents.y());
  checkPositive("box half_extents.z", box.half_extents.z());
}

void check(const Capsule& capsule) {
  checkPositive("capsule radius", capsule.radius);
  checkNotNegative("capsule half_length", capsule.half_length);
}

void check(const Cylinder& cylinder) {
  checkPositive("cylinder radius", cylinder.radius);
  checkPositive("cylinder half_length", cylinder.half_length);
}

void check(const Cone& cone) {
  checkPositive("cone radius", cone.radius);
  checkPositive("cone half_length", cone.half_length);
  checkNotNegative("cone rounding", cone.rounding);
}

void check(const ConvexHull& hull) {
  if (!hull.solid) throw std::invalid_argument("a convex hull needs a solid");
  checkNotNegative("convex hull rounding", hull.rounding);
}

void check(const Mesh& mesh) {
  if (!mesh.surface) throw std::invalid_argument("a mesh needs a surface");
  checkNotNegative("mesh skin", mesh.skin);
}

/// Its parts have been checked.
void check(const Compound& compound) {
  if (!compound.parts) throw std::invalid_argument("a compound needs parts");
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

double computeReach(const Shape& shape, const Vec3& direction_B) noexcept {
  return std::visit([&](const auto& s) { return reach(s, direction_B); }, shape);
}

void checkShape(const Shape& shape) {
  std::visit([](const auto& s) { check(s); }, shape);
}

}  // namespace tandem
