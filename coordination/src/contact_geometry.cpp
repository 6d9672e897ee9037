#include "tandem/coordination/contact_geometry.h"

#include <algorithm>
#include <cmath>

// All shapes are worked out in the body's frame, where a centre c has a signed distance to the
// surface and a direction out of the shape. The rest is the same for all:
//
//         shape          sphere
//      +---------+
//      |         |  distance = gap + radius
//      |         p---------+-----c          p = c - distance n
//      |         |   gap     radius
//      +---------+   n ->

namespace tandem {
namespace {

/// Vector in the body's frame. Plain doubles stay in registers, where Eigen's vectors go through
/// memory and come back in pairs, which stalls: GCC's code is twice as fast this way.
struct BodyVec {
  double x = 0.0, y = 0.0, z = 0.0;
};

/// A centre's signed distance to a surface [m], below 0 inside, and the direction out (unit
/// length).
struct Separation {
  double distance = 0.0;
  BodyVec n;
};

/// A centre this near to a core [m] stands on it: below rounding there is no direction to leave by.
constexpr double kOnCore = 1e-12;

/// Squares below this have lost digits to underflow, and no direction can be had from them.
constexpr double kSmallestSquare = 1e-290;

/// Rotation by any quaternion but zero: dividing by its square keeps n_W a unit vector for one that
/// is unit only in single precision.
class Rotation {
 public:
  explicit Rotation(const Quat& q) noexcept {
    const double x = q.x(), y = q.y(), z = q.z(), w = q.w();
    const double s = 2.0 / (x * x + y * y + z * z + w * w);
    const double wx = s * w * x, wy = s * w * y, wz = s * w * z;
    const double xx = s * x * x, xy = s * x * y, xz = s * x * z;
    const double yy = s * y * y, yz = s * y * z, zz = s * z * z;
    xx_ = 1.0 - (yy + zz), xy_ = xy - wz, xz_ = xz + wy;
    yx_ = xy + wz, yy_ = 1.0 - (xx + zz), yz_ = yz - wx;
    zx_ = xz - wy, zy_ = yz + wx, zz_ = 1.0 - (xx + yy);
  }

  BodyVec toBody(double x, double y, double z) const noexcept {
    return {xx_ * x + yx_ * y + zx_ * z,  //
            xy_ * x + yy_ * y + zy_ * z,  //
            xz_ * x + yz_ * y + zz_ * z};
  }

  Vec3 toWorld(const BodyVec& v) const noexcept {
    return {xx_ * v.x + xy_ * v.y + xz_ * v.z,  //
            yx_ * v.x + yy_ * v.y + yz_ * v.z,  //
            zx_ * v.x + zy_ * v.y + zz_ * v.z};
  }

 private:
  double xx_, xy_, xz_, yx_, yy_, yz_, zx_, zy_, zz_;  // row, column of the matrix R_WB
};

inline double squaredNorm(const BodyVec& v) noexcept { return v.x * v.x + v.y * v.y + v.z * v.z; }

inline BodyVec divide(const BodyVec& v, double d) noexcept { return {v.x / d, v.y / d, v.z / d}; }

/// A core point, `offset` away from the centre, fattened by `radius`.
inline Separation separateFromCore(const BodyVec& offset, double radius) noexcept {
  const double length = std::sqrt(squaredNorm(offset));
  // x is also across a capsule's core, so the way out is as short as it looks.
  if (length < kOnCore) return {length - radius, {1.0, 0.0, 0.0}};
  return {length - radius, divide(offset, length)};
}

Separation separate(const BodyVec& c, const Sphere& sphere) noexcept {
  return separateFromCore(c, sphere.radius);
}

Separation separate(const BodyVec& c, const Capsule& capsule) noexcept {
  const double core_y = std::clamp(c.y, -capsule.half_length, capsule.half_length);
  return separateFromCore({c.x, c.y - core_y, c.z}, capsule.radius);
}

/// Way out of a box, for a centre inside or on the surface, by the nearest face.
Separation leaveBox(const BodyVec& c, const Vec3& half_extents) noexcept {
  const double depth_x = half_extents.x() - std::abs(c.x);
  const double depth_y = half_extents.y() - std::abs(c.y);
  const double depth_z = half_extents.z() - std::abs(c.z);
  const auto side = [](double coordinate) { return coordinate < 0.0 ? -1.0 : 1.0; };
  if (depth_x <= depth_y && depth_x <= depth_z) return {-depth_x, {side(c.x), 0.0, 0.0}};
  if (depth_y <= depth_z) return {-depth_y, {0.0, side(c.y), 0.0}};
  return {-depth_z, {0.0, 0.0, side(c.z)}};
}

Separation separate(const BodyVec& c, const Box& box) noexcept {
  const Vec3& h = box.half_extents;
  const BodyVec outwards{c.x - std::clamp(c.x, -h.x(), h.x()),  //
                         c.y - std::clamp(c.y, -h.y(), h.y()),
                         c.z - std::clamp(c.z, -h.z(), h.z())};
  const double square = squaredNorm(outwards);
  if (square < kSmallestSquare) return leaveBox(c, h);
  const double distance = std::sqrt(square);
  return {distance, divide(outwards, distance)};
}

Separation separate(const BodyVec& c, const Plane& plane) noexcept {
  // The normal is unit only within checkShape's tolerance; the half-space is the same at any
  // length.
  const BodyVec n{plane.normal_B.x(), plane.normal_B.y(), plane.normal_B.z()};
  const double length = std::sqrt(squaredNorm(n));
  return {(n.x * c.x + n.y * c.y + n.z * c.z - plane.offset) / length, divide(n, length)};
}

}  // namespace

SphereContact findSphereContact(const Vec3& p_W, double radius, const Shape& shape,
                                const Vec3& p_WB, const Quat& q_WB) noexcept {
  const Rotation rotation(q_WB);
  const BodyVec c = rotation.toBody(p_W.x() - p_WB.x(), p_W.y() - p_WB.y(), p_W.z() - p_WB.z());
  const Separation found =
      std::visit([&c](const auto& s) noexcept { return separate(c, s); }, shape);

  const Vec3 n_W = rotation.toWorld(found.n);
  return {found.distance - radius, n_W, p_W - found.distance * n_W};
}

}  // namespace tandem
