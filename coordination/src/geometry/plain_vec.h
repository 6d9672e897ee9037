#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// Vector of three plain doubles for the inner loops. It stays in registers. Eigen's vectors go
/// through memory and return in pairs, which stalls: GCC's code is twice as fast this way.
struct PlainVec {
  double x = 0.0, y = 0.0, z = 0.0;

  PlainVec() = default;
  PlainVec(double x_, double y_, double z_) noexcept : x(x_), y(y_), z(z_) {}
  explicit PlainVec(const Vec3& v) noexcept : x(v.x()), y(v.y()), z(v.z()) {}
  explicit PlainVec(const double* v) noexcept : x(v[0]), y(v[1]), z(v[2]) {}

  [[nodiscard]] Vec3 toVec3() const noexcept { return {x, y, z}; }
  void store(double* v) const noexcept { v[0] = x, v[1] = y, v[2] = z; }
  bool operator==(const PlainVec&) const noexcept = default;
};

inline PlainVec operator+(const PlainVec& a, const PlainVec& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline PlainVec operator-(const PlainVec& a, const PlainVec& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline PlainVec operator*(double s, const PlainVec& v) noexcept {
  return {s * v.x, s * v.y, s * v.z};
}
inline PlainVec operator/(const PlainVec& v, double d) noexcept {
  const double s = 1.0 / d;
  return {s * v.x, s * v.y, s * v.z};
}
inline double dot(const PlainVec& a, const PlainVec& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline PlainVec cross(const PlainVec& a, const PlainVec& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline PlainVec multiplyEach(const PlainVec& a, const PlainVec& b) noexcept {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Rotation matrix R_WB of a nonzero quaternion. Dividing by the squared norm keeps it orthogonal
/// for single-precision quaternions and for drift inside an integration step.
class PlainRotation {
 public:
  PlainRotation() = default;
  explicit PlainRotation(const Quat& q) noexcept : PlainRotation(q.coeffs().data()) {}

  /// Coefficients in the order x, y, z, w.
  explicit PlainRotation(const double* q) noexcept {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double s = 2.0 / (x * x + y * y + z * z + w * w);
    const double wx = s * w * x, wy = s * w * y, wz = s * w * z;
    const double xx = s * x * x, xy = s * x * y, xz = s * x * z;
    const double yy = s * y * y, yz = s * y * z, zz = s * z * z;
    xx_ = 1.0 - (yy + zz), xy_ = xy - wz, xz_ = xz + wy;
    yx_ = xy + wz, yy_ = 1.0 - (xx + zz), yz_ = yz - wx;
    zx_ = xz - wy, zy_ = yz + wx, zz_ = 1.0 - (xx + yy);
  }

  [[nodiscard]] PlainVec toBody(const PlainVec& v) const noexcept {
    return {xx_ * v.x + yx_ * v.y + zx_ * v.z,  //
            xy_ * v.x + yy_ * v.y + zy_ * v.z,  //
            xz_ * v.x + yz_ * v.y + zz_ * v.z};
  }

  [[nodiscard]] PlainVec toWorld(const PlainVec& v) const noexcept {
    return {xx_ * v.x + xy_ * v.y + xz_ * v.z,  //
            yx_ * v.x + yy_ * v.y + yz_ * v.z,  //
            zx_ * v.x + zy_ * v.y + zz_ * v.z};
  }

  /// The axes of B in W.
  [[nodiscard]] PlainVec axisX() const noexcept { return {xx_, yx_, zx_}; }
  [[nodiscard]] PlainVec axisY() const noexcept { return {xy_, yy_, zy_}; }
  [[nodiscard]] PlainVec axisZ() const noexcept { return {xz_, yz_, zz_}; }

 private:
  double xx_ = 1.0, xy_ = 0.0, xz_ = 0.0;
  double yx_ = 0.0, yy_ = 1.0, yz_ = 0.0;
  double zx_ = 0.0, zy_ = 0.0, zz_ = 1.0;  // row, column
};

}  // namespace tandem
