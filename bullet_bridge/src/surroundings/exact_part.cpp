#include "surroundings/exact_part.h"

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

namespace tandem {
ExactPart ExactPart::of(const PrivateCopy& copy, const Part& part) noexcept {
  ExactPart exact{part.shape.get(), part.half,        static_cast<double>(copy.skin),
                  nullptr,          copy.axes_placed, copy.p_placed};
  if (!copy.is_compound) return exact;
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) axes.row(i) = fromBullet(part.pose.getBasis()[i]).transpose();
  exact.in_object = &part.pose;
  exact.p += exact.axes * fromBullet(part.pose.getOrigin());
  exact.axes *= axes;
  return exact;
}

double ExactPart::rounding() const noexcept {
  if (is(BOX_SHAPE_PROXYTYPE)) return 0.0;
  return static_cast<double>(static_cast<const btConvexShape&>(*shape).getMargin());
}

bool ExactPart::findFace(const Vec3& normal, double tolerance, ExactFace& face) const noexcept {
  if (is(STATIC_PLANE_PROXYTYPE)) {
    const auto& plane = static_cast<const btStaticPlaneShape&>(*shape);
    face = {fromBullet(plane.getPlaneNormal()).normalized(),
            static_cast<double>(plane.getPlaneConstant())};
  } else if (is(BOX_SHAPE_PROXYTYPE)) {
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    face.normal = Vec3::Zero();
    face.normal[axis] = normal[axis] > 0.0 ? 1.0 : -1.0;
    face.offset = half[axis];
  } else {
    return false;
  }
  return (face.normal - normal).norm() < tolerance;
}

}  // namespace tandem
