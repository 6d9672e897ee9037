#include "surroundings/obstacles.h"

#include <algorithm>
#include <string>
#include <utility>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "surroundings/contact_search.h"
#include "surroundings/host_pairs.h"
#include "surroundings/known_shapes.h"
#include "surroundings/obstacle_search.h"
#include "surroundings/own_filters.h"
#include "surroundings/shown_contacts.h"
#include "world/world_lookup.h"

namespace tandem {
namespace {

/// At this distance from the first body the private origin follows it [m]. The rounding of a float
/// Bullet thus stays below 6e-8 m.
constexpr double kOriginReach = 0.25;

/// True if the original of `copy` stores the contact filter of the pair: a standing object, else
/// the later body. A link of a multi-body cannot.
bool isKeeper(const PrivateCopy& copy, const PrivateCopy& other) {
  if (copy.may_keep_filters != other.may_keep_filters) return copy.may_keep_filters;
  return copy.index == kStanding || (other.index != kStanding && copy.index > other.index);
}

}  // namespace

struct Obstacles::Impl {
  struct Ball {
    BodyIndex index;
    btScalar radius;
  };

  explicit Impl(btDiscreteDynamicsWorld& world)
      : host(world),
        shown(world),
        filters(world),
        search(static_cast<double>(world.getSolverInfo().m_restitutionVelocityThreshold)) {}

  [[nodiscard]] btCollisionObject* findBody(BodyIndex index) const;
  [[nodiscard]] btCollisionObject* findPartner(const RigidContact& contact) const;
  void showPair(std::vector<const ContactSum*>::iterator first,
                std::vector<const ContactSum*>::iterator last);
  void remove(btCollisionObject* original);
  void unfilter(PrivateCopy& keeper, const PrivateCopy& other);
  void moveOrigin(const std::vector<RigidState>& states);
  void findForBodies(const std::vector<RigidState>& states, btScalar margin,
                     const std::vector<char>* moves);
  void findForSpheres(const std::vector<RigidState>& states, btScalar margin);
  void dropHeld();
  void dropMissingBodies();
  void renewChangedBodies();
  void dropLost();
  [[nodiscard]] bool isAnyStandingNew() noexcept;
  [[nodiscard]] bool isAnyBodyNew() noexcept;
  [[nodiscard]] bool isAnyAnswerNew();
  [[nodiscard]] static bool isNewToOthers(const PrivateCopy& copy) noexcept;
  void renewPairs();
  void takeFound();
  /// Takes over pairs that the host lets touch: their contact is now the island's.
  [[nodiscard]] auto takeOver() {
    return [this](PrivateCopy& a, PrivateCopy& b) { return takeOver(a, b); };
  }
  [[nodiscard]] bool takeOver(PrivateCopy& a, PrivateCopy& b);
  [[nodiscard]] bool hasOtherAnswers(PrivateCopy& copy);
  void forgetRefused(const btCollisionObject* original) {
    std::erase_if(refused, [&](const auto& pair) {
      return pair.first == original || pair.second == original;
    });
  }

