#include "surroundings/neighbours.h"

#include <algorithm>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "tandem/bullet_bridge/convert.h"

#include "arms/arm_constraint.h"
#include "arms/arm_model.h"
#include "arms/arm_watch.h"
#include "bodies/body_look.h"
#include "bodies/filter_of.h"
#include "surroundings/obstacle_search.h"
#include "surroundings/regions.h"
#include "world/world_lookup.h"

namespace tandem {
namespace {

/// A body joins before it can be touched. The distance D covers the motion of two bodies until the
/// host's next step: a shape margin, an acceleration of twice gravity, and 1.5 times their speed.
constexpr double kMargin = 2e-3;        // [m]
constexpr double kAcceleration = 20.0;  // [m/s^2]
constexpr double kSafety = 1.5;
/// Held bodies stay up to this many D, so that they do not join and leave alternately.
constexpr double kHysteresis = 1.5;
/// A faster body that approaches a body at rest is found later than D promises [m/s].
constexpr double kFastestComer = 3.0;

double computeDistance(double speed, double horizon) {
  return kMargin + 0.5 * kAcceleration * horizon * horizon + kSafety * speed * horizon;
}

double computeGap(const NeighbourSeed& a, const NeighbourSeed& b) {
  const Vec3 apart = (a.low_W - b.high_W).cwiseMax(b.low_W - a.high_W).cwiseMax(0.0);
  return apart.norm();
}

NeighbourSeed makeSeed(const btCollisionObject& object, const Vec3& v_W) {
  const Region box = computeRegion(*object.getCollisionShape(), object.getWorldTransform());
  return {fromBullet(box.low), fromBullet(box.high), v_W, {}};
}

NeighbourSeed makeSeed(const btRigidBody& body) {
  return makeSeed(body, fromBullet(body.getLinearVelocity()));
}

/// Highest speed of a point of the body from its rotation [m/s].
double computeTurningSpeed(const Vec3& w_W, const NeighbourSeed& seed) {
  return w_W.norm() * 0.5 * (seed.high_W - seed.low_W).norm();
}

template <typename Visit>
class Visitor final : public btBroadphaseAabbCallback {
 public:
  explicit Visitor(Visit visit) : visit_(visit) {}
  bool process(const btBroadphaseProxy* proxy) override {
    visit_(static_cast<btCollisionObject*>(proxy->m_clientObject));
    return true;
  }

