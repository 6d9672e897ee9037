#include "surroundings/obstacle_search.h"

#include <algorithm>
#include <optional>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "shapes/only_shape.h"

namespace tandem {
namespace {

bool isObstacle(const btCollisionObject& object) {
  const int type = object.getInternalType();
  return (type == btCollisionObject::CO_COLLISION_OBJECT ||
          type == btCollisionObject::CO_RIGID_BODY) &&
         object.isStaticObject() && !object.isKinematicObject() && object.hasContactResponse();
}

class Collector final : public btBroadphaseAabbCallback {
 public:
  Collector(const Region& region, std::vector<btCollisionObject*>& found)
      : region_(region), found_(found) {}

  bool process(const btBroadphaseProxy* proxy) override {
    auto* object = static_cast<btCollisionObject*>(proxy->m_clientObject);
    if (!isObstacle(*object)) return true;
    const btCollisionShape& shape = onlyShapeOf(*object->getCollisionShape());
    const btTransform& pose = object->getWorldTransform();
    // Broadphase boxes have a margin and may be a step old; ask the shape.
    if (!mayReach(shape, pose, computeRegion(shape, pose), region_)) return true;
    if (std::find(found_.begin(), found_.end(), object) == found_.end()) found_.push_back(object);
    return true;
  }

 private:
  const Region& region_;
  std::vector<btCollisionObject*>& found_;
};

}  // namespace

void findStaticObjects(btCollisionWorld& world, const Region& region,
                       std::vector<btCollisionObject*>& found) {
  Collector collector(region, found);
  world.getBroadphase()->aabbTest(region.low, region.high, collector);
}

void sortAsAdded(std::vector<btCollisionObject*>& objects) {
  std::sort(objects.begin(), objects.end(),
            [](const btCollisionObject* a, const btCollisionObject* b) {
              return a->getWorldArrayIndex() < b->getWorldArrayIndex();
            });
}

void appendObstacles(const btCollisionObject& object, const btCollisionShape& shape,
                     const btTransform& pose, const std::vector<Region>& regions,
                     KnownShapes& known, std::vector<Obstacle>& obstacles) {
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i) {
      appendObstacles(object, *compound.getChildShape(i), pose * compound.getChildTransform(i),
                      regions, known, obstacles);
    }
    return;
  }
  const Region bounds = computeRegion(shape, pose);
  const bool is_near = std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
    return mayReach(shape, pose, bounds, region);
  });
  if (!is_near) return;
  if (const std::optional<Shape> own = known.find(object, shape))
    obstacles.push_back({*own, fromBullet(pose.getOrigin()), fromBullet(pose.getRotation())});
}

}  // namespace tandem
