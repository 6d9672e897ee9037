#include "arms/link_body.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "arms/host_arm.h"

namespace tandem {

double LinkBody::mass() const noexcept { return arm_.model().links()[number_].mass; }
Vec3 LinkBody::inertia() const noexcept { return arm_.model().links()[number_].inertia; }

btCollisionObject* LinkBody::collider() const noexcept {
  btMultiBody& body = arm_.body();
  const int link = static_cast<int>(number_) - 1;
  return link < 0 ? body.getBaseCollider() : body.getLinkCollider(link);
}

bool LinkBody::isInWorld() const noexcept { return arm_.isInWorld(); }

const std::vector<std::string>& LinkBody::warnings() const noexcept {
  static const std::vector<std::string> none;
  return none;
}

RigidState LinkBody::state() const noexcept { return arm_.findState(number_); }
Vec3 LinkBody::gravityForce() const noexcept { return mass() * arm_.worldGravity(); }

void LinkBody::place(const RigidState& state) noexcept {
  end_ = state;
  arm_.has_place_ = true;
}

void LinkBody::setState(const RigidState& state) noexcept {
  put_ = state;
  arm_.has_put_ = true;
}

void LinkBody::addMomentum(const Vec3& linear_W, const Vec3& angular_W) noexcept {
  arm_.addMomentum(number_, {linear_W, angular_W});
}

void LinkBody::remember() noexcept { arm_.remember(); }

void LinkBody::shiftOrigin(const Vec3& offset_W) noexcept {
  end_.p_W += offset_W;
  if (arm_.links_.front().get() == this) arm_.shiftOrigin(offset_W);
}

}  // namespace tandem
