#include "surroundings/contact_search.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem {
namespace {

constexpr int kManifolds = 512;

btDefaultCollisionConstructionInfo makePools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = kManifolds;
  info.m_defaultMaxCollisionAlgorithmPoolSize = kManifolds;
  return info;
}

}  // namespace

ContactSearch::ContactSearch(double min_bounce_speed)
    : configuration_(makePools()), dispatcher_(&configuration_), work_(dispatcher_) {
  work_.min_bounce_speed = min_bounce_speed;
  // A body lying flat gets all its corners at once. Otherwise it gains one per step and rocks.
  configuration_.setPlaneConvexMultipointIterations(8, 4);
}

ContactSearch::~ContactSearch() {
  for (ContactPair& pair : book_.pairs) pair.release(dispatcher_);
}

void ContactSearch::setOrigin(const Vec3& origin_W, const std::vector<RigidState>& states) {
  wanted_origin_W_ = origin_W;
  moved_states_ = states;
}

bool ContactSearch::placeStanding(PrivateCopy& copy) {
  if (!hasMoved(copy)) return false;
  placings_.push_back({&copy, copy.findOriginal(wanted_origin_W_)});
  return true;
}

ContactSearch::Combiners ContactSearch::Combiners::now() noexcept {
  return {{gCalculateCombinedFrictionCallback, gCalculateCombinedRestitutionCallback,
           gCalculateCombinedRollingFrictionCallback, gCalculateCombinedSpinningFrictionCallback}};
}

void ContactSearch::addPair(PrivateCopy& a, PrivateCopy& b) {
  Neighbours link{&a, &b, Material::of(*a.original, *b.original), {}};
  for (const PrivateCopy* copy : {&a, &b})
    for (const Part& part : copy->parts)
      if (part.host_mesh) link.meshes.push_back({&part, copy == &a, {}});
  links_.push_back(std::move(link));
}

bool ContactSearch::showSurfaces() {
  const Combiners combiners = Combiners::now();
  const bool is_all_new = !(combiners == combiners_);
  combiners_ = combiners;
  bool is_any_new = is_all_new;
  for (const auto* copies : {&bodies_, &standing_}) {
    for (const auto& copy : *copies) {
      const Surface surface = Surface::of(*copy->original);
      copy->is_new_surface = !(surface == copy->surface);
      copy->surface = surface;
      is_any_new |= copy->is_new_surface;
    }
  }
  if (!is_any_new) return false;
  bool has_changed = false;
  for (Neighbours& link : links_) {
    if (!is_all_new && !link.a->is_new_surface && !link.b->is_new_surface) continue;
    const Material now = Material::of(*link.a->original, *link.b->original);
    if (now == link.material) continue;
    link.material = now;
    link.is_new_material = has_news_ = has_changed = true;
  }
  return has_changed;
}

btTransform ContactSearch::findPose(const PrivateCopy& copy,
                                    const std::vector<RigidState>& states) const {
  if (copy.index == kStanding) return copy.original->getWorldTransform();
  const RigidState& state = states[static_cast<std::size_t>(copy.index)];
  return toBullet(state.p_W, state.q_WB);
}

void ContactSearch::gatherTriangles(const std::vector<RigidState>& states, btScalar margin) {
  for (Neighbours& link : links_) {
    for (MeshNear& near : link.meshes) {
      const PrivateCopy& its = near.is_of_a ? *link.a : *link.b;
      const PrivateCopy& other = near.is_of_a ? *link.b : *link.a;
      const btTransform pose = findPose(its, states);
      const Region box = moveRegion(other.look.bounds, findPose(other, states));
      if (contains(near.covered, findRegionInMesh(*near.mesh, pose, box, margin))) continue;
      near.fresh.gather(*near.mesh->host_mesh,
                        findRegionInMesh(*near.mesh, pose, box, btScalar(2) * margin));
      near.covered = near.fresh.gathered();
      near.is_fresh = has_news_ = true;
    }
  }
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
    draft_.pairs.emplace_back(*links_[i].a, *links_[i].b, links_[i].material);
    // A pair of the present book brings its parts along.
    if (links_[i].place == kNowhere) draft_.pairs.back().fill();
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
        draft_.pairs[i].goOnWith(book_.pairs[place]);
        if (draft_.pairs[i].near) draft_.near.push_back(i);
      }
      place = i;
    }
    for (ContactPair& pair : book_.pairs) pair.release(dispatcher_);
    std::swap(book_, draft_);
  }
  if (has_news_)
    for (Neighbours& link : links_) commit(link);
  has_news_ = false;
  work_.origin_W = wanted_origin_W_;
  for (const Placing& placing : placings_) placing.copy->place(placing.pose);
  placings_.clear();
  if (moved_states_.empty()) return;
  for (const auto& body : bodies_)
    place(body->index, moved_states_[static_cast<std::size_t>(body->index)]);
  moved_states_.clear();
}

void ContactSearch::commit(Neighbours& link) noexcept {
  ContactPair& pair = book_.pairs[link.place];
  if (link.is_new_material) pair.material = link.material;
  link.is_new_material = false;
  for (std::size_t i = 0; i < link.meshes.size(); ++i) {
    if (!link.meshes[i].is_fresh) continue;
    std::swap(pair.meshes[i].run, link.meshes[i].fresh);
    link.meshes[i].is_fresh = false;
  }
}

void ContactSearch::place(BodyIndex body, const RigidState& state) noexcept {
  PrivateCopy& copy = *book_.copy_of[static_cast<std::size_t>(body)];
  const Vec3 p = state.p_W - work_.origin_W;
  if (p == copy.p_placed && state.q_WB.coeffs() == copy.q_placed.coeffs()) return;
  copy.place(p, state.q_WB);
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
      ContactPair& pair = book_.pairs[i];
      const auto a = static_cast<std::size_t>(pair.a->index);
      const auto b = pair.b->index != kStanding ? static_cast<std::size_t>(pair.b->index) : a;
      if (pair.near || reach[a] < 0.0 || reach[b] < 0.0) return;
      if (!pair.overlaps(grown(*pair.a), grown(*pair.b))) return;
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
    if (!book_.pairs[i].near) book_.pairs[i].release(dispatcher_);
  for (const std::size_t i : book_.near) {
    const auto reach_of = [&](const PrivateCopy& copy) {
      return copy.index == kStanding ? 0.0 : reach[static_cast<std::size_t>(copy.index)];
    };
    ContactPair& pair = book_.pairs[i];
    pair.lookCloser(work_, static_cast<btScalar>(reach_of(*pair.a) + reach_of(*pair.b)));
  }
}

void ContactSearch::find(const std::vector<RigidState>& states,
                         std::vector<RigidContact>& contacts) noexcept {
  for (const BodyIndex body : book_.awake) place(body, states[static_cast<std::size_t>(body)]);
  work_.contacts = &contacts;
  for (const std::size_t i : book_.near) {
    ContactPair& pair = book_.pairs[i];
    if (!pair.overlaps(pair.a->bounds, pair.b->bounds)) continue;
    const bool has_asked = pair.search(work_);
    ++(has_asked ? searches_ : frozen_searches_);
  }
}

}  // namespace tandem
