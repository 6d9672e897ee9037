#include "bodies/attach_warnings.h"

#include <algorithm>
#include <sstream>

#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>

#include "shapes/compound_children.h"

namespace tandem {
namespace {

/// A margin above this share of the smallest half extent is visible: the body rests that much too
/// high.
constexpr btScalar kLargeMargin = btScalar(0.1);

/// True for shapes that Bullet surrounds with the margin; others include it in their size.
bool hasMarginOutside(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case CONVEX_HULL_SHAPE_PROXYTYPE:
    case CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE:
    case CONVEX_POINT_CLOUD_SHAPE_PROXYTYPE:
    case TETRAHEDRAL_SHAPE_PROXYTYPE:
    case TRIANGLE_SHAPE_PROXYTYPE:
    case GIMPACT_SHAPE_PROXYTYPE:
      return true;
    default:
      return false;
  }
}

btScalar computeSmallestHalfExtent(const btCollisionShape& shape) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const btVector3 half = (high - low) * btScalar(0.5);
  return half[half.minAxis()];
}

/// Bullet takes the margin off each sphere and adds it again, which no smaller sphere can bear.
void warnOfSpheres(const btMultiSphereShape& shape, std::vector<std::string>& warnings) {
  btScalar least = shape.getSphereCount() > 0 ? shape.getSphereRadius(0) : btScalar(0);
  for (int i = 1; i < shape.getSphereCount(); ++i)
    least = std::min(least, shape.getSphereRadius(i));
  if (shape.getMargin() <= least) return;
  std::ostringstream line;
  line << "collision margin " << shape.getMargin() << " m is larger than the smallest sphere, "
       << least << " m, of a " << shape.getName()
       << ": Bullet collides it up to as much wrong; set a margin of that radius or less";
  warnings.push_back(line.str());
}

void warnOfMargin(const btCollisionShape& shape, std::vector<std::string>& warnings) {
  if (shape.getShapeType() == MULTI_SPHERE_SHAPE_PROXYTYPE)
    return warnOfSpheres(static_cast<const btMultiSphereShape&>(shape), warnings);
  if (!hasMarginOutside(shape)) return;
  const btScalar margin = shape.getMargin();
  const btScalar bare = computeSmallestHalfExtent(shape) - margin;
  if (margin <= kLargeMargin * bare) return;
  std::ostringstream line;
  line << "collision margin " << margin << " m is large for a " << shape.getName()
       << " whose smallest half extent is " << bare
       << " m: it rests that far above what it stands on; set a margin of "
       << kLargeMargin * btScalar(0.5) * bare << " m or less";
  warnings.push_back(line.str());
}

}  // namespace

bool hasAdditionalDamping(btRigidBody& body) {
  const btVector3 linear = body.getLinearVelocity();
  const btVector3 angular = body.getAngularVelocity();
  const btVector3 slow(btScalar(1e-3), 0, 0);
  body.setLinearVelocity(slow);
  body.setAngularVelocity(slow);
  body.applyDamping(btScalar(1));
  const bool damped = body.getLinearVelocity().x() != slow.x();
  body.setLinearVelocity(linear);
  body.setAngularVelocity(angular);
  return damped;
}

std::vector<std::string> describeSurprises(const btRigidBody& body, btScalar linear_damping,
                                           btScalar angular_damping, bool has_additional_damping) {
  std::vector<std::string> warnings;
  if (linear_damping != btScalar(0) || angular_damping != btScalar(0)) {
    std::ostringstream line;
    line << "built-in damping (linear " << linear_damping << ", angular " << angular_damping
         << ") is off while attached; give the island's body a damping in N s/m instead";
    warnings.push_back(line.str());
  }
  if (has_additional_damping) {
    warnings.emplace_back(
        "additional damping cannot be switched off: native contacts see the body slower than it is "
        "below "
        "0.1 m/s; build the body without m_additionalDamping");
  }
  forEachLeaf(
      *body.getCollisionShape(), btTransform::getIdentity(),
      [&](const btCollisionShape& shape, const btTransform&) { warnOfMargin(shape, warnings); });
  if ((body.getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) != 0) {
    std::ostringstream line;
    line << "native contact stiffness " << body.getContactStiffness()
         << " N/m per contact point and damping " << body.getContactDamping()
         << " N s/m are not used by the island, whose contacts have their own gains";
    warnings.push_back(line.str());
  }
  if (body.hasAnisotropicFriction(btCollisionObject::CF_ANISOTROPIC_FRICTION |
                                  btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION))
    warnings.emplace_back(
        "anisotropic friction is not used by the island: friction is the same in all directions");
  return warnings;
}

}  // namespace tandem