 private:
  Visit visit_;
};

/// The search only looks at what it is not asked to take.
Jointed asJointed(const btRigidBody& body) { return {const_cast<btRigidBody*>(&body), nullptr}; }

template <typename Body>
bool contains(const std::vector<Body*>& bodies, const Body* body) {
  return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
}

}  // namespace

NeighbourSearch::NeighbourSearch(btDiscreteDynamicsWorld& host, std::size_t capacity,
                                 const MovedFrames* moved)
    : host_(host), arms_host_(asMultiBodyWorld(host)), capacity_(capacity), joints_(host, moved) {}

NeighbourSearch::NeighbourSearch(btDiscreteDynamicsWorld& host, std::size_t capacity)
    : NeighbourSearch(host, capacity, nullptr) {}

const std::vector<btRigidBody*>& NeighbourSearch::find(const std::vector<NeighbourSeed>& seeds,
                                                       double horizon) {
  held_.swap(found_);
  held_arms_.swap(found_arms_);
  found_.clear();
  found_arms_.clear();
  arms_.clear();
  taken_ = 0;
  listTies();
  joints_.look(ties_, [&](const btRigidBody& body) { return isExcluded(body) || mayBeHeld(body); });
  wave_ = seeds;
  takeChainsOfExcluded();
  while (!wave_.empty() && taken_ < capacity_) {
    candidates_.clear();
    for (const NeighbourSeed& seed : wave_) findAround(seed, horizon);
    wave_.clear();
    takeNearest();
  }
  return found_;
}

/// Constraints of multi-bodies with others, or with rigid bodies.
void NeighbourSearch::listTies() {
  ties_.clear();
  const int count = arms_host_ ? arms_host_->getNumMultiBodyConstraints() : 0;
  for (int i = 0; i < count; ++i) {
    btMultiBodyConstraint& constraint = *arms_host_->getMultiBodyConstraint(i);
    const ArmConstraintKind kind = findKind(constraint);
    if (!isTie(kind) && kind != ArmConstraintKind::kGear) continue;
    const auto [a, b] = findEnds(constraint);
    const auto isFixed = [](const ArmConstraintEnd& end) {
      return !end.rigid && (!end.arm || isGround(*end.arm, end.link));
    };
    if (a.arm == b.arm || isFixed(a) || isFixed(b)) continue;
    ties_.push_back({{a.rigid, a.arm}, {b.rigid, b.arm}});
  }
}

template <typename Visit>
void NeighbourSearch::visitChainOf(const Jointed& of, Visit visit) const {
  if (of.body)
    joints_.visitChainOf(*of.body, visit);
  else
    joints_.visitChainOf(*of.arm, visit);
}

/// Calls `take(body, gap)` for each body that is near the seed and not found yet.
template <typename Take>
void NeighbourSearch::visitNear(const NeighbourSeed& seed, double horizon, Take take) const {
  const double widest = kHysteresis * computeDistance(seed.v_W.norm() + kFastestComer, horizon);
  const Vec3 skin = Vec3::Constant(widest);
  Visitor visitor([&](btCollisionObject* object) {
    if (isFound(*object) || !mayBeFound(*object)) return;
    if (seed.filter && !seed.filter->meets(filterOf(*object))) return;
    const RigidState now = readVelocities(*object);
    const NeighbourSeed other = makeSeed(*object, now.v_W);
    const double speed = (seed.v_W - other.v_W).norm() + computeTurningSpeed(now.w_W, other);
    const double gap = computeGap(seed, other);
    const double stay = wasHeld(*object) ? kHysteresis : 1.0;
    if (gap < stay * computeDistance(speed, horizon)) take(*object, gap);
  });
  host_.getBroadphase()->aabbTest(toBullet(Vec3(seed.low_W - skin)),
                                  toBullet(Vec3(seed.high_W + skin)), visitor);
}

void NeighbourSearch::findAround(const NeighbourSeed& seed, double horizon) {
  visitNear(seed, horizon, [&](btCollisionObject& object, double gap) {
    candidates_.push_back({&object, gap});
  });
}

bool NeighbourSearch::isAnythingComing(const NeighbourSeed& seed, double horizon) const {
  if (taken_ == capacity_) return false;
  bool comes = false;
  visitNear(seed, horizon, [&](const btCollisionObject&, double) { comes = true; });
  return comes;
}

bool NeighbourSearch::leavesJointsOf(const btRigidBody& body) const {
  bool leaves = joints_.isJointed(body) && !joints_.mayHoldChainOf(body);
  joints_.visitChainOf(body, [&](const Jointed& mate) { leaves |= !isTaken(mate); });
  return leaves;
}

bool NeighbourSearch::isStranger(const btCollisionObject& object) const {
  if (object.isStaticObject() || !object.hasContactResponse() || isObstacle(object)) return false;
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (const btMultiBody* arm = multiBodyOf(object))
    return !isGround(object) && !contains(found_arms_, arm);
  if (body == nullptr) return false;
  return !contains(found_, body) && !isExcluded(*body);
}

bool NeighbourSearch::isStrangerNear(const btRigidBody& body, double horizon) const {
  const NeighbourSeed seed = makeSeed(body);
  const Vec3 skin = Vec3::Constant(computeDistance(seed.v_W.norm() + kFastestComer, horizon));
  bool is_near = false;
  Visitor visitor([&](btCollisionObject* object) {
    if (is_near || !isStranger(*object)) return;
    const btVector3 v = object->getInterpolationLinearVelocity();
    const Region box = computeRegion(*object->getCollisionShape(), object->getWorldTransform());
    const NeighbourSeed other{fromBullet(box.low), fromBullet(box.high), fromBullet(v), {}};
    const double speed = (seed.v_W - other.v_W).norm();
    is_near = computeGap(seed, other) < computeDistance(speed, horizon);
  });
  host_.getBroadphase()->aabbTest(toBullet(Vec3(seed.low_W - skin)),
                                  toBullet(Vec3(seed.high_W + skin)), visitor);
  return is_near;
}

/// Makes the next wave: each candidate once, nearest first. Ties follow the order in which the host
/// added them.
void NeighbourSearch::takeNearest() {
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    if (a.gap != b.gap) return a.gap < b.gap;
    return a.object->getWorldArrayIndex() < b.object->getWorldArrayIndex();
  });
  for (const Candidate& candidate : candidates_) {
    if (taken_ == capacity_) return;
    if (isFound(*candidate.object)) continue;
    takeWithChain({btRigidBody::upcast(candidate.object), multiBodyOf(*candidate.object)});
  }
}

