#include "surroundings/contact_pair.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <LinearMath/btAabbUtil2.h>

#include "tandem/bullet_bridge/convert.h"

#include "surroundings/private_shapes.h"

namespace tandem {
namespace {

/// Points farther apart than this do not matter to an inner step [m].
constexpr double kFarthest = 1e-3;

/// Smaller distances are rounding of a float Bullet some decimetres from the private origin [m]. If
/// they counted, bodies at rest would tremble.
constexpr double kRounding = sizeof(btScalar) == sizeof(double) ? 0.0 : 6e-8;

/// Bullet may not know its points again that slid farther without it [m]. Old ones would take the
/// places of new ones, and then be dropped.
constexpr double kKnownAgain = 1e-5;

bool isPlane(const Part& part) {
  return part.shape && part.shape->getShapeType() == STATIC_PLANE_PROXYTYPE;
}

/// The nearest point of the host's box, for a copy with a skin: corners of the copy are farther
/// out.
btVector3 takeSkinOff(const PrivateCopy& copy, const btVector3& point) {
  if (copy.skin == 0) return point;
  const auto& box = static_cast<const btBoxShape&>(*copy.parts.front().shape);
  const btVector3 half =
      box.getHalfExtentsWithMargin() - btVector3(copy.skin, copy.skin, copy.skin);
  const btTransform& pose = copy.object.getWorldTransform();
  btVector3 inside = pose.invXform(point);
  inside.setMax(-half);
  inside.setMin(half);
  return pose * inside;
}

}  // namespace

Material Material::of(const btCollisionObject& a, const btCollisionObject& b) {
  Material material;
  material.friction = static_cast<double>(gCalculateCombinedFrictionCallback(&a, &b));
  material.restitution = static_cast<double>(gCalculateCombinedRestitutionCallback(&a, &b));
  const btScalar rolling = gCalculateCombinedRollingFrictionCallback(&a, &b);
  // Bullet's solver uses spinning friction only together with rolling friction.
  if (rolling > 0) {
    material.rolling = static_cast<double>(rolling);
    material.spinning = static_cast<double>(gCalculateCombinedSpinningFrictionCallback(&a, &b));
  }
  return material;
}

Region findRegionInMesh(const Part& mesh, const btTransform& pose, const Region& box,
                        btScalar margin) noexcept {
  return growRegion(moveRegion(box, (pose * mesh.pose).inverse()), margin + mesh.mesh_margin);
}

void ContactPair::fill() {
  for (const PrivateCopy* copy : {a, b})
    for (const Part& part : copy->parts)
      if (part.host_mesh) meshes.push_back({&part, copy == a, {}});
  for (const Part& of_a : a->parts)
    for (const Part& of_b : b->parts) addPartPair(of_a, of_b);
}

void ContactPair::goOnWith(ContactPair& other) noexcept {
  parts_.swap(other.parts_);
  meshes.swap(other.meshes);
  near = other.near;
}

void ContactPair::addPartPair(const Part& of_a, const Part& of_b) {
  const bool a_is_last = of_a.host_mesh || isPlane(of_a);
  const bool b_is_last = of_b.host_mesh || isPlane(of_b);
  if (a_is_last && b_is_last) return;
  PartPair pair;
  pair.is_swapped = a_is_last || (!b_is_last && b->is_compound && !a->is_compound);
  pair.first = pair.is_swapped ? &of_b : &of_a;
  pair.second = pair.is_swapped ? &of_a : &of_b;
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (meshes[i].mesh == pair.second) pair.mesh = static_cast<int>(i);
  parts_.push_back(pair);
}

bool ContactPair::overlaps(const Region& of_a, const Region& of_b) const noexcept {
  if (b->plane) return reaches(*b->plane, b->object.getWorldTransform(), of_a);
  return overlap(of_a, of_b);
}

void ContactPair::lookCloser(WorkSpace& work, btScalar reach) noexcept {
  for (NearTriangles& mesh : meshes) {
    const PrivateCopy& its = mesh.is_of_a ? *a : *b;
    const PrivateCopy& other = mesh.is_of_a ? *b : *a;
    mesh.run.look(
        findRegionInMesh(*mesh.mesh, its.object.getWorldTransform(), other.bounds, reach));
  }
  if (isSingle()) return;
  const btTransform& pose_a = a->object.getWorldTransform();
  const btTransform& pose_b = b->object.getWorldTransform();
  for (PartPair& pair : parts_) {
    const btTransform& pose = pair.is_swapped ? pose_b : pose_a;
    const btTransform& other_pose = pair.is_swapped ? pose_a : pose_b;
    const Region box = growRegion(PrivateCopy::computeBounds(*pair.first, pose), reach);
    pair.close = overlap(box, (pair.is_swapped ? a : b)->bounds) &&
                 overlap(box, PrivateCopy::computeBounds(*pair.second, other_pose));
    if (!pair.close) release(pair, work.dispatcher);
  }
}

btScalar ContactPair::breakingThreshold() const noexcept {
  return std::min(a->breaking_threshold, b->breaking_threshold);
}

bool ContactPair::search(WorkSpace& work) noexcept {
  bool has_asked = false;
  for (PartPair& pair : parts_)
    if (pair.close || isSingle()) has_asked |= searchPart(pair, work);
  return has_asked;
}

/// The steps of Bullet's algorithms for single shapes and compounds, in their order. False if
/// frozen contact answered.
bool ContactPair::searchPart(PartPair& pair, WorkSpace& work) noexcept {
  const PrivateCopy& first = pair.is_swapped ? *b : *a;
  const PrivateCopy& second = pair.is_swapped ? *a : *b;
  if (pair.mesh < 0 &&
      pair.frozen.follow(ExactPart::of(first, *pair.first), ExactPart::of(second, *pair.second))) {
    reportFrozen(pair, work);
    return false;
  }
  const btTransform first_pose = first.is_compound
                                     ? first.object.getWorldTransform() * pair.first->pose
                                     : first.object.getWorldTransform();
  const btTransform second_pose = second.is_compound
                                      ? second.object.getWorldTransform() * pair.second->pose
                                      : second.object.getWorldTransform();
  if (pair.kept && b->plane) {
    slideAlong(*pair.kept, pair.is_swapped);
  } else if (pair.kept && pair.frozen.slide() > kKnownAgain) {
    pair.kept->setNumContacts(0);
  }
  if (!isSingle()) {
    if (pair.kept) refreshQuietly(*pair.kept);
    const Region box = PrivateCopy::computeBounds(*pair.first, first.object.getWorldTransform());
    const Region other =
        PrivateCopy::computeBounds(*pair.second, second.object.getWorldTransform());
    if (!overlap(box, other)) {
      release(pair, work.dispatcher);
      return true;
    }
  }
  work.dispatcher.setBreakingThreshold(breakingThreshold());
  work.decoy.setContactBreakingThreshold(breakingThreshold());
  if (pair.kept == nullptr)
    pair.kept = work.dispatcher.getNewManifold(&first.object, &second.object);
  if (pair.mesh >= 0) {
    searchTriangles(pair, first_pose, second_pose, work);
  } else {
    const bool is_large = pair.first->large && pair.second->large &&
                          needsNearestPoints(*pair.first->shape, *pair.second->shape);
    const btScalar scale = is_large ? kEnlarged : btScalar(1);
    const auto shapeOf = [&](const Part& part) {
      return is_large ? part.large.get() : part.shape.get();
    };
    const btTransform first_large(first_pose.getBasis(), scale * first_pose.getOrigin());
    const btTransform second_large(second_pose.getBasis(), scale * second_pose.getOrigin());
    work.decoy.setContactBreakingThreshold(scale * breakingThreshold());
    const btCollisionObjectWrapper x(nullptr, shapeOf(*pair.first), &first.object, first_large, -1,
                                     -1);
    const btCollisionObjectWrapper y(nullptr, shapeOf(*pair.second), &second.object, second_large,
                                     -1, -1);
    if (pair.algorithm == nullptr)
      pair.algorithm =
          work.dispatcher.findAlgorithm(&x, &y, &work.decoy, BT_CONTACT_POINT_ALGORITHMS);
    if (pair.algorithm == nullptr) return true;
    QuietResult result(&x, &y, *pair.kept, isPlane(*pair.second), scale);
    pair.algorithm->processCollision(&x, &y, work.dispatch, &result);
  }
  refreshQuietly(*pair.kept);
  if (pair.mesh < 0 && pair.frozen.freeze(ExactPart::of(first, *pair.first),
                                          ExactPart::of(second, *pair.second), *pair.kept)) {
    reportFrozen(pair, work);
  } else {
    report(pair, work);
  }
  return true;
}

/// Each triangle is a convex shape for a moment, as in Bullet.
void ContactPair::searchTriangles(PartPair& pair, const btTransform& first_pose,
                                  const btTransform& second_pose, WorkSpace& work) noexcept {
  const PrivateCopy& first = pair.is_swapped ? *b : *a;
  const PrivateCopy& second = pair.is_swapped ? *a : *b;
  const btCollisionObjectWrapper convex(nullptr, pair.first->shape.get(), &first.object, first_pose,
                                        -1, -1);
  const Region box =
      growRegion(computeRegion(*pair.first->shape, second_pose.inverse() * first_pose),
                 pair.second->mesh_margin);
  meshes[static_cast<std::size_t>(pair.mesh)].run.visitClose(
      [&](const TriangleRun::Triangle& close) {
        if (!TestTriangleAgainstAabb2(close.corners, box.low, box.high)) return;
        btTriangleShape triangle(close.corners[0], close.corners[1], close.corners[2]);
        triangle.setMargin(pair.second->mesh_margin);
        const btCollisionObjectWrapper other(nullptr, &triangle, &second.object, second_pose, -1,
                                             -1);
        btCollisionAlgorithm* algorithm = work.dispatcher.findAlgorithm(
            &convex, &other, &work.decoy, BT_CONTACT_POINT_ALGORITHMS);
        QuietResult result(&convex, &other, *pair.kept, false, 1);
        algorithm->processCollision(&convex, &other, work.dispatch, &result);
        algorithm->~btCollisionAlgorithm();
        work.dispatcher.freeCollisionAlgorithm(algorithm);
      });
}

/// Reports points as Bullet has them.
void ContactPair::report(const PartPair& pair, WorkSpace& work) const noexcept {
  // The normal points from the second object to the first.
  const double side = pair.is_swapped ? -1.0 : 1.0;
  for (int i = 0; i < pair.kept->getNumContacts(); ++i) {
    const btManifoldPoint& point = pair.kept->getContactPoint(i);
    double distance = static_cast<double>(point.getDistance() + a->skin + b->skin);
    if (std::abs(distance) < kRounding) distance = 0.0;
    const btVector3 middle =
        (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * btScalar(0.5);
    report(work.origin_W + fromBullet(takeSkinOff(*a, takeSkinOff(*b, middle))),
           side * fromBullet(point.m_normalWorldOnB).normalized(), distance, work);
  }
}

/// Reports points in double.
void ContactPair::reportFrozen(const PartPair& pair, WorkSpace& work) const noexcept {
  const double side = pair.is_swapped ? -1.0 : 1.0;
  for (const FrozenContact::Point& point : pair.frozen)
    report(work.origin_W + point.p, side * pair.frozen.normal(), point.distance, work);
}

void ContactPair::report(const Vec3& p_W, const Vec3& n_W, double distance,
                         WorkSpace& work) const noexcept {
  std::vector<RigidContact>& contacts = *work.contacts;
  if (distance > kFarthest || contacts.size() == contacts.capacity()) return;
  RigidContact contact;
  contact.a = a->index;
  contact.b = b->index;
  contact.surface = b->index == kStanding ? b->original : nullptr;
  contact.p_W = p_W;
  contact.n_W = n_W;
  contact.distance = distance;
  contact.friction = material.friction;
  contact.restitution = material.restitution;
  contact.rolling = material.rolling;
  contact.spinning = material.spinning;
  contact.min_bounce_speed = work.min_bounce_speed;
  contacts.push_back(contact);
}

/// Bullet drops a contact whose two points have drifted apart along the surface. The body would
/// then stand on fewer corners for a step. A plane is uniform, so its point follows the body's.
void ContactPair::slideAlong(btPersistentManifold& manifold, bool is_swapped) noexcept {
  const btTransform& pose = b->object.getWorldTransform();
  const btVector3 normal = pose.getBasis() * b->plane->getPlaneNormal();
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    btVector3& on_plane = is_swapped ? point.m_localPointA : point.m_localPointB;
    const btVector3 on_body =
        a->object.getWorldTransform() * (is_swapped ? point.m_localPointB : point.m_localPointA);
    on_plane = pose.invXform(on_body - normal * normal.dot(on_body - pose.getOrigin()));
  }
}

void ContactPair::release(PartPair& pair, QuietDispatcher& dispatcher) noexcept {
  if (pair.algorithm) {
    pair.algorithm->~btCollisionAlgorithm();
    dispatcher.freeCollisionAlgorithm(pair.algorithm);
    pair.algorithm = nullptr;
  }
  if (pair.kept) dispatcher.releaseManifold(pair.kept);
  pair.kept = nullptr;
  pair.frozen.drop();
}

void ContactPair::release(QuietDispatcher& dispatcher) noexcept {
  for (PartPair& pair : parts_) release(pair, dispatcher);
}

}  // namespace tandem