  btDiscreteDynamicsWorld& host;
  ShownContacts shown;
  OwnFilters filters;
  ContactSearch search;
  std::vector<Ball> balls;
  std::vector<Obstacle> near_spheres, next_near_spheres;
  bool has_next = false;  ///< next_near_spheres is ready
  KnownShapes known_shapes;
  bool changed = false;
  bool has_near_callback = false;  ///< the host has one of its own
  /// Pairs that code of the host did not let touch; addresses only.
  std::vector<std::pair<const btCollisionObject*, const btCollisionObject*>> refused;
  // Work space of update().
  std::vector<btCollisionObject*> found;
  std::vector<Region> regions;
  // Work space of showContacts().
  std::vector<const ContactSum*> points, points_of_pair;
};

bool Obstacles::Impl::takeOver(PrivateCopy& a, PrivateCopy& b) {
  if (findInWorld(host, a.original) < 0 || findInWorld(host, b.original) < 0) return false;
  // A shape that cannot be copied stays Bullet's, and so do points that a callback changes.
  if (!a.isWhole() || !b.isWhole() || a.asks_host || b.asks_host) return false;
  // So does that of two links.
  if (!a.may_keep_filters && !b.may_keep_filters) return false;
  // If forces move neither body, neither can be pushed.
  if (a.original->isStaticOrKinematicObject() && b.original->isStaticOrKinematicObject())
    return false;
  if (hasOwnNearCallback(host)) return false;
  if (!hostLetsTouch(host, *a.original, *b.original)) {
    if (hasOwnFilter(host)) refused.emplace_back(a.original, b.original);
    return false;
  }
  const bool a_keeps = isKeeper(a, b);
  PrivateCopy& keeper = a_keeps ? a : b;
  btCollisionObject& other = *(a_keeps ? b : a).original;
  if (!keeper.holdsOwnFilters()) return false;  // another object at the address
  filters.add(*keeper.original, other);
  if (mindsNoFilter(host, *keeper.original, other)) {
    filters.remove(keeper.original, &other);
    return false;
  }
  ++keeper.own_filters;
  return true;
}

/// True if the host's code answers otherwise now about a pair of the copy, which is in the world.
bool Obstacles::Impl::hasOtherAnswers(PrivateCopy& copy) {
  const auto isInWorld = [&](const btCollisionObject* object) {
    return findInWorld(host, object) >= 0;
  };
  bool has_other = false;
  search.visitPartners(copy, [&](PrivateCopy& partner) {
    if (has_other || findInWorld(host, partner.original, partner.world_index) < 0) return;
    const bool it_keeps = isKeeper(copy, partner);
    btCollisionObject& keeper = *(it_keeps ? copy : partner).original;
    btCollisionObject& other = *(it_keeps ? partner : copy).original;
    keeper.setIgnoreCollisionCheck(&other, false);
    has_other = !hostLetsTouch(host, keeper, other);
    keeper.setIgnoreCollisionCheck(&other, true);
  });
  return has_other || std::any_of(refused.begin(), refused.end(), [&](const auto& pair) {
           const auto& [a, b] = pair;
           return (a == copy.original || b == copy.original) && isInWorld(a) && isInWorld(b) &&
                  hostLetsTouch(host, *a, *b);
         });
}

Obstacles::Obstacles(btDiscreteDynamicsWorld& host) : impl_(std::make_unique<Impl>(host)) {}

Obstacles::~Obstacles() {
  while (!impl_->search.bodies().empty()) impl_->remove(impl_->search.bodies().back()->original);
  impl_->filters.removeLate();
}

void Obstacles::addBody(BodyIndex index, btCollisionObject& body) {
  if (impl_->findBody(index) != nullptr)
    throw Error("island body " + std::to_string(index) + " has a rigid body already; add it once");
  const bool is_driven = body.isKinematicObject();
  if (index < 0 || (body.isStaticObject() && !is_driven))
    throw Error("only a moving body with an index of its island can be held by obstacles");
  const btCollisionShape& shape = *body.getCollisionShape();
  if (!shape.isConvex() && !shape.isCompound() &&
      !(is_driven && shape.getShapeType() != STATIC_PLANE_PROXYTYPE))
    throw Error(std::string("obstacles cannot hold a body of shape ") + shape.getName() +
                "; use a convex shape or a compound of them");
  impl_->remove(&body);  // as a standing object, until the host let it move
  impl_->search.addBody(index, body, impl_->takeOver());
  impl_->search.prepare();
}

std::optional<Shape> Obstacles::findForm(const btCollisionObject& body) {
  return impl_->known_shapes.findWhole(body);
}

void Obstacles::removeBody(BodyIndex index) {
  if (btCollisionObject* body = impl_->findBody(index)) impl_->remove(body);
  impl_->search.prepare();
}

void Obstacles::forgetWorld() {
  while (!impl_->search.bodies().empty()) impl_->remove(impl_->search.bodies().back()->original);
  while (!impl_->search.standing().empty())
    impl_->remove(impl_->search.standing().back()->original);
  impl_->shown.clear();
  impl_->filters.removeLate();
  impl_->filters.forgetWorld();
  impl_->search.prepare();
  impl_->next_near_spheres.clear();
  impl_->has_next = true;
}

void Obstacles::addSphere(BodyIndex index, double radius) {
  impl_->balls.push_back({index, static_cast<btScalar>(radius)});
}

bool Obstacles::search(const std::vector<RigidState>& states, double margin,
                       const std::vector<char>* moves) {
  const auto reach = static_cast<btScalar>(margin);
  impl_->changed = false;
  impl_->dropMissingBodies();
  impl_->renewChangedBodies();
  impl_->filters.removeLate();
  impl_->moveOrigin(states);
  impl_->findForBodies(states, reach, moves);
  impl_->dropLost();
  impl_->takeFound();
  impl_->renewPairs();
  impl_->changed |= impl_->search.showSurfaces();
  impl_->search.gatherTriangles(states, reach);
  impl_->search.prepare();
  impl_->findForSpheres(states, reach);
  return impl_->changed;
}

bool Obstacles::hasNews() {
  return impl_->search.hasNewCombiners() || impl_->isAnyStandingNew() || impl_->isAnyBodyNew() ||
         impl_->has_near_callback != hasOwnNearCallback(impl_->host) ||
         (hasOwnFilter(impl_->host) && impl_->isAnyAnswerNew());
}

/// All bodies are in the world.
bool Obstacles::Impl::isAnyAnswerNew() {
  return std::any_of(search.bodies().begin(), search.bodies().end(),
                     [&](const auto& copy) { return hasOtherAnswers(*copy); });
}

/// True if the host removed, moved or changed an object since the last search().
bool Obstacles::Impl::isAnyStandingNew() noexcept {
  return std::any_of(search.standing().begin(), search.standing().end(), [&](const auto& copy) {
    copy->world_index = findInWorld(host, copy->original, copy->world_index);
    return copy->world_index < 0 || !isObstacle(*copy->original) || !copy->isAsCopied() ||
           search.hasMoved(*copy) || isNewToOthers(*copy);
  });
}

bool Obstacles::Impl::isAnyBodyNew() noexcept {
  return std::any_of(search.bodies().begin(), search.bodies().end(), [&](const auto& copy) {
    copy->world_index = findInWorld(host, copy->original, copy->world_index);
    return copy->world_index >= 0 && isNewToOthers(*copy);
  });
}

/// True if the host changed its surface, or what it may touch.
bool Obstacles::Impl::isNewToOthers(const PrivateCopy& copy) noexcept {
  return !(Surface::of(*copy.original) == copy.surface) || copy.hasOtherFilters() ||
         asksContactCallback(*copy.original) != copy.asks_host;
}

void Obstacles::commit() noexcept {
  impl_->search.commit();
  if (impl_->has_next) {
    impl_->near_spheres.swap(impl_->next_near_spheres);
  } else {
    for (Obstacle& obstacle : impl_->near_spheres) obstacle.change = ObstacleChange::kNone;
  }
  impl_->has_next = false;
}

void Obstacles::shiftOrigin(const Vec3& offset_W) noexcept {
  impl_->search.shiftOrigin(offset_W);
  for (std::vector<Obstacle>* list : {&impl_->near_spheres, &impl_->next_near_spheres}) {
    for (Obstacle& obstacle : *list) {
      obstacle.p_WB += offset_W;
      obstacle.p_before_WB += offset_W;
    }
  }
}

const std::vector<Obstacle>& Obstacles::nearSpheres() const noexcept { return impl_->near_spheres; }

void Obstacles::lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                           std::vector<char>& awake, std::vector<char>& near) noexcept {
  impl_->search.lookAround(states, reach, awake, near);
}

