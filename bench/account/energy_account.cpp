#include "bench/account/energy_account.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/account/between_looks.h"

namespace tandem::demos::bench {
namespace {

/// The site treats moments closer than this as one [s].
constexpr double kSameTime = 1e-10;

/// Rigid contact may remove overlap at this speed [m/s].
constexpr double kPushOutSpeed = 0.25;

/// Half extent of a shape along a direction of W [m].
double computeExtent(const IslandBody& body, const Quat& q_WB, const Vec3& direction_W) {
  if (const auto* box = std::get_if<Box>(&body.shape))
    return box->half_extents.dot((q_WB.conjugate() * direction_W).cwiseAbs());
  if (const auto* capsule = std::get_if<Capsule>(&body.shape))
    return capsule->radius + capsule->half_length * std::abs((q_WB.conjugate() * direction_W).y());
  return std::get<Sphere>(body.shape).radius;
}

}  // namespace

EnergyAccount::EnergyAccount(const Island& island, const AccountScene& scene)
    : island_(island), scene_(scene) {}

void EnergyAccount::look(double time) {
  take(time);
  if (!started_) {
    started_ = true;
    start_ = stock_;
  } else if (now_.time - last_.time < kSameTime) {
    now_.time = last_.time;
    addJump(flows_.target_jumps);
  } else {
    addMotion();
  }
  finishLook();
}

void EnergyAccount::lookAfterHost(double time) {
  take(time);
  now_.time = last_.time;
  const double appeared = stock_.contacts - last_stock_.contacts;
  host_contact_energy_ = std::max(host_contact_energy_, appeared);
  addJump(flows_.host);
  finishLook();
}

void EnergyAccount::finishLook() {
  last_ = now_;
  last_stock_ = stock_;
  if (trace_) trace_->push_back({now_.time, stock_, flows_, lost_});
}

void EnergyAccount::take(double time) {
  ++looks_;
  now_.time = time;
  const auto count = static_cast<std::size_t>(island_.bodyCount());
  now_.states.resize(count);
  now_.active.resize(count);
  shifts_.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    const auto index = static_cast<BodyIndex>(b);
    now_.states[b] = island_.state(index);
    now_.active[b] = island_.isActive(index);
    finite_ = finite_ && tandem::isFinite(now_.states[b]);
  }
  if (!started_) origins_ = now_.states;
  findPairs();
  measureStock();
}

/// Lists all possible smooth contacts, in an order that only the host's step can change.
void EnergyAccount::findPairs() {
  now_.pairs.clear();
  const auto add = [&](BodyIndex sphere, BodyIndex other, const Obstacle* obstacle) {
    now_.pairs.push_back({sphere, other, obstacle});
    measure(now_.pairs.back());
  };
  const auto meet = [&](BodyIndex sphere, const CollisionFilter& other) {
    return island_.body(sphere).filter.meets(other);
  };
  for (const IslandContact& contact : island_.contacts())
    if ((!scene_.guide || !isBlocked(contact)) &&
        meet(contact.sphere, island_.body(contact.other).filter))
      add(contact.sphere, contact.other, nullptr);
  if (scene_.guide) return;
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b) {
    if (!island_.isActive(b) || !island_.body(b).feels_obstacles) continue;
    for (BodyIndex slot = 0; slot < island_.bodyCount(); ++slot)
      if (island_.isSlot(slot) && island_.isActive(slot) && island_.body(slot).touches_spheres &&
          meet(b, island_.body(slot).filter))
        add(b, slot, nullptr);
    // The hand against a fixed body does no work, and is no energy of a body.
    if (island_.body(b).motion != Motion::kDynamic) continue;
    if (!island_.obstacles()) continue;
    for (const Obstacle& obstacle : *island_.obstacles())
      if (meet(b, obstacle.filter)) add(b, b, &obstacle);
  }
}

/// Bodies keep their order in a slot: a pair with a third body between never touches.
bool EnergyAccount::isBlocked(const IslandContact& contact) const {
  const auto place = [&](BodyIndex b) {
    return scene_.guide->dot(origins_[static_cast<std::size_t>(b)].p_W);
  };
  const double low = std::min(place(contact.sphere), place(contact.other));
  const double high = std::max(place(contact.sphere), place(contact.other));
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b)
    if (b != contact.sphere && b != contact.other && place(b) > low + 1e-12 &&
        place(b) < high - 1e-12)
      return true;
  return false;
}

void EnergyAccount::measure(Pair& pair) const {
  const RigidState& sphere = now_.states[static_cast<std::size_t>(pair.sphere)];
  RigidState other = now_.states[static_cast<std::size_t>(pair.other)];
  if (pair.obstacle) {
    other = {};
    other.p_W = pair.obstacle->p_WB;
    other.q_WB = pair.obstacle->q_WB;
  }
  measure(sphere, other, pair);
}