/// Nothing if its whole chain does not fit.
void NeighbourSearch::takeWithChain(const Jointed& of) {
  if (!hasRoomFor(of)) return;
  take(of);
  visitChainOf(of, [&](const Jointed& mate) { take(mate); });
}

void NeighbourSearch::take(const Jointed& of) {
  if (isTaken(of)) return;
  if (of.body)
    takeBody(*of.body);
  else
    takeArm(lookUpArm(*of.arm));
}

void NeighbourSearch::takeBody(btRigidBody& body) {
  found_.push_back(&body);
  ++taken_;
  // A kinematic body passes no push on.
  if (!body.isKinematicObject()) wave_.push_back(makeSeed(body));
}

bool NeighbourSearch::isTaken(const Jointed& of) const {
  return of.body ? contains(found_, of.body) || isExcluded(*of.body)
                 : contains(found_arms_, of.arm);
}

/// All links pass a push on.
void NeighbourSearch::takeArm(const Arm& arm) {
  found_arms_.push_back(arm.body);
  taken_ += arm.places;
  for (int link = -1; link < arm.body->getNumLinks(); ++link) {
    const btCollisionObject* collider =
        link < 0 ? arm.body->getBaseCollider() : arm.body->getLinkCollider(link);
    if (collider && !isGround(*collider) && collider->hasContactResponse())
      wave_.push_back(makeSeed(*collider, readVelocities(*collider).v_W));
  }
}

/// Null: the object is no link of a multi-body that the island could hold.
const NeighbourSearch::Arm* NeighbourSearch::findArm(const btCollisionObject& object) const {
  btMultiBody* body = multiBodyOf(object);
  if (body == nullptr || arms_host_ == nullptr) return nullptr;
  const Arm& arm = lookUpArm(*body);
  return arm.places > 0 ? &arm : nullptr;
}

/// Reads a multi-body once per find().
NeighbourSearch::Arm& NeighbourSearch::lookUpArm(btMultiBody& body) const {
  auto known =
      std::find_if(arms_.begin(), arms_.end(), [&](const Arm& arm) { return arm.body == &body; });
  if (known == arms_.end()) known = arms_.insert(known, readArm(body));
  return *known;
}

NeighbourSearch::Arm NeighbourSearch::readArm(btMultiBody& body) const {
  Arm arm{&body};
  arm.why_not = findObstacleToHold(*arms_host_, body);
  if (arm.why_not) return arm;
  const ArmModel model(body);
  const std::size_t places = model.countBodies();
  arm.moves = places > 0;
  if (places > capacity_) return arm;
  arm.places = places;
  ArmCoordinates coordinates;
  ArmModel::read(body, coordinates);
  arm.states.resize(model.size());
  model.findLinks(coordinates, arm.states);
  return arm;
}

void NeighbourSearch::explainArms(std::vector<std::string>& lines) const {
  // Compares addresses only: the host may have deleted them.
  for (const Arm& arm : arms_) {
    if (contains(found_arms_, arm.body) || !arm.moves || !arm.is_near) continue;
    const char* why = arm.why_not ? arm.why_not : "its links have no room; raise max_neighbours";
    lines.push_back(std::string("a multi-body nearby stays Bullet's, at the host's rate: ") + why);
  }
}