void Obstacles::find(const std::vector<RigidState>& states,
                     std::vector<RigidContact>& contacts) noexcept {
  impl_->search.find(states, contacts);
}

void Obstacles::hideContacts() noexcept { impl_->shown.hide(); }
void Obstacles::unhideContacts() { impl_->shown.unhide(); }

void Obstacles::showContacts(const std::vector<ContactSum>& sums, const std::vector<char>& still) {
  Impl& impl = *impl_;
  impl.shown.hide();
  impl.shown.begin();
  impl.points.clear();
  for (const ContactSum& sum : sums) impl.points.push_back(&sum);
  const auto bodies_of = [](const ContactSum* sum) {
    return std::pair(sum->contact.a, sum->contact.b);
  };
  std::stable_sort(
      impl.points.begin(), impl.points.end(),
      [&](const ContactSum* x, const ContactSum* y) { return bodies_of(x) < bodies_of(y); });
  for (auto first = impl.points.begin(); first != impl.points.end();) {
    const auto is_of_pair = [&](const ContactSum* sum) {
      return areOfOnePair(sum->contact, (*first)->contact);
    };
    // A body's points on the first of several fixed surfaces come first.
    const auto last = std::stable_partition(first, impl.points.end(), is_of_pair);
    impl.showPair(first, last);
    first = last;
  }
  const auto is_still = [&](BodyIndex body) {
    return body == kStanding || still[static_cast<std::size_t>(body)] != 0;
  };
  impl.shown.end([&](BodyIndex a, BodyIndex b) { return is_still(a) && is_still(b); });
}

