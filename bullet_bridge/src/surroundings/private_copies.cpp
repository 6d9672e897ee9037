#include "surroundings/private_copies.h"

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/filter_of.h"
#include "shapes/only_shape.h"
#include "surroundings/private_shapes.h"

namespace tandem {
namespace {

/// True if the shape tells its triangles. A signed distance field has none, and a GImpact compound
/// shows none.
bool hasTriangles(const btCollisionShape& shape) {
  if (!shape.isConcave() || shape.getShapeType() == SDF_SHAPE_PROXYTYPE) return false;
  return shape.getShapeType() != GIMPACT_SHAPE_PROXYTYPE ||
         static_cast<const btGImpactShapeInterface&>(shape).getGImpactShapeType() !=
             CONST_GIMPACT_COMPOUND_SHAPE;
}

Vec3 halfOf(const btCollisionShape& shape) {
  if (shape.getShapeType() != BOX_SHAPE_PROXYTYPE) return Vec3::Zero();
  return fromBullet(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
}

/// Adds the parts of a shape, also of compounds in compounds. False if one cannot be copied.
bool appendParts(const btCollisionShape& shape, const btTransform& pose, std::vector<Part>& parts) {
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
      if (!appendParts(*compound.getChildShape(i), pose * compound.getChildTransform(i), parts))
        return false;
    return true;
  }
  Part part;
  part.pose = pose;
  part.shape = copyShape(shape);
  part.half = halfOf(shape);
  if (!part.shape) {
    if (!hasTriangles(shape)) return false;
    part.host_mesh = static_cast<const btConcaveShape*>(&shape);
    part.mesh_margin = shape.getMargin();
    part.bounds = computeRegion(shape, btTransform::getIdentity());
  }
  parts.push_back(std::move(part));
  return true;
}

}  // namespace

PrivateCopy::PrivateCopy(btCollisionObject& host_object, BodyIndex body)
    : original(&host_object),
      may_keep_filters(host_object.getInternalType() != btCollisionObject::CO_FEATHERSTONE_LINK),
      look(ShapeLook::of(*host_object.getCollisionShape())),
      surface(Surface::of(host_object)),
      index(body),
      asks_host(asksContactCallback(host_object)) {
  const btCollisionShape& only = onlyShapeOf(*host_object.getCollisionShape());
  is_compound = only.isCompound();
  if (only.getShapeType() == BOX_SHAPE_PROXYTYPE) skin = kBoxSkin;
  if (only.getShapeType() == STATIC_PLANE_PROXYTYPE) {
    auto own = std::make_unique<btStaticPlaneShape>(
        static_cast<const btStaticPlaneShape&>(only).getPlaneNormal(), btScalar(0));
    plane = own.get();
    parts.push_back({std::move(own), nullptr, 0, {}, btTransform::getIdentity()});
  } else if (skin > 0) {
    parts.push_back(
        {copyShape(only, skin), nullptr, 0, {}, btTransform::getIdentity(), halfOf(only)});
  } else if (!appendParts(only, btTransform::getIdentity(), parts)) {
    parts.clear();
  }
  for (Part& part : parts)
    if (part.shape) part.large = enlarge(*part.shape);
  const bool is_single = !is_compound && isWhole() && parts.front().shape;
  const btCollisionShape& measured =
      is_single ? *parts.front().shape : *host_object.getCollisionShape();
  breaking_threshold = measured.getContactBreakingThreshold(gContactBreakingThreshold);
  place(Vec3::Zero(), Quat::Identity());
  filter = filterOf(host_object);
  own_filters = OwnFilters::countIn(host_object);
  host_filters = OwnFilters::countOfHost(host_object);
}

bool PrivateCopy::isAsCopied() const {
  const btCollisionShape* shape = original->getCollisionShape();
  return shape == look.shape && ShapeLook::of(*shape) == look && holdsOwnFilters();
}

Surface Surface::of(const btCollisionObject& object) noexcept {
  Surface surface;
  surface.friction = object.getFriction();
  surface.rolling_friction = object.getRollingFriction();
  surface.spinning_friction = object.getSpinningFriction();
  surface.restitution = object.getRestitution();
  surface.user_pointer = object.getUserPointer();
  surface.user_index = object.getUserIndex();
  surface.user_index2 = object.getUserIndex2();
  surface.user_index3 = object.getUserIndex3();
  return surface;
}

ShapeLook ShapeLook::of(const btCollisionShape& shape) {
  const bool is_compound = shape.isCompound();
  return {&shape, shape.getLocalScaling(), shape.getMargin(),
          computeRegion(shape, btTransform::getIdentity()),
          is_compound ? static_cast<const btCompoundShape&>(shape).getUpdateRevision() : 0};
}

bool ShapeLook::operator==(const ShapeLook& other) const noexcept {
  return shape == other.shape && equalBits(scaling, other.scaling) && margin == other.margin &&
         bounds == other.bounds && revision == other.revision;
}

PrivatePose PrivateCopy::findOriginal(const Vec3& origin_W) const {
  const btTransform& host_pose = original->getWorldTransform();
  Vec3 p = fromBullet(host_pose.getOrigin()) - origin_W;
  if (plane) {
    // A plane's origin moves to its point nearest to the private origin, which keeps numbers small.
    const auto& host_plane =
        static_cast<const btStaticPlaneShape&>(onlyShapeOf(*original->getCollisionShape()));
    const Vec3 normal = fromBullet(host_pose.getBasis() * host_plane.getPlaneNormal());
    p = (normal.dot(p) + static_cast<double>(host_plane.getPlaneConstant())) * normal;
  }
  return {btTransform(host_pose.getBasis(), toBullet(p)), p};
}

Region PrivateCopy::computeBounds(const Part& part, const btTransform& pose) {
  if (part.shape) return computeRegion(*part.shape, pose * part.pose);
  return moveRegion(part.bounds, pose * part.pose);
}

void PrivateCopy::place(const PrivatePose& pose) {
  const btMatrix3x3& basis = pose.rounded.getBasis();
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) axes.row(i) = fromBullet(basis[i]).transpose();
  p_placed = pose.p;
  // Axes of a float are off by its rounding, and are not quite at right angles.
  q_placed = Quat(axes).normalized();
  axes_placed = q_placed.toRotationMatrix();
  moveTo(pose.rounded);
}

void PrivateCopy::place(const Vec3& p, const Quat& q) {
  p_placed = p;
  q_placed = q;
  axes_placed = q.toRotationMatrix();
  moveTo(toBullet(p, q));
}

void PrivateCopy::moveTo(const btTransform& pose) {
  object.setWorldTransform(pose);
  if (!is_compound && isWhole() && parts.front().shape) {
    bounds = computeRegion(*parts.front().shape, pose);
  } else {
    bounds = moveRegion(look.bounds, pose);
  }
}

bool asksContactCallback(const btCollisionObject& object) noexcept {
  return gContactAddedCallback != nullptr &&
         (object.getCollisionFlags() & btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK) != 0;
}

bool PrivateCopy::hasNewFilters() noexcept {
  const bool has_new = hasOtherFilters();
  filter = filterOf(*original);
  host_filters = OwnFilters::countOfHost(*original);
  return has_new;
}

bool PrivateCopy::hasOtherFilters() const noexcept {
  return !(filterOf(*original) == filter) || OwnFilters::countOfHost(*original) != host_filters;
}

}  // namespace tandem
