#include "site/neighbour.h"

#include <algorithm>
#include <cmath>

#include "bullet_bridge/src/bodies/filter_of.h"
#include "bullet_bridge/src/shapes/parts_look.h"

namespace tandem {
namespace {

/// Rate of decay of a velocity that Bullet multiplies by (1 - d)^dt [1/s].
double computeDecay(double damping) {
  constexpr double kFastest = 1e3;
  return damping < 1.0 ? std::min(-std::log1p(-damping), kFastest) : kFastest;
}

}  // namespace

void Neighbour::becomeEmpty() {
  rigid = nullptr;
  link = nullptr;
  object = nullptr;
  shape = nullptr;
  settings = {};
  bullet.reset();
  driven.reset();
  linear_damping = angular_damping = 0.0;
  owed = {};
  is_new = false;
  body.becomeEmpty();
}

bool Neighbour::hasChanged() const noexcept {
  if (link) return !link->arm().isAsHeld();
  if (driven)
    return !rigid->isKinematicObject() || rigid->getCollisionShape() != shape ||
           lookAtParts(*shape) != parts || !(filterOf(*rigid) == settings.filter);
  return !bullet->isAsHeld() || !isMovedByForces(*rigid);
}

void Neighbour::lookAtDamping() noexcept {
  if (link) link->arm().readDamping(linear_damping, angular_damping);
  if (!bullet) return;
  linear_damping = bullet->linearDamping();
  angular_damping = bullet->angularDamping();
}

bool Neighbour::followDamping() noexcept {
  // A multi-body's damping is a rate, a rigid body's a share of the velocity that is left.
  const double damping = settings.mass * (link ? linear_damping : computeDecay(linear_damping));
  const double angular = link ? angular_damping : computeDecay(angular_damping);
  if (damping == settings.damping && angular == settings.angular_damping) return false;
  settings.damping = damping;
  settings.angular_damping = angular;
  return true;
}

}  // namespace tandem
