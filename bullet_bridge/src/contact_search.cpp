#include "contact_search.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem {
namespace {

/// Points farther apart than this are of no interest to an inner step [m].
constexpr double kFarthest = 1e-3;

/// Distances below this are rounding of a float Bullet some decimetres from the private origin [m]:
/// taken for real they would keep bodies at rest trembling.
constexpr double kRounding = sizeof(btScalar) == sizeof(double) ? 0.0 : 6e-8;

btDefaultCollisionConstructionInfo makePools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 512;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 512;
  return info;
}

btCollisionObjectWrapper wrap(const PrivateCopy& copy) {
  return {nullptr,      copy.object.getCollisionShape(),
          &copy.object, copy.object.getWorldTransform(),
          -1,           -1};
}

}  // namespace

ContactSearch::ContactSearch(double min_bounce_speed)
    : configuration_(makePools()),
      dispatcher_(&configuration_),
      min_bounce_speed_(min_bounce_speed) {
  // A body lying flat gets all its corners at once, instead of one per step while it rocks on the
  // others.
  configuration_.setPlaneConvexMultipointIterations(8, 4);
}

ContactSearch::~ContactSearch() {
  for (Pair& pair : pairs_) release(pair);
}

/// By island index, standing ones last in the order in which they came: equal scenes, equal order.
void ContactSearch::sortPairs() {
  const auto rank = [](const PrivateCopy& copy) {
    return copy.index == kStanding ? std::numeric_limits<BodyIndex>::max() : copy.index;
  };
  std::stable_sort(pairs_.begin(), pairs_.end(), [&](const Pair& x, const Pair& y) {
    return std::pair(rank(*x.a), rank(*x.b)) < std::pair(rank(*y.a), rank(*y.b));
  });
  indexPairs();
}

/// So that a tick looks at pairs of bodies that move, and at no others.
void ContactSearch::indexPairs() {
  for (auto& list : pairs_of_) list.clear();
  std::fill(copy_of_.begin(), copy_of_.end(), nullptr);
  for (const auto& body : bodies_) {
    const auto index = static_cast<std::size_t>(body->index);
    if (index >= copy_of_.size()) copy_of_.resize(index + 1, nullptr);
    copy_of_[index] = body.get();
  }
  near_.clear();
  near_.reserve(pairs_.size());
  were_near_.reserve(pairs_.size());
  awake_.reserve(bodies_.size());
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for (const PrivateCopy* copy : {pairs_[i].a, pairs_[i].b}) {
      if (copy->index == kStanding) continue;
      const auto body = static_cast<std::size_t>(copy->index);
      if (body >= pairs_of_.size()) pairs_of_.resize(body + 1);
      pairs_of_[body].push_back(i);
    }
    if (pairs_[i].near) near_.push_back(i);
  }
}

void ContactSearch::erase(const btCollisionObject* original) {
  const auto is_it = [&](const auto& copy) { return copy->original == original; };
  std::erase_if(pairs_, [&](Pair& pair) {
    if (!is_it(pair.a) && !is_it(pair.b)) return false;
    release(pair);
    return true;
  });
  std::erase_if(bodies_, is_it);
  std::erase_if(standing_, is_it);
  indexPairs();
}

bool ContactSearch::overlaps(const Pair& pair, const Region& a, const Region& b) const noexcept {
  if (pair.b->plane) return reaches(*pair.b->plane, pair.b->object.getWorldTransform(), a);
  return overlap(a, b);
}

void ContactSearch::place(BodyIndex body, const std::vector<RigidState>& states) noexcept {
  PrivateCopy& copy = *copy_of_[static_cast<std::size_t>(body)];
  const RigidState& state = states[static_cast<std::size_t>(body)];
  const Vec3 p = state.p_W - origin_W_;
  if (p == copy.p_placed && state.q_WB.coeffs() == copy.q_placed.coeffs()) return;
  copy.p_placed = p;
  copy.q_placed = state.q_WB;
  copy.place(toBullet(p, state.q_WB));
}

void ContactSearch::placeAll(const std::vector<RigidState>& states) noexcept {
  for (const auto& body : bodies_) place(body->index, states);
}

template <typename Visit>
void ContactSearch::forEachPairOf(BodyIndex body, Visit visit) {
  if (static_cast<std::size_t>(body) >= pairs_of_.size()) return;
  for (const std::size_t i : pairs_of_[static_cast<std::size_t>(body)]) visit(i);
}