/// Velocities of a rigid body, or of a link with this collider.
RigidState NeighbourSearch::readVelocities(const btCollisionObject& object) const {
  if (const Arm* arm = findArm(object)) {
    const int link = static_cast<const btMultiBodyLinkCollider&>(object).m_link;
    return arm->states[static_cast<std::size_t>(link + 1)];
  }
  RigidState now;
  if (const btRigidBody* body = btRigidBody::upcast(&object)) {
    now.v_W = fromBullet(body->getLinearVelocity());
    now.w_W = fromBullet(body->getAngularVelocity());
  }
  return now;
}

bool NeighbourSearch::isFound(const btCollisionObject& object) const {
  if (const btRigidBody* body = btRigidBody::upcast(&object)) return contains(found_, body);
  return contains(found_arms_, multiBodyOf(object));
}

bool NeighbourSearch::wasHeld(const btCollisionObject& object) const {
  if (const btRigidBody* body = btRigidBody::upcast(&object)) return contains(held_, body);
  return contains(held_arms_, multiBodyOf(object));
}

bool NeighbourSearch::mayBeFound(const btCollisionObject& object) const {
  if (const btRigidBody* body = btRigidBody::upcast(&object)) return mayBeNeighbour(*body);
  btMultiBody* body = multiBodyOf(object);
  if (!body || !arms_host_ || !object.hasContactResponse() || isGround(object)) return false;
  Arm& arm = lookUpArm(*body);
  arm.is_near = true;
  if (arm.places == 0) return false;
  if (!joints_.isJointed(*body) || mayHoldChainOf({nullptr, body})) return true;
  // The chain may have brought other arms into the list.
  lookUpArm(*body).why_not = "what its constraints connect it with cannot be held";
  return false;
}

/// The island holds their bodies whatever is near: they need their joints.
void NeighbourSearch::takeChainsOfExcluded() {
  for (const btRigidBody* excluded : excluded_) {
    const Jointed of = asJointed(*excluded);
    if (mayHoldChainOf(of)) takeWithChain(of);
  }
}

/// True if the island could hold all of the chain of what is in joints.
bool NeighbourSearch::mayHoldChainOf(const Jointed& of) const {
  bool may_hold = of.body ? joints_.mayHoldChainOf(*of.body) : joints_.mayHoldChainOf(*of.arm);
  visitChainOf(of, [&](const Jointed& mate) {
    may_hold = may_hold && (mate.body || lookUpArm(*mate.arm).places > 0);
  });
  return may_hold;
}

/// True if the rest of its chain fits, too.
bool NeighbourSearch::hasRoomFor(const Jointed& of) const {
  std::size_t count = countPlaces(of);
  visitChainOf(of, [&](const Jointed& mate) {
    if (!(mate == of)) count += countPlaces(mate);
  });
  return taken_ + count <= capacity_;
}

std::size_t NeighbourSearch::countPlaces(const Jointed& of) const {
  if (isTaken(of)) return 0;
  return of.body ? 1 : lookUpArm(*of.arm).places;
}

bool NeighbourSearch::isExcluded(const btRigidBody& body) const {
  return std::binary_search(excluded_.begin(), excluded_.end(), &body);
}

bool NeighbourSearch::isAnythingDriven() const {
  const btCollisionObjectArray& objects = host_.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i)
    if (objects[i]->isKinematicObject() && objects[i]->isActive()) return true;
  return false;
}

bool NeighbourSearch::mayBeNeighbour(const btRigidBody& body) const {
  if (!body.hasContactResponse() || isExcluded(body)) return false;
  if (body.isKinematicObject())
    return body.getCollisionShape()->getShapeType() != STATIC_PLANE_PROXYTYPE;
  return mayBeHeld(body) && (!joints_.isJointed(body) || mayHoldChainOf(asJointed(body)));
}

/// True if the island could hold a moving body, but for its joints. A body in a joint may have left
/// the world.
bool NeighbourSearch::mayBeHeld(const btRigidBody& body) const {
  return findInWorld(host_, &body, body.getWorldArrayIndex()) >= 0 && isMovedByForces(body) &&
         hasPlainSurface(body) && hasPlainShape(body);
}

}  // namespace tandem
