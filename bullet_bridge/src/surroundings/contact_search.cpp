#include "surroundings/contact_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem {
namespace {

/// Points farther apart than this do not matter to an inner step [m].
constexpr double kFarthest = 1e-3;

/// Smaller distances are rounding of a float Bullet some decimetres from the private origin [m]. If
/// they counted, bodies at rest would tremble.
constexpr double kRounding = sizeof(btScalar) == sizeof(double) ? 0.0 : 6e-8;

constexpr int kManifolds = 512;

btDefaultCollisionConstructionInfo makePools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = kManifolds;
  info.m_defaultMaxCollisionAlgorithmPoolSize = kManifolds;
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
      dispatcher_(&configuration_, kManifolds),
      min_bounce_speed_(min_bounce_speed) {
  // A body lying flat gets all its corners at once. Otherwise it gains one per step and rocks.
  configuration_.setPlaneConvexMultipointIterations(8, 4);
}

ContactSearch::~ContactSearch() {
  for (Pair& pair : book_.pairs) release(pair);
}

void ContactSearch::setOrigin(const Vec3& origin_W, const std::vector<RigidState>& states) {
  wanted_origin_W_ = origin_W;
  moved_states_ = states;
}

bool ContactSearch::placeStanding(PrivateCopy& copy) {
  const btTransform pose = copy.findOriginal(wanted_origin_W_);
  if (pose == copy.object.getWorldTransform()) return false;
  placings_.push_back({&copy, pose});
  return true;
}

void ContactSearch::showSurfaces() {
  surfacings_.clear();
  const auto show = [&](PrivateCopy& copy) {
    const Surface surface = Surface::of(*copy.original);
    if (!(surface == Surface::of(copy.object))) surfacings_.push_back({&copy, surface});
  };
  for (const auto& body : bodies_) show(*body);
  for (const auto& object : standing_) show(*object);
}

/// Sorts by island index, then standing objects by arrival: equal scenes give equal order.
void ContactSearch::sortLinks() {
  const auto rank = [](const PrivateCopy& copy) {
    return copy.index == kStanding ? std::numeric_limits<BodyIndex>::max() : copy.index;
  };
  std::stable_sort(links_.begin(), links_.end(), [&](const Neighbours& x, const Neighbours& y) {
    return std::pair(rank(*x.a), rank(*x.b)) < std::pair(rank(*y.a), rank(*y.b));
  });
}

void ContactSearch::prepare() {
  if (!is_drawn_) going_.clear();
  if (!is_changed_) return;
  is_changed_ = false;
  std::move(removed_.begin(), removed_.end(), std::back_inserter(going_));
  removed_.clear();
  sortLinks();
  fillDraft();
  is_drawn_ = true;
}

/// Builds the lists that let a tick visit only pairs with moving bodies.
void ContactSearch::fillDraft() {
  draft_.pairs.clear();
  for (auto& list : draft_.pairs_of) list.clear();
  std::fill(draft_.copy_of.begin(), draft_.copy_of.end(), nullptr);
  for (const auto& body : bodies_) {
    const auto index = static_cast<std::size_t>(body->index);
    if (index >= draft_.copy_of.size()) draft_.copy_of.resize(index + 1, nullptr);
    draft_.copy_of[index] = body.get();
  }
  for (std::size_t i = 0; i < links_.size(); ++i) {
    draft_.pairs.push_back({links_[i].a, links_[i].b});
    for (const PrivateCopy* copy : {links_[i].a, links_[i].b}) {
      if (copy->index == kStanding) continue;
      const auto body = static_cast<std::size_t>(copy->index);
      if (body >= draft_.pairs_of.size()) draft_.pairs_of.resize(body + 1);
      draft_.pairs_of[body].push_back(i);
    }
  }
  draft_.near.clear();
  draft_.near.reserve(links_.size());
  draft_.were_near.reserve(links_.size());
  draft_.awake.clear();
  draft_.awake.reserve(bodies_.size());
}

void ContactSearch::erase(const btCollisionObject* original) {
  const auto is_it = [&](const auto& copy) { return copy->original == original; };
  std::erase_if(links_, [&](const Neighbours& link) { return is_it(link.a) || is_it(link.b); });
  std::erase_if(placings_, [&](const Placing& placing) { return is_it(placing.copy); });
  std::erase_if(surfacings_, [&](const Surfacing& one) { return is_it(one.copy); });
  for (auto* copies : {&bodies_, &standing_}) {
    const auto gone = std::find_if(copies->begin(), copies->end(), is_it);
    if (gone == copies->end()) continue;
    removed_.push_back(std::move(*gone));
    copies->erase(gone);
  }
  is_changed_ = true;
}

void ContactSearch::commit() noexcept {
  if (is_drawn_) {
    is_drawn_ = false;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      std::size_t& place = links_[i].place;
      if (place != kNowhere) {
        std::swap(draft_.pairs[i].algorithm, book_.pairs[place].algorithm);
        draft_.pairs[i].near = book_.pairs[place].near;
        if (draft_.pairs[i].near) draft_.near.push_back(i);
      }
      place = i;
    }
    for (Pair& pair : book_.pairs) release(pair);
    std::swap(book_, draft_);
  }
  origin_W_ = wanted_origin_W_;
  for (const Placing& placing : placings_) placing.copy->place(placing.pose);
  placings_.clear();
  for (const Surfacing& one : surfacings_) one.surface.applyTo(one.copy->object);
  surfacings_.clear();
  if (moved_states_.empty()) return;
  for (const auto& body : bodies_)
    place(body->index, moved_states_[static_cast<std::size_t>(body->index)]);
  moved_states_.clear();
}

