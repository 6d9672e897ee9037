#include <stdexcept>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "native/native_coupling.h"

namespace tandem {

struct NativeGuide::Original {
  btRigidBody& body;
  btVector3 linear_factor, angular_factor;
};

bool NativeGuide::canFollow(const Vec3& axis) noexcept {
  return axis.cwiseAbs().maxCoeff() == axis.cwiseAbs().sum();
}

NativeGuide::NativeGuide(btRigidBody& body, const Vec3& axis)
    : original_(new Original{body, body.getLinearFactor(), body.getAngularFactor()}) {
  if (!canFollow(axis))
    throw std::invalid_argument(
        "a guide by Bullet's linear factors must lie along x, y or z of the world");
  body.setLinearFactor(toBullet(Vec3(axis.cwiseAbs())));
  body.setAngularFactor(btVector3(0, 0, 0));
}

NativeGuide::~NativeGuide() {
  original_->body.setLinearFactor(original_->linear_factor);
  original_->body.setAngularFactor(original_->angular_factor);
}

}  // namespace tandem