void EnergyAccount::measure(const RigidState& sphere, const RigidState& other, Pair& pair) const {
  if (scene_.guide) return measureInSlot(sphere, other, pair);
  const double radius = std::get<Sphere>(island_.body(pair.sphere).shape).radius;
  const Shape& shape = pair.obstacle ? pair.obstacle->shape : island_.body(pair.other).shape;
  const double apart = (sphere.p_W - other.p_W).norm() - radius - computeBoundingRadius(shape);
  if (apart > 0.0) {
    pair.overlap = -apart;
    return;
  }
  const SphereContact found = findSphereContact(sphere.p_W, radius, shape, other.p_W, other.q_WB);
  pair.overlap = -found.gap;
  pair.n_W = found.n_W;
  const Vec3 v_point_W = other.v_W + other.w_W.cross(found.p_W - other.p_W);
  pair.rate = -found.n_W.dot(sphere.v_W - v_point_W);
}

void EnergyAccount::measureInSlot(const RigidState& sphere, const RigidState& other,
                                  Pair& pair) const {
  const auto s = static_cast<std::size_t>(pair.sphere), o = static_cast<std::size_t>(pair.other);
  const Vec3& axis = *scene_.guide;
  const double start = axis.dot(origins_[o].p_W - origins_[s].p_W);
  const double side = start >= 0.0 ? 1.0 : -1.0;
  const double size = computeExtent(island_.body(pair.sphere), origins_[s].q_WB, axis) +
                      computeExtent(island_.body(pair.other), origins_[o].q_WB, axis);
  pair.overlap = size - side * axis.dot(other.p_W - sphere.p_W);
  pair.rate = -side * axis.dot(other.v_W - sphere.v_W);
  pair.n_W = -side * axis;
}

void EnergyAccount::measureStock() {
  stock_ = {};
  double grain = 0.0, force = 0.0;
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b) {
    if (!island_.isDynamic(b)) continue;
    const IslandBody& body = island_.body(b);
    const RigidState& state = now_.states[static_cast<std::size_t>(b)];
    const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
    stock_.motion +=
        0.5 * body.mass * state.v_W.squaredNorm() + 0.5 * w_B.dot(body.inertia_B.cwiseProduct(w_B));
    if (body.is_rigid)
      stock_.weight -= body.mass * scene_.gravity_W.dot(state.p_W - scene_.origin_W);
    if (body.is_rigid) force += body.mass * scene_.gravity_W.norm();
    grain = std::max(grain, state.p_W.cwiseAbs().maxCoeff());
  }
  grain *= std::numeric_limits<double>::epsilon();
  for (CouplerIndex c = 0; c < island_.couplerCount(); ++c) {
    const BodyIndex b = island_.follower(c);
    if (!island_.isDynamic(b)) continue;
    const RigidState& state = now_.states[static_cast<std::size_t>(b)];
    const RigidState& target = island_.target(c);
    const CouplerSettings& gains = island_.presentGains(c);
    const double way =
        scene_.guide ? scene_.guide->dot(target.p_W - state.p_W) : (target.p_W - state.p_W).norm();
    stock_.couplers += 0.5 * gains.linear.stiffness * way * way;
    force += gains.linear.stiffness * std::abs(way);
    if (island_.body(b).inertia_B == Vec3::Zero() || scene_.guide) continue;
    stock_.couplers +=
        0.5 * gains.angular.stiffness * computeTurn(state.q_WB, target.q_WB).squaredNorm();
  }
  for (const Pair& pair : now_.pairs) {
    if (!(pair.overlap > 0.0) || !movesAny(pair)) continue;
    stock_.contacts += 0.5 * scene_.contact.stiffness * pair.overlap * pair.overlap;
    force += scene_.contact.stiffness * pair.overlap;
  }
  rounding_ = std::max(rounding_, grain * force);
  peak_ =
      std::max({peak_, stock_.motion + stock_.couplers + stock_.contacts,
                started_ ? std::abs(stock_.weight - start_.weight) : 0.0, std::abs(flows_.sum())});
}

bool EnergyAccount::movesAny(const Pair& pair) const {
  return island_.isDynamic(pair.sphere) || island_.isDynamic(pair.other);
}

void EnergyAccount::addJump(double& flow) {
  flow += stock_.sum() - last_stock_.sum();
  // A body that forces move stays in place during a jump, unless it enters or leaves.
  for (std::size_t b = 0; b < now_.states.size(); ++b)
    if (now_.active[b] && last_.active[b] && island_.isDynamic(static_cast<BodyIndex>(b)) &&
        !island_.isSlot(static_cast<BodyIndex>(b)))
      noteJump((now_.states[b].p_W - last_.states[b].p_W).norm());
}

void EnergyAccount::addMotion() {
  const double dt = now_.time - last_.time;
  const double shifted = scene_.has_overlap ? workOfShifts(dt) : 0.0;
  const double dragged = workOfTargets(dt), pushed = workOfDriven(dt);
  flows_.target_motion += dragged;
  flows_.hand += pushed;
  flows_.push_out += shifted;
  shifted_ += std::abs(shifted);
  lost_ += dragged + pushed + shifted - (stock_.sum() - last_stock_.sum());
  most_lost_ = std::max(most_lost_, lost_);
  if (most_lost_ - lost_ > unaccounted_) {
    unaccounted_ = most_lost_ - lost_;
    unaccounted_time_ = now_.time;
  }
  for (std::size_t p = 0; p < now_.pairs.size(); ++p)
    if (movesAny(now_.pairs[p]) && isOverEdge(last_.pairs[p], now_.pairs[p]))
      doubt_ += doubtOverEdge(last_.pairs[p], now_.pairs[p], dt);
  checkWays(dt);
}

