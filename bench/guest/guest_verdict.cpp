#include "bench/guest/guest_verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_energy.h"
#include "bench/guest/guest_tears.h"

namespace tandem::demos::bench {
namespace {

constexpr double kMeets = 0.3;        // a body nearer than this may touch a far one [m]
constexpr double kReach = 8.0;        // steps over which a site foresees motion
constexpr double kLeastEnergy = 1.0;  // of what penetration and rounding give [J]
constexpr double kMoverEnergy = 2.0;  // that a mover gives to a mass [J/kg]
constexpr double kMostGrowth = 3.0;
constexpr btScalar kAligned = btScalar(1e-3);  // share of a moment of inertia off its axis

/// Fastest point of a body [m/s], as a site may foresee it.
double speedOf(const GuestWorld& world) {
  double fastest = 0.0;
  for (const auto& body : world.bodies())
    fastest = std::max(
        fastest, fromBullet(body->rigid->getLinearVelocity()).norm() +
                     2.0 * body->plan.size * fromBullet(body->rigid->getAngularVelocity()).norm());
  for (const auto& arm : world.arms()) fastest = std::max(fastest, arm->speed());
  return fastest;
}

/// Most that motors and the host do to arms of a world in a frame, at their present speeds [J].
double armWorkOf(const GuestWorld& world) {
  double work = 0.0;
  for (const auto& arm : world.arms()) work += arm->mostWork(world.plan().frame);
  return work;
}

bool isFinite(const btRigidBody& rigid) {
  return fromBullet(rigid.getWorldTransform().getOrigin()).allFinite() &&
         fromBullet(rigid.getLinearVelocity()).allFinite() &&
         fromBullet(rigid.getAngularVelocity()).allFinite() &&
         fromBullet(rigid.getWorldTransform().getBasis()[0]).allFinite();
}

/// Bullet ends its sweeps over all bodies of a batch where the square of no row's change is above
/// 0. Motion whose square is 0 depends on who else is in the batch.
bool isSame(const btVector3& a, const btVector3& b) {
  constexpr btScalar kSweeps = 100;
  static const btScalar most = kSweeps * btSqrt(std::numeric_limits<btScalar>::denorm_min());
  const btVector3 difference = (a - b).absolute();
  return !(difference[difference.maxAxis()] > most);
}

bool isSame(const btRigidBody& a, const btRigidBody& b) {
  const btTransform &pose = a.getWorldTransform(), &other = b.getWorldTransform();
  for (int i = 0; i < 3; ++i)
    if (!isSame(pose.getBasis()[i], other.getBasis()[i])) return false;
  return isSame(pose.getOrigin(), other.getOrigin()) &&
         isSame(a.getLinearVelocity(), b.getLinearVelocity()) &&
         isSame(a.getAngularVelocity(), b.getAngularVelocity());
}

/// True if the factors' axes are not the body's own: Bullet's impulses are not symmetric then.
bool isOblique(const btRigidBody& rigid) {
  const btMatrix3x3& inverse = rigid.getInvInertiaTensorWorld();
  const btVector3& factor = rigid.getAngularFactor();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (factor[i] == factor[j]) continue;
    if (btFabs(inverse[i][j]) > kAligned * btSqrt(inverse[i][i] * inverse[j][j])) return true;
  }
  return false;
}

/// True if its host moves a kinematic body, or any body along axes that its factors lock: what is
/// joined to it gets any energy, in Bullet alone, too.
bool isDriven(const btRigidBody& rigid) {
  constexpr btScalar kSlow = btScalar(0.1), kSlowTurn = 1;  // [m/s], [rad/s]
  const auto alongLocked = [&](const btVector3& speed, const btVector3& factor) {
    btVector3 along(0, 0, 0);
    for (int i = 0; i < 3; ++i)
      if (rigid.isKinematicObject() || factor[i] == 0) along[i] = speed[i];
    return along.length();
  };
  return alongLocked(rigid.getLinearVelocity(), rigid.getLinearFactor()) > kSlow ||
         alongLocked(rigid.getAngularVelocity(), rigid.getAngularFactor()) > kSlowTurn;
}

/// How far a body is in another, in Bullet's eyes [m].
btScalar depthOf(GuestWorld& world, const btRigidBody& rigid) {
  btScalar depth = 0;
  btDispatcher& dispatcher = *world.world().getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getBody0() != &rigid && manifold.getBody1() != &rigid) continue;
    for (int c = 0; c < manifold.getNumContacts(); ++c)
      depth = std::max(depth, -manifold.getContactPoint(c).getDistance());
  }
  return depth;
}

