#include "surroundings/shown_contacts.h"

#include <algorithm>
#include <new>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Dynamics/btActionInterface.h>

#include "tandem/bullet_bridge/convert.h"

#include "surroundings/per_dispatcher.h"

namespace tandem {
namespace {

constexpr int kNowhere = -1;

using Manifolds = btAlignedObjectArray<btPersistentManifold*>;

/// The dispatcher's list. Naming a protected member through a derived class is legal C++.
Manifolds& listOf(btCollisionDispatcher& dispatcher) {
  struct Access : btCollisionDispatcher {
    static Manifolds btCollisionDispatcher::*list() { return &Access::m_manifoldsPtr; }
  };
  return dispatcher.*Access::list();
}

using Actions = btAlignedObjectArray<btActionInterface*>;

/// The world's actions, in the same way.
Actions& actionsOf(btDiscreteDynamicsWorld& world) {
  struct Access : btDiscreteDynamicsWorld {
    static Actions btDiscreteDynamicsWorld::*list() { return &Access::m_actions; }
  };
  return world.*Access::list();
}

}  // namespace

/// Stands in the broadphase's pair for the one that Bullet would put there. It finds nothing.
class ShownContacts::Algorithm final : public btCollisionAlgorithm {
 public:
  Algorithm(const btCollisionAlgorithmConstructionInfo& info, ShownContacts& owner, Pair& pair)
      : btCollisionAlgorithm(info), owner_(owner), pair_(pair) {}
  ~Algorithm() override { owner_.forget(pair_); }
  Algorithm(const Algorithm&) = delete;
  Algorithm& operator=(const Algorithm&) = delete;

  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                        const btDispatcherInfo&, btManifoldResult*) override {}
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    for (btPersistentManifold* manifold : pair_.manifolds) manifolds.push_back(manifold);
  }

 private:
  ShownContacts& owner_;
  Pair& pair_;
};

/// Stands before the actions of the host, which may look at contacts.
class ShownContacts::Action final : public btActionInterface {
 public:
  explicit Action(ShownContacts& owner) : owner_(owner) {
    Actions& actions = actionsOf(owner.world_);
    actions.push_back(this);
    std::rotate(&actions[0], &actions[0] + actions.size() - 1, &actions[0] + actions.size());
  }
  /// The host's actions keep their order, unlike in removeAction().
  ~Action() override {
    Actions& actions = actionsOf(owner_.world_);
    int kept = 0;
    for (int i = 0; i < actions.size(); ++i)
      if (actions[i] != this) actions[kept++] = actions[i];
    actions.resizeNoInitialize(kept);
  }
  Action(const Action&) = delete;
  Action& operator=(const Action&) = delete;

  void updateAction(btCollisionWorld*, btScalar) override { owner_.unhide(); }
  void debugDraw(btIDebugDraw*) override {}

 private:
  ShownContacts& owner_;
};

ShownContacts::ShownContacts(btDiscreteDynamicsWorld& world)
    : world_(world), dispatcher_(dynamic_cast<btCollisionDispatcher*>(world.getDispatcher())) {
  if (dispatcher_ == nullptr) return;
  group_ = guestOf<Group>(*dispatcher_);
  group_->members.push_back(this);
}

ShownContacts::~ShownContacts() { clear(); }

void ShownContacts::hide() noexcept {
  is_stepping_ = true;
  if (!group_) return;
  for (ShownContacts* member : group_->members) member->takeOut();
}

void ShownContacts::unhide() {
  is_stepping_ = false;
  if (!group_) return;
  const auto steps = [](const ShownContacts* member) { return member->is_stepping_; };
  if (std::any_of(group_->members.begin(), group_->members.end(), steps)) return;
  for (ShownContacts* member : group_->members) member->putBack();
}

void ShownContacts::takeOut() noexcept {
  if (is_hidden_) return;
  is_hidden_ = true;
  if (listed_.empty()) return;
  Manifolds& list = listOf(*dispatcher_);
  const auto count = static_cast<int>(listed_.size());
  const bool is_tail = list.size() == first_ + count &&
                       std::equal(listed_.begin(), listed_.end(), &list[0] + first_);
  if (is_tail) return list.resizeNoInitialize(first_);
  // Bullet has released others: its list is filled up from the end.
  for (const btPersistentManifold* manifold : listed_) list[manifold->m_index1a] = nullptr;
  int kept = 0;
  for (int i = 0; i < list.size(); ++i) {
    if (list[i] == nullptr) continue;
    list[i]->m_index1a = kept;
    list[kept++] = list[i];
  }
  list.resizeNoInitialize(kept);
  // Ours have wrong places now, even if as many of others come back.
  first_ = kNowhere;
}