/// Bodies may have left since the points were counted.
void Obstacles::Impl::showPair(std::vector<const ContactSum*>::iterator first,
                               std::vector<const ContactSum*>::iterator last) {
  const btCollisionObject* a = findBody((*first)->contact.a);
  const btCollisionObject* b = findPartner((*first)->contact);
  if (a == nullptr || b == nullptr) return;
  points_of_pair.assign(first, last);
  shown.show(*a, *b, points_of_pair);
}

/// Null if it is known no more, or not in the world.
btCollisionObject* Obstacles::Impl::findPartner(const RigidContact& contact) const {
  if (contact.b != kStanding) return findBody(contact.b);
  for (const auto& object : search.standing())
    if (object->original == contact.surface &&
        findInWorld(host, object->original, object->world_index) >= 0)
      return object->original;
  return nullptr;
}

std::uint64_t Obstacles::searches() const noexcept { return impl_->search.searches(); }
std::uint64_t Obstacles::frozenSearches() const noexcept { return impl_->search.frozenSearches(); }

btCollisionObject* Obstacles::Impl::findBody(BodyIndex index) const {
  for (const auto& body : search.bodies())
    if (body->index == index) return body->original;
  return nullptr;
}

void Obstacles::Impl::remove(btCollisionObject* original) {
  changed = true;
  filters.removeLate();  // or a keeper that is back holds more than its copy knows of
  forgetRefused(original);
  search.remove(original, [&](PrivateCopy& removed, PrivateCopy& partner) {
    const bool it_keeps = isKeeper(removed, partner);
    unfilter(it_keeps ? removed : partner, it_keeps ? partner : removed);
  });
}

void Obstacles::Impl::unfilter(PrivateCopy& keeper, const PrivateCopy& other) {
  const bool is_another = findInWorld(host, keeper.original) >= 0 && !keeper.holdsOwnFilters();
  if (is_another) return;  // made at the address: the next search takes it anew
  --keeper.own_filters;
  filters.remove(keeper.original, other.original);
}

void Obstacles::Impl::moveOrigin(const std::vector<RigidState>& states) {
  if (search.bodies().empty()) return;
  const Vec3& p_W = states[static_cast<std::size_t>(search.bodies().front()->index)].p_W;
  if ((p_W - search.origin()).norm() > kOriginReach) search.setOrigin(p_W, states);
}

void Obstacles::Impl::findForBodies(const std::vector<RigidState>& states, btScalar margin,
                                    const std::vector<char>* moves) {
  found.clear();
  // Known objects stay near bodies that stand.
  if (moves)
    for (const auto& copy : search.standing())
      if (findInWorld(host, copy->original, copy->world_index) >= 0 && isObstacle(*copy->original))
        found.push_back(copy->original);
  for (const auto& body : search.bodies()) {
    if (body->original->isKinematicObject()) continue;
    if (moves && !(*moves)[static_cast<std::size_t>(body->index)]) continue;
    const RigidState& state = states[static_cast<std::size_t>(body->index)];
    const Region region = computeRegion(*body->look.shape, toBullet(state.p_W, state.q_WB));
    findStaticObjects(host, growRegion(region, margin), found);
  }
  dropHeld();
  sortAsAdded(found);
}

