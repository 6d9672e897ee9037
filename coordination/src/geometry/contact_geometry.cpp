#include "geometry/contact_geometry.h"

#include "geometry/held_face.h"

namespace tandem {

SphereContact findSphereContact(const Vec3& p_W, double radius, const Shape& shape,
                                const Vec3& p_WB, const Quat& q_WB, int touched) noexcept {
  const PlainRotation rotation(q_WB);
  const Separation found =
      separate(rotation.toBody(PlainVec(p_W) - PlainVec(p_WB)), shape, touched);
  const Vec3 n_W = rotation.toWorld(found.n).toVec3();
  return {found.distance - radius, n_W, p_W - found.distance * n_W, found.under};
}

}  // namespace tandem