std::string tell(const GuestBody& body) {
  const Vec3 p_W = placeOf(body), v_W = fromBullet(body.rigid->getLinearVelocity());
  return fmt::format("{:.4f} {:.4f} {:.4f}, {:.3g} {:.3g} {:.3g} m/s", p_W.x(), p_W.y(), p_W.z(),
                     v_W.x(), v_W.y(), v_W.z());
}

}  // namespace

GuestVerdict::GuestVerdict(const GuestCase& one, std::vector<std::unique_ptr<GuestSite>>& sites)
    : case_(one), sites_(sites), shaken_(one) {
  allowed_ = kLeastEnergy;
  double mass = 0.0;
  for (const GuestPlan& plan : one.bodies) {
    mass += plan.mass;
    has_mover_ |= plan.role == GuestRole::kMover || plan.role == GuestRole::kCharacter;
  }
  if (has_mover_) allowed_ += kMoverEnergy * mass * one.sites;
  for (const auto& site : sites) {
    allowed_ += energyOf(site->world());
    twins_ += energyOf(site->twin());
    is_met_.emplace_back(one.bodies.size(), char{0});
    has_felt_.push_back(0);
  }
}

void GuestVerdict::beforeActs() {
  before_ = 0.0;
  for (const auto& site : sites_) before_ += energyOf(site->world()) + tearsOf(site->world());
}

void GuestVerdict::afterActs() {
  double after = 0.0, twins = 0.0;
  for (const auto& site : sites_) {
    after += energyOf(site->world()) + tearsOf(site->world());
    twins += energyOf(site->twin());
  }
  allowed_ += std::max(0.0, after - before_);
  allowTwins(twins);
  motors_ = 0.0;
  for (const auto& site : sites_) motors_ += armWorkOf(site->world());
}

/// Adds what the twins gained up to their present energy [J].
void GuestVerdict::allowTwins(double energy) {
  const double more = std::max(0.0, energy - twins_);
  allowed_ += more;
  gained_ += more;
  twins_ = energy;
}

/// The shaken twins, as far as the sites are.
const ShakenTwins& GuestVerdict::askShaken() {
  std::vector<const GuestJournal*> journals;
  for (const auto& site : sites_) journals.push_back(&site->journal());
  shaken_.advance(journals);
  return shaken_;
}

void GuestVerdict::allowArms() {
  double work = 0.0;
  for (const auto& site : sites_) {
    work += armWorkOf(site->world());
    for (const auto& arm : site->world().arms()) arm->forgetPushes();
    for (const auto& arm : site->twin().arms()) diverges_ |= arm->wasTied();
  }
  allowed_ += std::max(work, motors_);
}

std::optional<GuestFinding> GuestVerdict::look() {
  allowArms();
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    GuestSite& site = *sites_[i];
    if (auto found = findNotFinite(site)) return found;
    excuse(site.world());
    excuse(site.twin());
    excuseSunk(site.twin());
    for (const auto& joint : site.twin().joints())
      for (const btRigidBody* end : {&joint->getRigidBodyA(), &joint->getRigidBodyB()})
        diverges_ |= isOblique(*end) || isDriven(*end);
    if (!case_.has_large_margins)
      if (auto found = findFallen(i)) return found;
    if (auto found = findDifferent(i)) return found;
    if (!site.leftOver().empty()) return GuestFinding{GuestFailure::kRestored, site.leftOver()};
  }
  return case_.has_large_margins || diverges_ ? std::nullopt : findEnergy();
}

