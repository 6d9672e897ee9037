#include "surroundings/obstacle_search.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "tandem/bullet_bridge/convert.h"

#include "arms/arm_watch.h"
#include "bodies/filter_of.h"
#include "shapes/compound_children.h"
#include "shapes/only_shape.h"

namespace tandem {
namespace {

/// Number of one shape of an object. The address only tells objects apart.
std::uint64_t makeId(const btCollisionObject& object, int part) {
  return (std::uint64_t{reinterpret_cast<std::uintptr_t>(&object)} << 16) +
         static_cast<std::uint64_t>(part);
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

bool isObstacle(const btCollisionObject& object) noexcept {
  if (!object.hasContactResponse()) return false;
  if (isGround(object)) return true;
  const int type = object.getInternalType();
  const bool is_plain =
      type == btCollisionObject::CO_COLLISION_OBJECT || type == btCollisionObject::CO_RIGID_BODY;
  const bool stands = object.isStaticObject() || object.getActivationState() == DISABLE_SIMULATION;
  return is_plain && stands && !object.isKinematicObject();
}

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
                     KnownShapes& known, int& part, std::vector<Obstacle>& obstacles) {
  forEachLeaf(shape, pose, [&](const btCollisionShape& leaf, const btTransform& leaf_pose) {
    ++part;
    const Region bounds = computeRegion(leaf, leaf_pose);
    const bool is_near = std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
      return mayReach(leaf, leaf_pose, bounds, region);
    });
    if (!is_near) return;
    const std::optional<Shape> own = known.find(object, leaf);
    if (!own) return;
    Obstacle obstacle{*own, fromBullet(leaf_pose.getOrigin()), fromBullet(leaf_pose.getRotation())};
    obstacle.id = makeId(object, part);
    obstacle.filter = filterOf(object);
    obstacles.push_back(std::move(obstacle));
  });
}

void noteChanges(const std::vector<Obstacle>& before, std::vector<Obstacle>& now) {
  // Most often both lists have the same order.
  auto next = before.begin();
  for (Obstacle& obstacle : now) {
    const auto is_it = [&](const Obstacle& other) { return other.id == obstacle.id; };
    auto known = std::find_if(next, before.end(), is_it);
    if (known == before.end()) known = std::find_if(before.begin(), before.end(), is_it);
    const bool has_other_shape =
        known != before.end() &&
        (known->shape.index() != obstacle.shape.index() ||
         computeBoundingRadius(known->shape) != computeBoundingRadius(obstacle.shape));
    if (known == before.end() || has_other_shape || !(known->filter == obstacle.filter)) {
      obstacle.change = ObstacleChange::kNew;
      continue;
    }
    next = std::next(known);
    if (known->p_WB == obstacle.p_WB && known->q_WB.coeffs() == obstacle.q_WB.coeffs()) continue;
    obstacle.change = ObstacleChange::kMoved;
    obstacle.p_before_WB = known->p_WB;
    obstacle.q_before_WB = known->q_WB;
  }
}

}  // namespace tandem