void ContactSearch::lookAround(const std::vector<RigidState>& states,
                               const std::vector<double>& reach, std::vector<char>& awake,
                               std::vector<char>& near) noexcept {
  were_near_.swap(near_);
  near_.clear();
  for (const std::size_t i : were_near_) pairs_[i].near = false;
  const auto grown = [&](const PrivateCopy& copy) {
    if (copy.index == kStanding) return copy.bounds;
    return growRegion(copy.bounds,
                      static_cast<btScalar>(reach[static_cast<std::size_t>(copy.index)]));
  };
  awake_.clear();
  for (std::size_t body = 0; body < copy_of_.size(); ++body) {
    if (!awake[body] || !copy_of_[body]) continue;
    awake_.push_back(static_cast<BodyIndex>(body));
    place(awake_.back(), states);
  }
  // Those that rest are where they were placed last. Waking is catching: those that are woken wake
  // others.
  for (std::size_t next = 0; next < awake_.size(); ++next) {
    forEachPairOf(awake_[next], [&](std::size_t i) {
      Pair& pair = pairs_[i];
      const auto a = static_cast<std::size_t>(pair.a->index);
      const auto b = pair.b->index != kStanding ? static_cast<std::size_t>(pair.b->index) : a;
      if (pair.near || reach[a] < 0.0 || reach[b] < 0.0) return;
      if (!overlaps(pair, grown(*pair.a), grown(*pair.b))) return;
      pair.near = true;
      near_.push_back(i);
      for (const std::size_t body : {a, b}) {
        near[body] = 1;
        if (awake[body]) continue;
        awake[body] = 1;
        awake_.push_back(static_cast<BodyIndex>(body));
        place(awake_.back(), states);
      }
    });
  }
  std::sort(near_.begin(), near_.end());
  for (const std::size_t i : were_near_)
    if (!pairs_[i].near) release(pairs_[i]);
}

void ContactSearch::find(const std::vector<RigidState>& states,
                         std::vector<RigidContact>& contacts) noexcept {
  for (const BodyIndex body : awake_) place(body, states);
  for (const std::size_t i : near_) {
    Pair& pair = pairs_[i];
    if (overlaps(pair, pair.a->bounds, pair.b->bounds)) search(pair, contacts);
  }
}

void ContactSearch::search(Pair& pair, std::vector<RigidContact>& contacts) noexcept {
  ++searches_;
  const btCollisionObjectWrapper a = wrap(*pair.a), b = wrap(*pair.b);
  if (pair.algorithm == nullptr)
    pair.algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  if (pair.algorithm == nullptr) return;
  if (pair.b->plane) slideAlong(pair);
  btManifoldResult result(&a, &b);
  pair.algorithm->processCollision(&a, &b, dispatch_, &result);
  manifolds_.resize(0);
  pair.algorithm->getAllContactManifolds(manifolds_);
  for (int m = 0; m < manifolds_.size(); ++m) {
    const btPersistentManifold& manifold = *manifolds_[m];
    // The normal points from the second object to the first.
    const double side = manifold.getBody0() == &pair.a->object ? 1.0 : -1.0;
    for (int i = 0; i < manifold.getNumContacts() && contacts.size() < contacts.capacity(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      RigidContact contact;
      contact.distance = static_cast<double>(point.getDistance() + pair.a->skin + pair.b->skin);
      if (contact.distance > kFarthest) continue;
      if (std::abs(contact.distance) < kRounding) contact.distance = 0.0;
      contact.a = pair.a->index;
      contact.b = pair.b->index;
      contact.n_W = side * fromBullet(point.m_normalWorldOnB).normalized();
      contact.p_W =
          origin_W_ +
          fromBullet((point.getPositionWorldOnA() + point.getPositionWorldOnB()) * btScalar(0.5));
      contact.friction = static_cast<double>(point.m_combinedFriction);
      contact.restitution = static_cast<double>(point.m_combinedRestitution);
      contact.min_bounce_speed = min_bounce_speed_;
      contacts.push_back(contact);
    }
  }
}

/// Bullet drops a contact whose two points have drifted apart along the surface, and for a step the
/// body stands on fewer corners. A plane is the same everywhere: there the plane's point follows
/// the body's.
void ContactSearch::slideAlong(const Pair& pair) noexcept {
  manifolds_.resize(0);
  pair.algorithm->getAllContactManifolds(manifolds_);
  const btTransform& pose = pair.b->object.getWorldTransform();
  const btVector3 normal = pose.getBasis() * pair.b->plane->getPlaneNormal();
  for (int m = 0; m < manifolds_.size(); ++m) {
    btPersistentManifold& manifold = *manifolds_[m];
    const bool is_first = manifold.getBody0() == &pair.a->object;
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      btManifoldPoint& point = manifold.getContactPoint(i);
      btVector3& on_plane = is_first ? point.m_localPointB : point.m_localPointA;
      const btVector3 on_body = pair.a->object.getWorldTransform() *
                                (is_first ? point.m_localPointA : point.m_localPointB);
      on_plane = pose.invXform(on_body - normal * normal.dot(on_body - pose.getOrigin()));
    }
  }
}

void ContactSearch::release(Pair& pair) noexcept {
  if (pair.algorithm == nullptr) return;
  pair.algorithm->~btCollisionAlgorithm();
  dispatcher_.freeCollisionAlgorithm(pair.algorithm);
  pair.algorithm = nullptr;
}

}  // namespace tandem