void ShownContacts::putBack() {
  if (!is_hidden_) return;
  is_hidden_ = false;
  if (is_changed_) {
    listed_.clear();
    for (const auto& pair : pairs_)
      listed_.insert(listed_.end(), pair->manifolds.begin(), pair->manifolds.end());
  }
  if (listed_.empty()) return;
  Manifolds& list = listOf(*dispatcher_);
  const bool is_place_new = is_changed_ || list.size() != first_;
  is_changed_ = false;
  first_ = list.size();
  list.resizeNoInitialize(first_ + static_cast<int>(listed_.size()));
  std::copy(listed_.begin(), listed_.end(), &list[0] + first_);
  if (!is_place_new) return;
  for (std::size_t i = 0; i < listed_.size(); ++i)
    listed_[i]->m_index1a = first_ + static_cast<int>(i);
}

void ShownContacts::begin() noexcept {
  for (const auto& pair : pairs_) pair->is_reported = false;
  next_ = 0;
}

ShownContacts::Pair& ShownContacts::findOrAdd(const btCollisionObject& a,
                                              const btCollisionObject& b) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    // Pairs keep much the same order.
    const std::size_t place = (next_ + i) % pairs_.size();
    if (pairs_[place]->a != &a || pairs_[place]->b != &b) continue;
    next_ = place + 1;
    return *pairs_[place];
  }
  pairs_.push_back(std::make_unique<Pair>(Pair{&a, &b}));
  return *pairs_.back();
}

/// False while the broadphase has no such pair: Bullet would not see contact either.
bool ShownContacts::attach(Pair& pair) {
  if (pair.algorithm) return true;
  auto* proxy_a = const_cast<btBroadphaseProxy*>(pair.a->getBroadphaseHandle());
  auto* proxy_b = const_cast<btBroadphaseProxy*>(pair.b->getBroadphaseHandle());
  if (proxy_a == nullptr || proxy_b == nullptr) return false;
  btBroadphasePair* overlap = world_.getPairCache()->findPair(proxy_a, proxy_b);
  if (overlap == nullptr || overlap->m_algorithm != nullptr) return false;
  if (!action_) action_ = std::make_unique<Action>(*this);
  btCollisionAlgorithmConstructionInfo info;
  info.m_dispatcher1 = dispatcher_;
  void* place = dispatcher_->allocateCollisionAlgorithm(sizeof(Algorithm));
  pair.algorithm = new (place) Algorithm(info, *this, pair);
  overlap->m_algorithm = pair.algorithm;
  return true;
}

void ShownContacts::show(const btCollisionObject& a, const btCollisionObject& b,
                         const std::vector<const ContactSum*>& points) {
  if (dispatcher_ == nullptr || points.empty()) return;
  constexpr std::size_t kPointsInOne = MANIFOLD_CACHE_SIZE;
  Pair& pair = findOrAdd(a, b);
  pair.is_reported = true;
  pair.index_a = points.front()->contact.a;
  pair.index_b = points.front()->contact.b;
  pair.rests = std::all_of(points.begin(), points.end(),
                           [](const ContactSum* point) { return point->rests; });
  if (!attach(pair)) {
    for (const ContactSum* point : points) pair.owed_W += point->impulse_W;
    return;
  }
  const std::size_t needed = (points.size() + kPointsInOne - 1) / kPointsInOne;
  while (pair.manifolds.size() > needed) {
    drop(pair.manifolds.back());
    pair.manifolds.pop_back();
  }
  while (pair.manifolds.size() < needed) {
    btPersistentManifold* manifold = makeManifold(pair);
    if (manifold == nullptr) return;
    pair.manifolds.push_back(manifold);
  }
  for (std::size_t i = 0; i < needed; ++i) {
    const std::size_t first = i * kPointsInOne;
    fill(*pair.manifolds[i], pair, points.data() + first,
         static_cast<int>(std::min(kPointsInOne, points.size() - first)));
    pair.owed_W.setZero();
  }
}

/// Not in the dispatcher's list, as long as all are hidden.
btPersistentManifold* ShownContacts::makeManifold(const Pair& pair) {
  btPersistentManifold* manifold = dispatcher_->getNewManifold(pair.a, pair.b);
  if (manifold == nullptr) return nullptr;
  listOf(*dispatcher_).pop_back();
  is_changed_ = true;
  return manifold;
}

