#include "gyroscope.h"

#include <limits>

#include <Eigen/LU>

namespace tandem::pybullet {
namespace {

Eigen::Matrix3d makeCross(const Vec3& v) {
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

}  // namespace

Vec3 applyGyroLaw(GyroLaw law, const Vec3& inertia, const Quat& R_WB, const Vec3& w_W, double dt) {
  const Vec3 w = R_WB.conjugate() * w_W;
  const Vec3 Iw = inertia.cwiseProduct(w);
  const Vec3 torque = w.cross(Iw);
  if (law == GyroLaw::kExplicit) {
    const Vec3 after = w - dt * torque.cwiseQuotient(inertia);
    return R_WB * after;
  }
  // One Newton step for I (w' - w) + dt w' x I w' = 0 from w' = w.
  const Eigen::Matrix3d I = inertia.asDiagonal();
  const Eigen::Matrix3d slope = I + dt * (makeCross(w) * I - makeCross(Iw));
  const Vec3 after = w - slope.inverse() * (dt * torque);
  return R_WB * after;
}

Vec3 computeVelocityBefore(GyroLaw law, const Vec3& inertia, const Quat& R_WB, const Vec3& target_W,
                           double dt) {
  if (inertia.x() == inertia.y() && inertia.y() == inertia.z()) return target_W;
  // The error shrinks by about |w| dt per round, and grows where a step turns the body far.
  constexpr int kRounds = 30;
  Vec3 before = target_W, best = target_W;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const Vec3 missing = target_W - applyGyroLaw(law, inertia, R_WB, before, dt);
    if (!(missing.squaredNorm() < least)) break;
    least = missing.squaredNorm();
    best = before;
    if (least <= 1e-28 * target_W.squaredNorm()) break;
    before += missing;
  }
  return best;
}

}  // namespace tandem::pybullet
