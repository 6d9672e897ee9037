// Sphere against every other shape, at any places, attitudes and sizes of finite doubles.
//
// Input: one byte for the shape, then doubles: the sphere's centre and radius, the shape's three
// sizes, its position and its quaternion. Missing bytes are zeros.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "coordination/src/geometry/contact_geometry.h"
#include "support/solids.h"

namespace tandem {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// Reads doubles from the front of the input.
class Reader {
 public:
  Reader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t byte() {
    std::uint8_t value = 0;
    take(&value, sizeof value);
    return value;
  }

  /// Any finite number.
  double number() {
    double value = 0.0;
    take(&value, sizeof value);
    return std::isfinite(value) ? value : 0.0;
  }

  Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }

  /// A unit quaternion; none if the four numbers give no direction.
  Quat attitude() {
    const double w = number();
    const Vec3 v = vector();
    const double size = std::max({std::abs(w), std::abs(v.x()), std::abs(v.y()), std::abs(v.z())});
    if (size == 0.0) return Quat::Identity();
    return Quat(w / size, v.x() / size, v.y() / size, v.z() / size).normalized();
  }

 private:
  void take(void* value, std::size_t size) {
    const std::size_t count = std::min(size, size_);
    if (count > 0) std::memcpy(value, data_, count);
    data_ += count;
    size_ -= count;
  }

  const std::uint8_t* data_;
  std::size_t size_;
};

double clampSize(double value) { return std::clamp(std::abs(value), 1e-6, 1e3); }

Vec3 clampPlace(const Vec3& place) { return place.cwiseMin(1e3).cwiseMax(-1e3); }

/// Sizes of a solid with faces: none below a thousandth of another.
Vec3 makeSturdy(const Vec3& sizes) {
  const Vec3 clamped = sizes.unaryExpr(&clampSize);
  return clamped.cwiseMax(1e-3 * clamped.maxCoeff());
}

Shape makeShape(std::uint8_t kind, const Vec3& sizes, const Vec3& direction) {
  const Axis axis = static_cast<Axis>(kind / 8 % 3);
  switch (kind % 8) {
    case 0:
      return Sphere{sizes.x()};
    case 1:
      return Box{sizes};
    case 2:
      return Capsule{sizes.x(), sizes.y(), axis};
    case 4:
      return Cylinder{sizes.x(), sizes.y(), axis};
    case 5:
      return test::makeHull(test::makeOctahedron(makeSturdy(sizes)), std::abs(sizes.y()));
    case 6:
      return test::makeMesh(test::cutIntoTriangles(test::makeBoxSolid(makeSturdy(sizes))));
    case 7:
      return Cone{sizes.x(), sizes.y(), axis, std::abs(sizes.z())};
    default:
      return Plane{direction, sizes.z()};
  }
}

/// Promises of findSphereContact() for sizes of a micrometre to a kilometre within a kilometre.
void requireContact(const SphereContact& contact, const Vec3& centre, double radius) {
  // The largest numbers are 1e3 m, through sums of three: rounding is about 1e-12.
  constexpr double kRounding = 1e-8;  // [m]
  require(std::isfinite(contact.gap) && contact.p_W.allFinite());
  require(std::abs(contact.n_W.norm() - 1.0) < 1e-9);
  const Vec3 along_normal = contact.p_W + (contact.gap + radius) * contact.n_W;
  require((along_normal - centre).norm() < kRounding);
}

void check(Reader input) {
  const std::uint8_t kind = input.byte();
  const Vec3 centre = input.vector();
  const double radius = input.number();
  const Vec3 sizes = input.vector();
  const Vec3 place = input.vector();
  const Quat attitude = input.attitude();
  const Vec3 direction = attitude * Vec3::UnitX();

  // With raw input, any answer is right, as long as there is one.
  static_cast<void>(
      findSphereContact(centre, radius, makeShape(kind, sizes, direction), place, attitude));

  const Shape shape = makeShape(kind, sizes.unaryExpr(&clampSize), direction);
  const Vec3 near_centre = clampPlace(centre);
  requireContact(
      findSphereContact(near_centre, clampSize(radius), shape, clampPlace(place), attitude),
      near_centre, clampSize(radius));
}

}  // namespace
}  // namespace tandem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tandem::check({data, size});
  return 0;
}