/// A sphere so deep in a body has its centre past an edge, or past the middle of two faces. The
/// direction of the force has then jumped.
bool EnergyAccount::isOverEdge(const Pair& from, const Pair& to) {
  return from.overlap > 0.0 && to.overlap > 0.0 && from.n_W.dot(to.n_W) < 0.98;
}

/// A step of the integrator, h at the shortest, misses the moment in which a direction begins to
/// turn. Its error is the force's work in h times the angle of that turn. Past the middle of a ball
/// or capsule the direction jumps, and the whole step may be wrong. From face to face of a box it
/// jumps at a located event.
double EnergyAccount::doubtOverEdge(const Pair& from, const Pair& to, double dt) const {
  constexpr double kStepsPerPeriod = 1024;
  constexpr double kJump = 1.0;  // [rad]
  const double force = scene_.contact.stiffness * std::max(from.overlap, to.overlap) +
                       scene_.contact.damping * std::max(std::abs(from.rate), std::abs(to.rate));
  const RigidState& sphere = now_.states[static_cast<std::size_t>(to.sphere)];
  Vec3 v_W = sphere.v_W;
  if (!to.obstacle) v_W -= now_.states[static_cast<std::size_t>(to.other)].v_W;
  const double step = scene_.haptic_period / kStepsPerPeriod;
  const Shape& shape = to.obstacle ? to.obstacle->shape : island_.body(to.other).shape;
  const double turn = std::acos(std::clamp(from.n_W.dot(to.n_W), -1.0, 1.0));
  const double radius = std::get<Sphere>(island_.body(to.sphere).shape).radius;
  const bool is_box = std::holds_alternative<Box>(shape);
  if (is_box && std::min(from.overlap, to.overlap) > radius) return 0.0;
  const bool jumps = turn > kJump && !is_box;
  const double part = jumps ? 2.0 : turn * std::min(1.0, step / dt);
  return part * force * v_W.norm() * step;
}

double EnergyAccount::workOfTargets(double dt) const {
  double work = 0.0;
  for (CouplerIndex c = 0; c < island_.couplerCount(); ++c) {
    const BodyIndex b = island_.follower(c);
    if (!island_.isDynamic(b)) continue;
    const auto i = static_cast<std::size_t>(b);
    const RigidState& target = island_.target(c);
    const CouplerSettings& gains = island_.presentGains(c);
    const Vec3 v_W =
        scene_.guide ? Vec3(*scene_.guide * scene_.guide->dot(target.v_W)) : target.v_W;
    const Vec3 way_W = now_.states[i].p_W - last_.states[i].p_W - shifts_[i].way_W;
    work += gains.linear.damping * v_W.dot(dt * v_W - way_W);
    if (island_.body(b).inertia_B == Vec3::Zero() || scene_.guide) continue;
    const Vec3 turn_W = computeTurn(last_.states[i].q_WB, now_.states[i].q_WB) - shifts_[i].turn_W;
    work += gains.angular.damping * target.w_W.dot(dt * target.w_W - turn_W);
  }
  return work;
}

/// Limits a body's way between two looks by its possible speed. That is twice the speed of the
/// fastest body or target, as a heavy body may hit it. The springs' part and the speed at which
/// overlap is removed come on top.
void EnergyAccount::checkWays(double dt) {
  double fastest = 0.0;
  for (CouplerIndex c = 0; c < island_.couplerCount(); ++c)
    fastest = std::max(fastest, island_.target(c).v_W.norm());
  for (const Snapshot* snapshot : {&last_, &now_})
    for (std::size_t b = 0; b < snapshot->states.size(); ++b)
      if (snapshot->active[b]) {
        const RigidState& state = snapshot->states[b];
        const double radius = computeBoundingRadius(island_.body(static_cast<BodyIndex>(b)).shape);
        fastest = std::max(fastest, state.v_W.norm() + state.w_W.norm() * radius);
      }
  const double springs = last_stock_.couplers + last_stock_.contacts;
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b) {
    if (!island_.isDynamic(b)) continue;
    const auto i = static_cast<std::size_t>(b);
    const double speed = 2.0 * fastest + std::sqrt(2.0 * springs / island_.body(b).mass) +
                         scene_.gravity_W.norm() * dt + kPushOutSpeed;
    noteJump((now_.states[i].p_W - last_.states[i].p_W).norm() - speed * dt);
  }
}

void EnergyAccount::noteJump(double way) {
  if (!(way > worst_jump_)) return;
  worst_jump_ = way;
  worst_jump_time_ = now_.time;
}

}  // namespace tandem::demos::bench