std::optional<GuestFinding> GuestVerdict::findNotFinite(GuestSite& site) const {
  for (std::size_t b = 0; b < site.world().bodies().size(); ++b)
    if (!isFinite(*site.world().bodies()[b]->rigid) && isFinite(*site.twin().bodies()[b]->rigid))
      return GuestFinding{GuestFailure::kNotFinite, fmt::format("body {} is not finite", b)};
  for (std::size_t a = 0; a < site.world().arms().size(); ++a)
    if (!site.world().arms()[a]->isFinite() && site.twin().arms()[a]->isFinite())
      return GuestFinding{GuestFailure::kNotFinite, fmt::format("arm {} is not finite", a)};
  if (!site.device().isForceSane())
    return GuestFinding{GuestFailure::kNotFinite, "the device got no sane force"};
  if (site.site() && (site.site()->status() & kStateNotFinite))
    return GuestFinding{GuestFailure::kNotFinite, "the island diverged"};
  return std::nullopt;
}

/// A body that passes through another in one step, or is hit by one that does, may fall.
void GuestVerdict::excuse(GuestWorld& world) const {
  for (const auto& body : world.bodies()) {
    const double way = fromBullet(body->rigid->getLinearVelocity()).norm() * case_.step();
    if (!(way > 0.5 * body->plan.size) || !isInArena(*body)) continue;
    for (const auto& other : world.bodies())
      if ((placeOf(*other) - placeOf(*body)).norm() < 0.1 + way) other->may_fall = true;
  }
  for (const auto& arm : world.arms()) {
    const double way = arm->speed() * case_.step();
    for (const Vec3& p_W : arm->places())
      for (const auto& body : world.bodies())
        if (way > 0.5 * body->plan.size && (placeOf(*body) - p_W).norm() < 0.2 + way)
          body->may_fall = true;
  }
}

/// The shortest way out of a floor without thickness may be down, or along it to a seam. And what
/// draws or pushes a body into another floor, such as a joint or a wedge, may move it through.
void GuestVerdict::excuseSunk(GuestWorld& twin) const {
  for (const auto& body : twin.bodies()) {
    btVector3 low, high;
    body->rigid->getAabb(low, high);
    const btVector3 size = high - low;
    body->may_fall |= twin.floorTop() - low.z() > size[size.minAxis()] / 2 ||
                      depthOf(twin, *body->rigid) > static_cast<btScalar>(body->plan.size) / 2;
  }
}

std::optional<GuestFinding> GuestVerdict::findFallen(std::size_t index) {
  GuestSite& site = *sites_[index];
  for (std::size_t b = 0; b < site.world().bodies().size(); ++b) {
    GuestBody &own = *site.world().bodies()[b], &twin = *site.twin().bodies()[b];
    if (own.may_fall || twin.may_fall || !isMoving(own) || !isInArena(own)) continue;
    if (!isBelowAll(site.world(), own) || isBelowAll(site.twin(), twin)) continue;
    own.may_fall = askShaken().hasFallen(index, b);
    if (own.may_fall) continue;
    return GuestFinding{GuestFailure::kFell,
                        fmt::format("body {} fell: {}; its twin: {}", b, tell(own), tell(twin))};
  }
  return std::nullopt;
}