void ShownContacts::fill(btPersistentManifold& manifold, const Pair& pair,
                         const ContactSum* const* points, int count) {
  const bool is_new = manifold.getNumContacts() == 0;
  bool is_known[MANIFOLD_CACHE_SIZE] = {};
  int place_of[MANIFOLD_CACHE_SIZE] = {};
  btManifoldPoint fresh[MANIFOLD_CACHE_SIZE];
  const btTransform& pose_a = pair.a->getWorldTransform();
  const btTransform& pose_b = pair.b->getWorldTransform();
  for (int i = 0; i < count; ++i) {
    const RigidContact& contact = points[i]->contact;
    const Vec3 half = 0.5 * contact.distance * contact.n_W;
    const btVector3 on_a = toBullet(Vec3(contact.p_W + half));
    const btVector3 on_b = toBullet(Vec3(contact.p_W - half));
    fresh[i] = btManifoldPoint(pose_a.invXform(on_a), pose_b.invXform(on_b), toBullet(contact.n_W),
                               static_cast<btScalar>(contact.distance));
    fresh[i].m_positionWorldOnA = on_a;
    fresh[i].m_positionWorldOnB = on_b;
    fresh[i].m_combinedFriction = static_cast<btScalar>(contact.friction);
    fresh[i].m_combinedRestitution = static_cast<btScalar>(contact.restitution);
    fresh[i].m_combinedRollingFriction = static_cast<btScalar>(contact.rolling);
    fresh[i].m_combinedSpinningFriction = static_cast<btScalar>(contact.spinning);
    const int known = manifold.getCacheEntry(fresh[i]);
    place_of[i] = known >= 0 && !is_known[known] ? known : -1;
    if (place_of[i] >= 0) is_known[known] = true;
  }
  // A point that the host knows keeps its data. Bullet's callbacks hear of those that end.
  for (int i = 0; i < count; ++i)
    if (place_of[i] >= 0) manifold.replaceContactPoint(fresh[i], place_of[i]);
  const int before = manifold.getNumContacts();
  for (int i = before; i-- > 0;) {
    if (is_known[i]) continue;
    const int last = manifold.getNumContacts() - 1;
    manifold.removeContactPoint(i);
    for (int& place : place_of)
      if (place == last) place = i;
  }
  for (int i = 0; i < count; ++i) {
    if (place_of[i] < 0) {
      place_of[i] = manifold.addManifoldPoint(fresh[i], true);
    }
    btManifoldPoint& point = manifold.getContactPoint(place_of[i]);
    const btVector3 impulse =
        toBullet(i == 0 ? Vec3(points[i]->impulse_W + pair.owed_W) : points[i]->impulse_W);
    const btVector3& normal = point.m_normalWorldOnB;
    point.m_appliedImpulse = impulse.dot(normal);
    const btVector3 aside = impulse - normal * point.m_appliedImpulse;
    btPlaneSpace1(normal, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
    point.m_appliedImpulseLateral1 = aside.dot(point.m_lateralFrictionDir1);
    point.m_appliedImpulseLateral2 = aside.dot(point.m_lateralFrictionDir2);
    ++point.m_lifeTime;
  }
  btPersistentManifold* const shown = &manifold;
  if (is_new && gContactStartedCallback) gContactStartedCallback(shown);
  if (gContactProcessedCallback == nullptr) return;
  for (int i = manifold.getNumContacts() - 1; i >= 0; --i)
    gContactProcessedCallback(manifold.getContactPoint(i), const_cast<btCollisionObject*>(pair.a),
                              const_cast<btCollisionObject*>(pair.b));
}

/// Bullet releases only what is in its list.
void ShownContacts::drop(btPersistentManifold* manifold) {
  is_changed_ = true;
  if (is_hidden_) {
    Manifolds& list = listOf(*dispatcher_);
    manifold->m_index1a = list.size();
    list.push_back(manifold);
  } else {
    std::erase(listed_, manifold);
  }
  dispatcher_->releaseManifold(manifold);
}

void ShownContacts::forget(Pair& pair) {
  for (btPersistentManifold* manifold : pair.manifolds) drop(manifold);
  std::erase_if(pairs_, [&](const auto& other) { return other.get() == &pair; });
}

void ShownContacts::remove(Pair& pair) {
  if (pair.algorithm == nullptr) return forget(pair);
  auto* proxy_a = const_cast<btBroadphaseProxy*>(pair.a->getBroadphaseHandle());
  auto* proxy_b = const_cast<btBroadphaseProxy*>(pair.b->getBroadphaseHandle());
  btBroadphasePair* overlap = world_.getPairCache()->findPair(proxy_a, proxy_b);
  if (overlap && overlap->m_algorithm == pair.algorithm)
    world_.getPairCache()->cleanOverlappingPair(*overlap, dispatcher_);
}

void ShownContacts::clear() {
  while (!pairs_.empty()) {
    const std::size_t before = pairs_.size();
    remove(*pairs_.back());
    if (pairs_.size() == before) pairs_.pop_back();
  }
  action_.reset();
  if (group_) std::erase(group_->members, this);
  group_.reset();
}

}  // namespace tandem