/// A body may have been disabled by its host since it is held: it stands once it has left.
void Obstacles::Impl::dropHeld() {
  std::erase_if(found, [&](const btCollisionObject* object) {
    return std::any_of(search.bodies().begin(), search.bodies().end(),
                       [&](const auto& body) { return body->original == object; });
  });
}

/// The host may remove a body from its world and delete it.
void Obstacles::Impl::dropMissingBodies() {
  for (std::size_t i = search.bodies().size(); i-- > 0;) {
    PrivateCopy& copy = *search.bodies()[i];
    copy.world_index = findInWorld(host, copy.original, copy.world_index);
    if (copy.world_index < 0) remove(copy.original);
  }
}

/// Copies the shapes of bodies anew whose owner changed them. All bodies are in the world.
void Obstacles::Impl::renewChangedBodies() {
  for (std::size_t i = search.bodies().size(); i-- > 0;) {
    const PrivateCopy& copy = *search.bodies()[i];
    if (copy.isAsCopied()) continue;
    const BodyIndex index = copy.index;
    btCollisionObject& original = *copy.original;
    remove(&original);
    search.addBody(index, original, takeOver());
  }
}

/// The host may change at any time which objects touch, and of which it asks for contact points.
void Obstacles::Impl::renewPairs() {
  const bool had_near_callback = std::exchange(has_near_callback, hasOwnNearCallback(host));
  const bool asks_all = hasOwnFilter(host);  // of each pair, one is a body
  for (const auto* copies : {&search.bodies(), &search.standing()}) {
    for (const auto& copy : *copies) {
      const bool asks_host = asksContactCallback(*copy->original);
      const bool is_renewed = copy->hasNewFilters() || asks_host != copy->asks_host ||
                              has_near_callback != had_near_callback ||
                              (asks_all && copy->index != kStanding && hasOtherAnswers(*copy));
      if (!is_renewed) continue;
      forgetRefused(copy->original);
      copy->asks_host = asks_host;
      changed = true;
      search.renewPairs(
          *copy,
          [&](PrivateCopy& renewed, PrivateCopy& partner) {
            const bool it_keeps = isKeeper(renewed, partner);
            unfilter(it_keeps ? renewed : partner, it_keeps ? partner : renewed);
          },
          takeOver());
    }
  }
}

void Obstacles::Impl::dropLost() {
  const auto& standing = search.standing();
  for (std::size_t i = standing.size(); i-- > 0;) {
    btCollisionObject* original = standing[i]->original;
    const bool is_found = std::find(found.begin(), found.end(), original) != found.end();
    if (!is_found || !standing[i]->isAsCopied()) remove(original);
  }
}

void Obstacles::Impl::takeFound() {
  for (btCollisionObject* object : found) {
    const auto& known = search.standing();
    const auto copy = std::find_if(known.begin(), known.end(),
                                   [&](const auto& entry) { return entry->original == object; });
    if (copy != known.end()) {
      changed |= search.placeStanding(**copy);
    } else {
      changed = true;
      search.addStanding(*object, takeOver());
    }
  }
}

void Obstacles::Impl::findForSpheres(const std::vector<RigidState>& states, btScalar margin) {
  known_shapes.forgetLost(host);
  found.clear();
  regions.clear();
  for (const Ball& ball : balls) {
    const btVector3 p = toBullet(states[static_cast<std::size_t>(ball.index)].p_W);
    regions.push_back(growRegion({p, p}, ball.radius + margin));
    findStaticObjects(host, regions.back(), found);
  }
  dropHeld();
  sortAsAdded(found);
  next_near_spheres.clear();
  for (const btCollisionObject* object : found) {
    int part = 0;
    appendObstacles(*object, *object->getCollisionShape(), object->getWorldTransform(), regions,
                    known_shapes, part, next_near_spheres);
  }
  noteChanges(near_spheres, next_near_spheres);
  has_next = true;
}

}  // namespace tandem
