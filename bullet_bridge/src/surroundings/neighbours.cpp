#include "surroundings/neighbours.h"

#include <algorithm>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "bodies/body_look.h"
#include "bodies/filter_of.h"
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

NeighbourSeed makeSeed(const btRigidBody& body) {
  const Region box = computeRegion(*body.getCollisionShape(), body.getWorldTransform());
  return {fromBullet(box.low), fromBullet(box.high), fromBullet(body.getLinearVelocity()), {}};
}

/// Highest speed of a point of the body from its rotation [m/s].
double computeTurningSpeed(const btRigidBody& body, const NeighbourSeed& seed) {
  return fromBullet(body.getAngularVelocity()).norm() * 0.5 * (seed.high_W - seed.low_W).norm();
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

/// True if the island knows all laws of the body's contact. Others stay Bullet's.
bool hasPlainContact(const btRigidBody& body) {
  return !body.hasAnisotropicFriction(btCollisionObject::CF_ANISOTROPIC_FRICTION |
                                      btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION) &&
         (body.getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) == 0;
}

template <typename Body>
bool contains(const std::vector<Body*>& bodies, const btRigidBody* body) {
  return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
}

}  // namespace

NeighbourSearch::NeighbourSearch(btDiscreteDynamicsWorld& host, std::size_t capacity)
    : host_(host), capacity_(capacity), joints_(host) {}

const std::vector<btRigidBody*>& NeighbourSearch::find(const std::vector<NeighbourSeed>& seeds,
                                                       double horizon) {
  held_.swap(found_);
  found_.clear();
  joints_.look([&](const btRigidBody& body) { return isExcluded(body) || mayBeHeld(body); });
  wave_ = seeds;
  takeChainsOfExcluded();
  while (!wave_.empty() && found_.size() < capacity_) {
    candidates_.clear();
    for (const NeighbourSeed& seed : wave_) findAround(seed, horizon);
    wave_.clear();
    takeNearest();
  }
  return found_;
}

/// Calls `take(body, gap)` for each body that is near the seed and not found yet.
template <typename Take>
void NeighbourSearch::visitNear(const NeighbourSeed& seed, double horizon, Take take) const {
  const double widest = kHysteresis * computeDistance(seed.v_W.norm() + kFastestComer, horizon);
  const Vec3 skin = Vec3::Constant(widest);
  Visitor visitor([&](btCollisionObject* object) {
    btRigidBody* body = btRigidBody::upcast(object);
    if (body == nullptr || !mayBeNeighbour(*body) || contains(found_, body)) return;
    if (seed.filter && !seed.filter->meets(filterOf(*body))) return;
    const NeighbourSeed other = makeSeed(*body);
    const double speed = (seed.v_W - other.v_W).norm() + computeTurningSpeed(*body, other);
    const double gap = computeGap(seed, other);
    const double stay = contains(held_, body) ? kHysteresis : 1.0;
    if (gap < stay * computeDistance(speed, horizon)) take(*body, gap);
  });
  host_.getBroadphase()->aabbTest(toBullet(Vec3(seed.low_W - skin)),
                                  toBullet(Vec3(seed.high_W + skin)), visitor);
}

void NeighbourSearch::findAround(const NeighbourSeed& seed, double horizon) {
  visitNear(seed, horizon, [&](btRigidBody& body, double gap) {
    candidates_.push_back({&body, gap});
  });
}

bool NeighbourSearch::isAnythingComing(const NeighbourSeed& seed, double horizon) const {
  if (found_.size() == capacity_) return false;
  bool comes = false;
  visitNear(seed, horizon, [&](const btRigidBody&, double) { comes = true; });
  return comes;
}

bool NeighbourSearch::leavesJointsOf(const btRigidBody& body) const {
  bool leaves = joints_.isJointed(body) && !joints_.mayHoldChainOf(body);
  joints_.visitChainOf(body, [&](const btRigidBody& mate) {
    leaves |= !contains(found_, &mate) && !isExcluded(mate);
  });
  return leaves;
}

bool NeighbourSearch::isStranger(const btCollisionObject& object) const {
  if (object.isStaticObject() || !object.hasContactResponse()) return false;
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (body == nullptr) return object.getInternalType() == btCollisionObject::CO_FEATHERSTONE_LINK;
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
    return a.body->getWorldArrayIndex() < b.body->getWorldArrayIndex();
  });
  for (const Candidate& candidate : candidates_) {
    if (found_.size() == capacity_) return;
    if (contains(found_, candidate.body) || !hasRoomFor(*candidate.body)) continue;
    take(*candidate.body);
    joints_.visitChainOf(*candidate.body, [&](btRigidBody& body) {
      if (!contains(found_, &body) && !isExcluded(body)) take(body);
    });
  }
}

void NeighbourSearch::take(btRigidBody& body) {
  found_.push_back(&body);
  // A kinematic body passes no push on.
  if (!body.isKinematicObject()) wave_.push_back(makeSeed(body));
}

/// The island holds their bodies whatever is near: they need their joints.
void NeighbourSearch::takeChainsOfExcluded() {
  for (const btRigidBody* excluded : excluded_) {
    if (!joints_.mayHoldChainOf(*excluded) || !hasRoomFor(*excluded)) continue;
    joints_.visitChainOf(*excluded, [&](btRigidBody& body) {
      if (!contains(found_, &body) && !isExcluded(body)) take(body);
    });
  }
}

/// True if the rest of its chain fits, too.
bool NeighbourSearch::hasRoomFor(const btRigidBody& body) const {
  std::size_t count = isExcluded(body) || joints_.isJointed(body) ? 0 : 1;
  joints_.visitChainOf(body, [&](const btRigidBody& mate) {
    if (!contains(found_, &mate) && !isExcluded(mate)) ++count;
  });
  return found_.size() + count <= capacity_;
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
  return mayBeHeld(body) && (!joints_.isJointed(body) || joints_.mayHoldChainOf(body));
}

/// True if the island could hold a moving body, but for its joints.
bool NeighbourSearch::mayBeHeld(const btRigidBody& body) const {
  const btCollisionShape& shape = *body.getCollisionShape();
  return isMovedByForces(body) && hasPlainContact(body) && (shape.isConvex() || shape.isCompound());
}

}  // namespace tandem
