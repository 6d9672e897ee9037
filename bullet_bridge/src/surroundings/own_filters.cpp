#include "surroundings/own_filters.h"

#include <algorithm>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "bodies/haptic_body.h"
#include "surroundings/filtered_queries.h"
#include "surroundings/per_dispatcher.h"
#include "world/world_lookup.h"

namespace tandem {
namespace {

/// More keepers may be away, but only these get rid of our filters: a host that deletes bodies all
/// the time must not fill the memory.
constexpr std::size_t kMostAway = 64;

/// The mark. It is in no world, and lives until the process ends.
const btCollisionObject& mark() {
  static const btCollisionObject object;
  return object;
}

/// Entries of the keeper for the other. Reads nothing of that.
int countEntries(btCollisionObject& keeper, const btCollisionObject* other) {
  int count = 0;
  for (int i = 0; i < keeper.getNumObjectsWithoutCollision(); ++i)
    count += keeper.getObjectWithoutCollision(i) == other ? 1 : 0;
  return count;
}

/// Joints between the two have made these entries, and will take them away.
int countEntriesOfJoints(btCollisionObject& keeper, const btCollisionObject* other) {
  btRigidBody* const body = btRigidBody::upcast(&keeper);
  if (body == nullptr) return 0;
  int count = 0;
  for (int i = 0; i < body->getNumConstraintRefs(); ++i) {
    const btTypedConstraint& joint = *body->getConstraintRef(i);
    count += &joint.getRigidBodyA() == other || &joint.getRigidBodyB() == other ? 1 : 0;
  }
  return count;
}

}  // namespace

OwnFilters::OwnFilters(btDiscreteDynamicsWorld& host) : host_(host) {}

OwnFilters::~OwnFilters() { forgetWorld(); }

void OwnFilters::forgetWorld() noexcept {
  late_.clear();
  pairs_.clear();
  if (queries_) queries_->remove(*this);
  queries_.reset();
}

void OwnFilters::openQueries() {
  auto* dispatcher = dynamic_cast<btCollisionDispatcher*>(host_.getDispatcher());
  if (queries_ || dispatcher == nullptr) return;
  queries_ = guestOf<FilteredQueries>(*dispatcher);
  queries_->add(*this);
}

bool OwnFilters::has(const btCollisionObject& a, const btCollisionObject& b) const noexcept {
  return pairs_.count({&a, &b}) > 0 || pairs_.count({&b, &a}) > 0;
}

void OwnFilters::add(btCollisionObject& keeper, btCollisionObject& other) {
  openQueries();
  pairs_.emplace(&keeper, &other);
  keeper.setIgnoreCollisionCheck(&mark(), true);
  filterNativeContact(host_, keeper, other, true);
}

void OwnFilters::remove(btCollisionObject* keeper, btCollisionObject* other) {
  pairs_.erase({keeper, other});
  if (findInWorld(host_, keeper) < 0) return noteLate(keeper, other);
  if (countIn(*keeper) == 0) return;  // the host made another object at the address
  keeper->setIgnoreCollisionCheck(&mark(), false);
  // A host that let the pair touch, and then joined it, has taken ours away.
  if (countEntries(*keeper, other) <= countEntriesOfJoints(*keeper, other)) return;
  if (findInWorld(host_, other) < 0) {
    keeper->setIgnoreCollisionCheck(other, false);
  } else {
    filterNativeContact(host_, *keeper, *other, false);
  }
}

void OwnFilters::noteLate(btCollisionObject* keeper, btCollisionObject* other) {
  const auto known = std::find_if(late_.begin(), late_.end(),
                                  [&](const Late& late) { return late.keeper == keeper; });
  if (known != late_.end()) return known->others.push_back(other);
  if (late_.size() == kMostAway) removeLate();
  if (late_.size() == kMostAway) late_.erase(late_.begin());
  late_.push_back({keeper, {other}});
}

void OwnFilters::removeLate() {
  std::erase_if(late_, [&](const Late& late) {
    if (findInWorld(host_, late.keeper) < 0) return false;
    for (btCollisionObject* other : late.others) remove(late.keeper, other);
    return true;
  });
}

int OwnFilters::countIn(btCollisionObject& keeper) { return countEntries(keeper, &mark()); }

int OwnFilters::countOfHost(btCollisionObject& keeper) {
  return keeper.getNumObjectsWithoutCollision() - 2 * countIn(keeper);
}

}  // namespace tandem