bool ContactSearch::overlaps(const Pair& pair, const Region& a, const Region& b) const noexcept {
  if (pair.b->plane) return reaches(*pair.b->plane, pair.b->object.getWorldTransform(), a);
  return overlap(a, b);
}

void ContactSearch::place(BodyIndex body, const RigidState& state) noexcept {
  PrivateCopy& copy = *book_.copy_of[static_cast<std::size_t>(body)];
  const Vec3 p = state.p_W - origin_W_;
  if (p == copy.p_placed && state.q_WB.coeffs() == copy.q_placed.coeffs()) return;
  copy.p_placed = p;
  copy.q_placed = state.q_WB;
  copy.place(toBullet(p, state.q_WB));
}

template <typename Visit>
void ContactSearch::forEachPairOf(BodyIndex body, Visit visit) {
  if (static_cast<std::size_t>(body) >= book_.pairs_of.size()) return;
  for (const std::size_t i : book_.pairs_of[static_cast<std::size_t>(body)]) visit(i);
}

void ContactSearch::lookAround(const std::vector<RigidState>& states,
                               const std::vector<double>& reach, std::vector<char>& awake,
                               std::vector<char>& near) noexcept {
  book_.were_near.swap(book_.near);
  book_.near.clear();
  for (const std::size_t i : book_.were_near) book_.pairs[i].near = false;
  const auto grown = [&](const PrivateCopy& copy) {
    if (copy.index == kStanding) return copy.bounds;
    return growRegion(copy.bounds,
                      static_cast<btScalar>(reach[static_cast<std::size_t>(copy.index)]));
  };
  const auto placeAt = [&](BodyIndex body) { place(body, states[static_cast<std::size_t>(body)]); };
  book_.awake.clear();
  for (std::size_t body = 0; body < book_.copy_of.size(); ++body) {
    if (!awake[body] || !book_.copy_of[body]) continue;
    book_.awake.push_back(static_cast<BodyIndex>(body));
    placeAt(book_.awake.back());
  }
  // Bodies at rest keep their last place. Waking spreads: woken bodies wake others.
  for (std::size_t next = 0; next < book_.awake.size(); ++next) {
    forEachPairOf(book_.awake[next], [&](std::size_t i) {
      Pair& pair = book_.pairs[i];
      const auto a = static_cast<std::size_t>(pair.a->index);
      const auto b = pair.b->index != kStanding ? static_cast<std::size_t>(pair.b->index) : a;
      if (pair.near || reach[a] < 0.0 || reach[b] < 0.0) return;
      if (!overlaps(pair, grown(*pair.a), grown(*pair.b))) return;
      pair.near = true;
      book_.near.push_back(i);
      for (const std::size_t body : {a, b}) {
        near[body] = 1;
        if (awake[body]) continue;
        awake[body] = 1;
        book_.awake.push_back(static_cast<BodyIndex>(body));
        placeAt(book_.awake.back());
      }
    });
  }
  std::sort(book_.near.begin(), book_.near.end());
  for (const std::size_t i : book_.were_near)
    if (!book_.pairs[i].near) release(book_.pairs[i]);
}

void ContactSearch::find(const std::vector<RigidState>& states,
                         std::vector<RigidContact>& contacts) noexcept {
  for (const BodyIndex body : book_.awake) place(body, states[static_cast<std::size_t>(body)]);
  for (const std::size_t i : book_.near) {
    Pair& pair = book_.pairs[i];
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
      // Bullet's solver uses spinning friction only together with rolling friction.
      if (point.m_combinedRollingFriction > 0) {
        contact.rolling = static_cast<double>(point.m_combinedRollingFriction);
        contact.spinning = static_cast<double>(point.m_combinedSpinningFriction);
      }
      contact.min_bounce_speed = min_bounce_speed_;
      contacts.push_back(contact);
    }
  }
}

/// Bullet drops a contact whose two points have drifted apart along the surface. The body would
/// then stand on fewer corners for a step. A plane is uniform, so its point follows the body's.
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
