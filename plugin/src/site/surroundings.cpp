#include "site/surroundings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_bridge/src/shapes/parts_look.h"
#include "bullet_bridge/src/surroundings/host_pairs.h"

// Runs in the host's thread: searches for what is near and promotes neighbours.
// neighbours_coming.cpp applies the results where the ticks run.

namespace tandem {
namespace {

/// Greatest lateness of the host, in periods of its own.
constexpr double kLatePeriods = 2.5;
/// Margin of the search for obstacles, in addition to the motion of bodies [m].
constexpr double kStandingMargin = 0.04;
constexpr double kSafety = 1.5;

/// More points of a host step are not shown.
constexpr std::size_t kMostShownContacts = 1024;

/// Parked bodies with nothing awake near them are searched around once in this many looks.
constexpr int kLooksToFull = 8;

NeighbourSeed makeSphereSeed(const RigidState& state, double radius) {
  const Vec3 half = Vec3::Constant(radius);
  return {state.p_W - half, state.p_W + half, state.v_W, {}};
}

}  // namespace

Surroundings::Surroundings(btDiscreteDynamicsWorld& world, const SiteSettings& settings,
                           Island& island, Timeline& timeline, const HostClock& clock,
                           Bodies& bodies, Peers& peers, LocalHand& hand, HostForces& forces,
                           SiteLog& log)
    : world_(world),
      settings_(settings),
      island_(island),
      timeline_(timeline),
      clock_(clock),
      bodies_(bodies),
      peers_(peers),
      hand_(hand),
      forces_(forces),
      log_(log),
      obstacles_(world),
      away_(world),
      moved_frames_(world),
      search_(world, static_cast<std::size_t>(settings.max_neighbours), &moved_frames_),
      joints_(world, moved_frames_) {}

void Surroundings::addSlots(int count) {
  neighbours_.resize(static_cast<std::size_t>(count));
  for (Neighbour& neighbour : neighbours_) neighbour.body.index = island_.addSlot();
}

void Surroundings::makeRoom() {
  const auto count = static_cast<std::size_t>(island_.bodyCount());
  mirror_.states.resize(count);
  mirror_.moves.resize(count);
  still_.resize(count);
  contacts_.reserve(kMostShownContacts);
  from_states_.resize(count);
  to_states_.resize(count);
  asides_.resize(count);
  newcomers_.reserve(neighbours_.size() + bodies_.objects.size());
  leaving_.reserve(neighbours_.size());
  for (Neighbour& neighbour : neighbours_) neighbour.body.load.makeRoom();
}

int Surroundings::neighbourCount() const noexcept {
  const auto is_filled = [](const Neighbour& neighbour) { return !neighbour.isEmpty(); };
  return static_cast<int>(std::count_if(neighbours_.begin(), neighbours_.end(), is_filled));
}

void Surroundings::findMissing() {
  restoreReturned();
  for (Neighbour& neighbour : neighbours_) {
    if (neighbour.isEmpty() || neighbour.body.is_leaving) continue;
    const bool is_dragged = neighbour.rigid && isDragged(*neighbour.rigid);
    if (neighbour.isInWorld() && !neighbour.hasChanged() && !is_dragged) continue;
    if (neighbour.link) {
      leaveArm(neighbour.link->arm());
      continue;
    }
    neighbour.body.step.forgetReaction();
    leave(neighbour);
  }
  joints_.findGone();
}

void Surroundings::look(double dt, double step_end, double age, bool everywhere) {
  if (settings_.guide) return;
  if (!everywhere) everywhere = isTurnOfFullLook();
  horizon_ = computeHorizon(dt) + age;
  lookForNeighbours(horizon_, step_end, everywhere);
  if (settings_.injection == Injection::kHandoff) lookForJoints();
  // Springs stretched at the last look may move a body farther than its speed does.
  const double way = kSafety * spring_speed_ * horizon_;
  way_by_springs_ = way > kStandingMargin ? way : 0.0;
  searchObstacles(everywhere);
}

void Surroundings::explain(std::vector<std::string>& lines) const {
  search_.explainArms(lines);
  if (settings_.injection == Injection::kHandoff && hasOwnNearCallback(world_))
    lines.emplace_back(
        "the host's near callback decides on contact: contact of all bodies stays Bullet's, at the "
        "host's rate; use groups, masks, an overlap filter callback or needsCollision() of a "
        "dispatcher class instead");
}

void Surroundings::shiftOrigin(const Vec3& offset_W) noexcept {
  obstacles_.shiftOrigin(offset_W);
  moved_frames_.forget();
  for (RigidState& state : mirror_.states) state.p_W += offset_W;
  for (Neighbour& neighbour : neighbours_) neighbour.shiftOrigin(offset_W);
}

double Surroundings::computeHorizon(double dt) const noexcept {
  return kLatePeriods * dt + settings_.host_stall;
}

bool Surroundings::isTurnOfFullLook() noexcept {
  const bool is_turn = looks_to_full_ == 0;
  looks_to_full_ = is_turn ? kLooksToFull - 1 : looks_to_full_ - 1;
  return is_turn;
}

bool Surroundings::mustLookFarther() const noexcept {
  return kSafety * spring_speed_ * horizon_ > std::max(kStandingMargin, way_by_springs_);
}

void Surroundings::lookFarther() {
  way_by_springs_ = kSafety * spring_speed_ * horizon_;
  searchObstacles(true);
  has_more_ = true;
}

void Surroundings::searchObstacles(bool everywhere) {
  const double margin = kStandingMargin + kSafety * mirror_.computeSpeed() * horizon_ +
                        way_by_springs_ + mirror_.depth;
  has_changed_ |= obstacles_.search(mirror_.states, margin, everywhere ? nullptr : &mirror_.moves);
}

bool Surroundings::isHandAlone() const noexcept {
  return bodies_.objects.empty() && peers_.isEmpty();
}

bool Surroundings::takesNeighbours() const noexcept {
  return !neighbours_.empty() && holds_neighbours_ &&
         (settings_.hand_feels_moving_bodies || !isHandAlone());
}

bool Surroundings::isAnythingDriven() const {
  // A kinematic body that comes to a hand alone is noticed by isAnythingComing().
  if (isHandAlone())
    return std::any_of(neighbours_.begin(), neighbours_.end(),
                       [](const Neighbour& neighbour) { return neighbour.driven != nullptr; });
  return search_.isAnythingDriven();
}

bool Surroundings::isAnythingComing() const {
  if (!takesNeighbours()) return false;
  const RigidState& hand = mirror_.states[static_cast<std::size_t>(hand_.hip())];
  return search_.isAnythingComing(makeHandSeed(hand, settings_.hip_radius + mirror_.depth),
                                  horizon_);
}

/// Of the hand or a proxy: bodies that it does not feel are no neighbours of it.
NeighbourSeed Surroundings::makeHandSeed(const RigidState& state, double radius) const {
  NeighbourSeed seed = makeSphereSeed(state, radius);
  seed.filter = {settings_.hand_group, settings_.hand_mask};
  return seed;
}

std::size_t Surroundings::countHapticBodies() const noexcept {
  const auto has_body = [](const Peer& peer) { return peer.proxy.sphere != nullptr; };
  const auto proxies = std::count_if(peers_.begin(), peers_.end(), has_body);
  const auto objects =
      std::count_if(bodies_.objects.begin(), bodies_.objects.end(),
                    [](const SharedObject& object) { return object.body.is_held; });
  return static_cast<std::size_t>(1 + objects + proxies);
}

void Surroundings::collectSeeds(bool everywhere) {
  const auto is_calm = [&](const SiteBody& body) {
    return !everywhere && body.bullet->isParked() && !body.step.was_near_awake;
  };
  const auto state = [&](BodyIndex b) { return mirror_.states[static_cast<std::size_t>(b)]; };
  seeds_.clear();
  seeds_.push_back(makeHandSeed(state(hand_.hip()), settings_.hip_radius + mirror_.depth));
  for (const Peer& peer : peers_)
    if (peer.proxy.sphere && !is_calm(peer.proxy.body))
      seeds_.push_back(
          makeHandSeed(state(peer.proxy.body.index), settings_.proxy.radius + mirror_.depth));
  for (const SharedObject& object : bodies_.objects)
    if (object.body.is_held && !object.body.is_leaving && !is_calm(object.body))
      seeds_.push_back(makeSphereSeed(state(object.body.index), object.bounding_radius));
}

void Surroundings::lookForNeighbours(double horizon, double step_end, bool everywhere) {
  if (!takesNeighbours()) return;
  collectSeeds(everywhere);
  const std::vector<btRigidBody*>& near = search_.find(seeds_, horizon);
  // A partial search may miss a body that is near other bodies of ours.
  const bool is_whole = seeds_.size() == countHapticBodies();
  for (Neighbour& neighbour : neighbours_) {
    if (!is_whole || !neighbour.rigid || neighbour.body.is_leaving) continue;
    if (std::find(near.begin(), near.end(), neighbour.rigid) != near.end()) continue;
    leave(neighbour);
  }
  const std::vector<btMultiBody*>& near_arms = search_.arms();
  for (const auto& arm : arms_)
    if (is_whole && !isLeaving(*arm) &&
        std::find(near_arms.begin(), near_arms.end(), &arm->body()) == near_arms.end())
      leaveArm(*arm);
  for (btRigidBody* rigid : near) {
    const auto holds = [&](const Neighbour& neighbour) { return neighbour.rigid == rigid; };
    if (std::any_of(neighbours_.begin(), neighbours_.end(), holds)) continue;
    if (Neighbour* slot = findEmpty()) promote(*rigid, *slot, step_end);
  }
  for (btMultiBody* body : near_arms) {
    const auto holds = [&](const auto& arm) { return &arm->body() == body; };
    if (std::none_of(arms_.begin(), arms_.end(), holds)) promoteArm(*body);
  }
}

Neighbour* Surroundings::findEmpty() noexcept {
  const auto slot = std::find_if(neighbours_.begin(), neighbours_.end(),
                                 [](const Neighbour& neighbour) { return neighbour.isEmpty(); });
  return slot == neighbours_.end() ? nullptr : &*slot;
}

void Surroundings::lookForJoints() {
  members_.clear();
  for (const auto& arm : arms_) {
    if (isLeaving(*arm)) continue;
    for (const Neighbour& neighbour : neighbours_)
      if (neighbour.link && &neighbour.link->arm() == arm.get())
        members_.push_back({neighbour.link, neighbour.body.index});
  }
  joints_.look([&](const btRigidBody& rigid) { return findHeld(rigid); }, members_);
}

/// The island's body of a btRigidBody, if the island holds it after the next take().
std::optional<BodyIndex> Surroundings::findHeld(const btRigidBody& rigid) const noexcept {
  for (const SharedObject& object : bodies_.objects)
    if (object.rigid == &rigid && (object.body.is_held || object.is_new) && !object.body.is_leaving)
      return object.body.index;
  for (const Neighbour& neighbour : neighbours_)
    if (neighbour.rigid == &rigid && !neighbour.body.is_leaving) return neighbour.body.index;
  return std::nullopt;
}

/// Fills a slot; the island gets the body in takeNewcomers().
void Surroundings::promote(btRigidBody& rigid, Neighbour& neighbour, double step_end) {
  ++log_.counters.promoted;
  const BodyIndex index = neighbour.body.index;
  neighbour.rigid = &rigid;
  neighbour.object = &rigid;
  neighbour.shape = rigid.getCollisionShape();
  neighbour.parts = lookAtParts(*neighbour.shape);
  neighbour.is_new = true;
  neighbour.settings = {};
  setContact(neighbour, rigid);
  if (rigid.isKinematicObject()) {
    neighbour.driven = std::make_unique<DrivenBody>(world_, rigid, step_end);
    neighbour.settings.motion = neighbour.driven->motion();
    neighbour.settings.start = neighbour.driven->at(mirror_.island_time);
  } else {
    hold(rigid, neighbour);
  }
  mirror_.set(index, neighbour.settings.start, true);
  obstacles_.addBody(index, rigid);
  filterProxies(rigid, true, true);
}

void Surroundings::setContact(Neighbour& neighbour, btCollisionObject& collider) {
  const std::optional<Shape> shape = obstacles_.findForm(collider);
  if (shape) neighbour.settings.shape = *shape;
  neighbour.settings.is_rigid = true;
  neighbour.settings.touches_spheres = shape.has_value() && collider.hasContactResponse();
  neighbour.settings.filter = filterOf(collider);
}

/// Fills a slot for each link of a multi-body that moves, if there are enough.
void Surroundings::promoteArm(btMultiBody& body) {
  const auto empty = static_cast<std::size_t>(
      std::count_if(neighbours_.begin(), neighbours_.end(),
                    [](const Neighbour& neighbour) { return neighbour.isEmpty(); }));
  if (ArmModel(body).countBodies() > empty) return;
  arms_.push_back(std::make_unique<HostArm>(world_, body));
  HostArm& arm = *arms_.back();
  arm.remember();
  for (const auto& link : arm.links()) {
    ++log_.counters.promoted;
    Neighbour& neighbour = *findEmpty();
    const BodyIndex index = neighbour.body.index;
    neighbour.link = link.get();
    neighbour.is_new = true;
    neighbour.settings = {};
    neighbour.settings.touches_spheres = false;
    neighbour.settings.mass = link->mass();
    neighbour.settings.inertia_B = link->inertia();
    neighbour.settings.start = link->state();
    neighbour.body.bullet = link.get();
    neighbour.body.step.f_gravity_W = link->gravityForce();
    neighbour.lookAtDamping();
    neighbour.followDamping();
    mirror_.set(index, neighbour.settings.start, true);
    btCollisionObject* collider = link->collider();
    neighbour.object = collider;
    if (!collider) continue;
    setContact(neighbour, *collider);
    if (collider->hasContactResponse()) obstacles_.addBody(index, *collider);
    filterProxies(*collider, true, true);
  }
}

bool Surroundings::isLeaving(const HostArm& arm) const noexcept {
  return std::any_of(neighbours_.begin(), neighbours_.end(), [&](const Neighbour& neighbour) {
    return neighbour.link && &neighbour.link->arm() == &arm && neighbour.body.is_leaving;
  });
}

void Surroundings::leaveArm(const HostArm& arm) {
  const bool is_present = arm.isInWorld();
  for (Neighbour& neighbour : neighbours_) {
    if (!neighbour.link || &neighbour.link->arm() != &arm || neighbour.body.is_leaving) continue;
    if (!is_present) neighbour.body.step.forgetReaction();
    leave(neighbour);
  }
}

void Surroundings::hold(btRigidBody& rigid, Neighbour& neighbour) {
  neighbour.bullet = std::make_unique<HapticBody>(world_, rigid, 1.0, Sleep::kAsHost);
  const HapticBody& bullet = *neighbour.bullet;
  readBody(bullet, neighbour.settings);
  neighbour.lookAtDamping();
  neighbour.followDamping();
  neighbour.body.bullet = neighbour.bullet.get();
  neighbour.body.step.f_gravity_W = bullet.gravityForce();
}

/// Proxies touch a body that the island holds in the island, else in Bullet.
void Surroundings::filterProxies(btCollisionObject& object, bool is_present, bool is_held) {
  for (Peer& peer : peers_) {
    if (!peer.proxy.sphere || !peer.proxy.sphere->isAlive()) continue;
    btRigidBody& proxy = peer.proxy.sphere->rigid();
    if (is_present) {
      filterNativeContact(world_, proxy, object, is_held);
    } else {
      proxy.setIgnoreCollisionCheck(&object, false);
    }
  }
}

/// Marks a neighbour as leaving and gives its contact with proxies back to Bullet.
void Surroundings::leave(Neighbour& neighbour) {
  neighbour.body.is_leaving = has_left_ = true;
  leaving_.push_back(&neighbour);
  if (neighbour.object) filterProxies(*neighbour.object, neighbour.isInWorld(), false);
  obstacles_.removeBody(neighbour.body.index);
  mirror_.set(neighbour.body.index, RigidState{}, false);
}

void Surroundings::leaveAll() {
  for (Neighbour& neighbour : neighbours_) {
    if (neighbour.isEmpty() || neighbour.body.is_leaving) continue;
    leave(neighbour);
  }
}

void Surroundings::releaseBody(BodyIndex index, btRigidBody& rigid, bool is_present) {
  has_left_ = true;
  obstacles_.removeBody(index);
  search_.include(&rigid);
  filterProxies(rigid, is_present, false);
}

void Surroundings::holdBody(BodyIndex index, btRigidBody& rigid, const RigidState& start) {
  search_.exclude(rigid);
  if (settings_.injection == Injection::kHandoff) obstacles_.addBody(index, rigid);
  mirror_.set(index, start, true);
  filterProxies(rigid, true, true);
}

bool Surroundings::isNeighbour(const btRigidBody& rigid) const noexcept {
  return std::any_of(neighbours_.begin(), neighbours_.end(),
                     [&](const Neighbour& neighbour) { return neighbour.rigid == &rigid; });
}

void Surroundings::giveBack() {
  for (Neighbour* neighbour : leaving_) {
    ++log_.counters.demoted;
    if (neighbour->body.bullet && neighbour->isInWorld())
      neighbour->body.bullet->addMomentum(neighbour->owed.linear_W, neighbour->owed.angular_W);
    away_.release(std::move(neighbour->bullet));
    neighbour->becomeEmpty();
  }
  leaving_.clear();
  std::erase_if(arms_, [&](const auto& arm) {
    return std::none_of(neighbours_.begin(), neighbours_.end(), [&](const Neighbour& neighbour) {
      return neighbour.link && &neighbour.link->arm() == arm.get();
    });
  });
}

void Surroundings::lookAtDamping() noexcept {
  for (Neighbour& neighbour : neighbours_)
    if (!neighbour.body.is_leaving) neighbour.lookAtDamping();
}

void Surroundings::lookAtArms(double dt) noexcept {
  for (const auto& arm : arms_)
    if (isActing(*arm)) arm->look(dt);
}

void Surroundings::handOffArms(double dt) noexcept {
  for (const auto& arm : arms_)
    if (isActing(*arm)) arm->handOff(dt);
}

void Surroundings::restoreArms() noexcept {
  for (const auto& arm : arms_)
    if (isActing(*arm)) arm->restore();
}

void Surroundings::placeArms() noexcept {
  for (const auto& arm : arms_)
    if (isActing(*arm)) arm->place();
}

/// True if the island holds the arm, and is not about to give it back.
bool Surroundings::isActing(const HostArm& arm) const noexcept {
  return std::any_of(neighbours_.begin(), neighbours_.end(), [&](const Neighbour& neighbour) {
    return neighbour.link && &neighbour.link->arm() == &arm && neighbour.body.is_held &&
           !neighbour.body.is_leaving;
  });
}

void Surroundings::lookAtDriven(double step_end) noexcept {
  for (Neighbour& neighbour : neighbours_)
    if (neighbour.driven && !neighbour.body.is_leaving) neighbour.driven->look(step_end);
}

void Surroundings::Mirror::set(BodyIndex body, const RigidState& state, bool is_awake) noexcept {
  states[static_cast<std::size_t>(body)] = state;
  moves[static_cast<std::size_t>(body)] = is_awake;
}

double Surroundings::Mirror::computeSpeed() const noexcept {
  double speed = 0.0;
  for (const RigidState& state : states) speed = std::max(speed, state.v_W.norm());
  return speed;
}

}  // namespace tandem