std::optional<GuestFinding> GuestVerdict::findDifferent(std::size_t index) {
  GuestSite& site = *sites_[index];
  const auto& bodies = site.world().bodies();
  fastest_ = std::max({fastest_, speedOf(site.world()), speedOf(site.twin())});
  for (int r = 0; site.site() && r < site.site()->remoteCount(); ++r)
    if (const RigidState* proxy = site.site()->proxy(r))
      fastest_ = std::max(fastest_, proxy->v_W.norm());
  const double near = kMeets + kReach * fastest_ * std::max(case_.frame, case_.step());
  // A far hand feels bodies that fly to it, and the island holds them.
  for (const auto& body : bodies)
    if (case_.hand_feels && (placeOf(*body) - site.device().position()).norm() < near)
      has_felt_[index] = 1;
  if (case_.hand_feels && isArmNearHand(site, near)) has_felt_[index] = 1;
  if (case_.is_idle && has_felt_[index]) return std::nullopt;
  // An arm may come near a far body, and Bullet solves its joints in that one's batch.
  if (!case_.is_idle && !case_.arms.empty()) return std::nullopt;
  for (std::size_t a = 0; a < site.world().arms().size(); ++a)
    if (!site.world().arms()[a]->isAt(*site.twin().arms()[a]))
      return GuestFinding{GuestFailure::kTwin, fmt::format("arm {} is not where its twin is", a)};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const GuestBody &own = *bodies[b], &twin = *site.twin().bodies()[b];
    if (!case_.is_idle) {
      if (own.plan.role != GuestRole::kFar || own.rigid->getCollisionShape()->isCompound())
        continue;
      if (own.was_shared) is_met_[index][b] = 1;  // by "share again": the island moves it
      if (site.world().world().getSolverInfo().m_solverMode & SOLVER_RANDMIZE_ORDER)
        is_met_[index][b] = 1;
      // Bullet sees supports, and more sweeps change the rounding of all that it solves.
      if (site.world().watch().sweeps() != site.twin().watch().sweeps()) is_met_[index][b] = 1;
      for (std::size_t c = 0; c < bodies.size(); ++c)
        if (c != b && ((placeOf(*bodies[c]) - placeOf(own)).norm() < near ||
                       (placeOf(*site.twin().bodies()[c]) - placeOf(twin)).norm() < near))
          is_met_[index][b] = 1;
      if ((placeOf(own) - site.device().position()).norm() < near || isInArena(own))
        is_met_[index][b] = 1;
      if (is_met_[index][b]) continue;
    }
    if (isSame(*own.rigid, *twin.rigid)) continue;
    return GuestFinding{GuestFailure::kTwin,
                        fmt::format("body {} is at {}; its twin: {}", b, tell(own), tell(twin))};
  }
  return std::nullopt;
}

bool GuestVerdict::isArmNearHand(GuestSite& site, double near) const {
  for (const auto& arm : site.world().arms())
    for (const Vec3& p_W : arm->places())
      if ((p_W - site.device().position()).norm() < near) return true;
  return false;
}

std::optional<GuestFinding> GuestVerdict::findEnergy() {
  double own = 0.0, twins = 0.0, hands = 0.0, rails = 0.0;
  for (const auto& site : sites_) {
    own += energyOf(site->world());
    if (has_mover_ && !case_.is_planar) rails += energyOnRails(site->world());
    twins += energyOf(site->twin());
    hands += site->device().work();
  }
  allowTwins(twins);
  for (const auto& site : sites_) allowed_ += site->takeGiven();
  rails_ = std::max(rails_, rails);
  double allowed = kMostGrowth * (allowed_ + hands + rails_);
  if (own > allowed) allowed += kMostGrowth * std::max(0.0, askShaken().mostGained() - gained_);
  share_ = std::max(share_, own / allowed);
  if (own <= allowed) return std::nullopt;
  std::string text = fmt::format("{:.3f} J, of {:.3f} J allowed", own, allowed);
  for (const auto& site : sites_) {
    const std::size_t b = findLiveliest(site->world());
    text += fmt::format("; body {}: {}", b, tell(*site->world().bodies()[b]));
  }
  return GuestFinding{GuestFailure::kEnergy, text};
}

std::optional<GuestFinding> GuestVerdict::lookAtEnd() {
  for (const auto& site : sites_)
    if (std::string what = site->findLeftOver(); !what.empty())
      return GuestFinding{GuestFailure::kRestored, what};
  return std::nullopt;
}

}  // namespace tandem::demos::bench
