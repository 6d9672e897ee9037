#include "surroundings/standing_watch.h"

#include <algorithm>
#include <cstring>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/collider_look.h"
#include "bodies/haptic_body.h"
#include "surroundings/obstacle_search.h"
#include "surroundings/private_copies.h"

namespace tandem {
namespace {

struct Known {
  const btCollisionObject* object;
  int world_index;
  btTransform pose;
  ColliderLook look;
  Surface surface;

  /// Compares addresses first: the object may have been deleted.
  [[nodiscard]] bool isAsKnown(const btCollisionObjectArray& objects) const noexcept {
    return objects[world_index] == object && isObstacle(*object) &&
           object->getCollisionShape() == look.shape && ColliderLook::at(*object) == look &&
           Surface::of(*object) == surface &&
           std::memcmp(&object->getWorldTransform(), &pose, sizeof pose) == 0;
  }
};

}  // namespace

struct StandingWatch::Impl {
  btDiscreteDynamicsWorld& host;
  std::vector<Known> known;
  std::vector<btCollisionObject*> found;  // work space
  int object_count = 0;
  btVector3 gravity{0, 0, 0};
};

StandingWatch::StandingWatch(btDiscreteDynamicsWorld& host)
    : impl_(std::make_unique<Impl>(Impl{host, {}, {}, 0, {0, 0, 0}})) {}
StandingWatch::~StandingWatch() = default;

void StandingWatch::remember(const std::vector<HapticBody*>& bodies, const Vec3& hand_W,
                             double margin) {
  impl_->found.clear();
  const auto look = [&](const Region& region) {
    findStaticObjects(impl_->host, growRegion(region, static_cast<btScalar>(margin)), impl_->found);
  };
  for (const HapticBody* body : bodies)
    look(computeRegion(*body->body().getCollisionShape(), body->body().getWorldTransform()));
  look({toBullet(hand_W), toBullet(hand_W)});
  sortAsAdded(impl_->found);
  impl_->known.clear();
  for (const btCollisionObject* object : impl_->found)
    impl_->known.push_back({object, object->getWorldArrayIndex(), object->getWorldTransform(),
                            ColliderLook::at(*object), Surface::of(*object)});
  impl_->object_count = impl_->host.getNumCollisionObjects();
  impl_->gravity = impl_->host.getGravity();
}

bool StandingWatch::isUnchanged() const noexcept {
  const btCollisionObjectArray& objects = impl_->host.getCollisionObjectArray();
  if (objects.size() != impl_->object_count) return false;
  return std::all_of(impl_->known.begin(), impl_->known.end(),
                     [&](const Known& known) { return known.isAsKnown(objects); });
}

bool StandingWatch::isGravityUnchanged() const noexcept {
  return impl_->host.getGravity() == impl_->gravity;
}

}  // namespace tandem
