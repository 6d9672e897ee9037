// Work of the hand and of held bodies on an island through contacts. This is the only part of an
// EnergyAccount that does not follow directly from the states.

#include <algorithm>
#include <bit>
#include <cmath>

#include "bench/account/between_looks.h"
#include "bench/account/energy_account.h"

namespace tandem::demos::bench {
namespace {

/// Limits between two looks while the hand pushes: angle of the fastest oscillation [rad], time
/// over that of the fastest decay, way over the size of the touching bodies.
constexpr double kAngleBetweenLooks = 0.15, kDecayBetweenLooks = 0.3, kWayBetweenLooks = 0.03;

/// With this factor fewer looks than needed, a way is not known well.
constexpr double kTooFewLooks = 1.5;

/// Tolerance of the hand's work between two looks, relative to the largest energy.
constexpr double kHandTolerance = 1e-11;

/// Mobility at the most mobile place of a body's surface [1/kg].
double computeMobility(const IslandBody& body, bool turns) {
  if (!turns || !(body.inertia_B.minCoeff() > 0.0)) return 1.0 / body.mass;
  const double arm = computeBoundingRadius(body.shape);
  return 1.0 / body.mass + arm * arm / body.inertia_B.minCoeff();
}

}  // namespace

int EnergyAccount::countLooks(int most) const {
  // Rigid contact needs a look in each inner step. Otherwise only the hand's work needs looks, and
  // only for bodies that it may touch in this tick.
  double rate = scene_.has_overlap ? innerRate() : 0.0;
  for (const Pair& pair : now_.pairs) {
    if (pair.obstacle || !movesAny(pair)) continue;
    const bool is_sphere_driven = !island_.isDynamic(pair.sphere);
    if (!is_sphere_driven && island_.isDynamic(pair.other)) continue;
    const BodyIndex driver = is_sphere_driven ? pair.sphere : pair.other;
    const BodyIndex touched = is_sphere_driven ? pair.other : pair.sphere;
    if (island_.state(driver).v_W == Vec3::Zero()) continue;
    const double speed = fastestOf(touched, island_.state(driver).v_W);
    if (pair.overlap < -2.0 * speed * scene_.haptic_period) continue;
    rate = std::max(rate, neededRate(driver, touched));
  }
  const auto count = static_cast<unsigned>(
      std::clamp(std::ceil(rate * scene_.haptic_period), 1.0, static_cast<double>(most)));
  // A slot divides a period in binary parts, and would round others.
  return static_cast<int>(scene_.guide ? std::bit_ceil(count) : count);
}

/// Rate of the island's inner steps near rigid contact [1/s]. Springs shorten a step to 0.18 rad,
/// at most 64 times.
double EnergyAccount::innerRate() const {
  double fastest = 0.0;
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b) {
    if (!island_.isDynamic(b) || !island_.body(b).is_rigid) continue;
    double stiffness = 2.0 * scene_.contact.stiffness;
    for (CouplerIndex c = 0; c < island_.couplerCount(); ++c)
      if (island_.follower(c) == b) stiffness += island_.presentGains(c).linear.stiffness;
    fastest = std::max(fastest, std::sqrt(stiffness * computeMobility(island_.body(b), true)));
  }
  const double longest = 1.0 / IslandSettings{}.inner_step;
  return std::clamp(fastest / 0.18, longest, 64.0 * longest);
}

/// Looks per second needed to know the way of a body that the hand touches.
double EnergyAccount::neededRate(BodyIndex driver, BodyIndex touched) const {
  const IslandBody& body = island_.body(touched);
  double stiffness = 2.0 * scene_.contact.stiffness, damping = 2.0 * scene_.contact.damping;
  for (CouplerIndex c = 0; c < island_.couplerCount(); ++c) {
    if (island_.follower(c) != touched) continue;
    stiffness += island_.presentGains(c).linear.stiffness;
    damping += island_.presentGains(c).linear.damping;
  }
  const double mobility = computeMobility(body, !scene_.guide);
  const double size = std::min(computeBoundingRadius(island_.body(driver).shape),
                               computeBoundingRadius(body.shape));
  const double speed = (island_.state(driver).v_W - island_.state(touched).v_W).norm();
  return std::max({std::sqrt(stiffness * mobility) / kAngleBetweenLooks,
                   damping * mobility / kDecayBetweenLooks, speed / (kWayBetweenLooks * size)});
}

/// Work of the hand and of held bodies through contacts.
double EnergyAccount::workOfDriven(double dt) {
  double direct = 0.0;
  bool is_held_near = false, is_rough = false;
  Vec3 v_hand_W = Vec3::Zero();
  for (std::size_t p = 0; p < now_.pairs.size(); ++p) {
    const Pair &from = last_.pairs[p], &to = now_.pairs[p];
    if (from.obstacle || !movesAny(from)) continue;
    const bool is_sphere_driven = !island_.isDynamic(from.sphere);
    if (!is_sphere_driven && island_.isDynamic(from.other)) continue;
    const BodyIndex driver = is_sphere_driven ? from.sphere : from.other;
    const BodyIndex touched = is_sphere_driven ? from.other : from.sphere;
    const bool is_hand = island_.body(driver).motion == Motion::kPrescribed;
    const Vec3& v_W = last_.states[static_cast<std::size_t>(driver)].v_W;
    if (from.overlap < -2.0 * dt * fastestOf(touched, v_W)) continue;
    is_held_near |= !is_hand;
    if (v_W == Vec3::Zero()) continue;
    if (is_hand) {
      v_hand_W = v_W;
      is_rough |= isOverEdge(from, to) || dt * neededRate(driver, touched) > kTooFewLooks;
      direct += integrateHand(from, driver, dt);
      continue;
    }
    // Work by the speed at which the driver closes the overlap. A held body's speed counts only in
    // the dampers.
    const double side = is_sphere_driven ? -1.0 : 1.0;
    const Vec3 v_closing_W = side * v_W;
    const double closing = (from.n_W + to.n_W).normalized().dot(v_closing_W);
    const Pushed pushed = integratePush(from, to, dt, v_closing_W, closing);
    direct +=
        scene_.contact.damping * closing * (pushed.closing + closing * pushed.time) + pushed.free;
  }
  // If the direction of the force jumps, the bodies' ways have a kink, which no cubic has. The same
  // holds for a decay that ends before the next look.
  if (is_rough && !is_held_near && scene_.is_free)
    doubt_ += std::abs(direct - v_hand_W.dot(impulseOfHand(dt)));
  return direct;
}

/// Integrated power of the hand. The other body's way is known well in between. Details on it (a
/// rim, an edge, the end of a touch) are sampled as finely as they need.
double EnergyAccount::integrateHand(const Pair& from, BodyIndex driver, double dt) const {
  const bool is_sphere_driven = driver == from.sphere;
  const auto touched = static_cast<std::size_t>(is_sphere_driven ? from.other : from.sphere);
  const BetweenLooks way(last_.states[touched], now_.states[touched], dt);
  RigidState hand = last_.states[static_cast<std::size_t>(driver)];
  const Vec3 start_W = hand.p_W;
  Pair pair = from;
  const auto powerAt = [&](double share) {
    hand.p_W = start_W + share * dt * hand.v_W;
    const RigidState moved = way.at(share);
    measure(is_sphere_driven ? hand : moved, is_sphere_driven ? moved : hand, pair);
    const double push = computeContactForce(scene_.contact, pair.overlap, pair.rate);
    return (is_sphere_driven ? -push : push) * pair.n_W.dot(hand.v_W);
  };
  return dt * integrate(powerAt, kHandTolerance * peak_ / dt);
}

/// Impulse of the hand, from the change of the bodies' momentum minus the couplers' part. The way
/// of each body in between is the cubic that fits both ends.
Vec3 EnergyAccount::impulseOfHand(double dt) const {
  Vec3 impulse_W = Vec3::Zero();
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b) {
    if (!island_.isDynamic(b)) continue;
    const auto i = static_cast<std::size_t>(b);
    const IslandBody& body = island_.body(b);
    const Vec3 way_W = now_.states[i].p_W - last_.states[i].p_W;
    impulse_W += body.mass * (now_.states[i].v_W - last_.states[i].v_W) + body.damping * way_W;
    if (body.is_rigid) impulse_W -= body.mass * dt * scene_.gravity_W;
  }
  for (CouplerIndex c = 0; c < island_.couplerCount(); ++c) {
    const BodyIndex b = island_.follower(c);
    if (!island_.isDynamic(b)) continue;
    const RigidState &from = last_.states[static_cast<std::size_t>(b)],
                     &to = now_.states[static_cast<std::size_t>(b)];
    const CouplerGains& gains = island_.presentGains(c).linear;
    const RigidState& target = island_.target(c);
    const Vec3 bend_W = dt * dt / 12.0 * (from.v_W - to.v_W);
    const Vec3 stretch_W = 0.5 * dt * ((target.p_W - from.p_W) + (target.p_W - to.p_W)) - bend_W;
    impulse_W -=
        gains.stiffness * stretch_W + gains.damping * (dt * target.v_W - (to.p_W - from.p_W));
  }
  return impulse_W;
}

/// Largest possible speed relative to a driver, if one body had all energy [m/s].
double EnergyAccount::fastestOf(BodyIndex body, const Vec3& v_driver_W) const {
  const double energy = last_stock_.motion + last_stock_.couplers + last_stock_.contacts;
  return v_driver_W.norm() + std::sqrt(2.0 * energy / island_.body(body).mass);
}

/// The overlap in between is the cubic that fits both ends; the damper's part needs only the ends
/// of the push. `held` is the part of its rate that does not change the overlap [m/s].
EnergyAccount::Pushed EnergyAccount::integratePush(const Pair& from, const Pair& to, double dt,
                                                   const Vec3& v_closing_W, double held) const {
  const double first_rate = from.rate - held, last_rate = to.rate - held;
  const auto overlapAt = [&](double s) {
    const double t = 1.0 - s;
    return t * t * ((1.0 + 2.0 * s) * from.overlap + s * dt * first_rate) +
           s * s * ((1.0 + 2.0 * t) * to.overlap - t * dt * last_rate);
  };
  const auto rateAt = [&](double s) {
    const double t = 1.0 - s;
    return 6.0 * s * t * (to.overlap - from.overlap) / dt + t * (1.0 - 3.0 * s) * first_rate +
           s * (1.0 - 3.0 * t) * last_rate;
  };
  const auto pushesAt = [&](double s) {
    return computeContactForce(scene_.contact, overlapAt(s), rateAt(s) + held) > 0.0;
  };
  const auto store = [&](double overlap) {
    const double depth = std::max(0.0, overlap);
    return 0.5 * scene_.contact.stiffness * depth * depth;
  };
  const bool pushes_first = pushesAt(0.0), pushes_last = pushesAt(1.0);
  if (!pushes_first && !pushes_last)
    return {0.0, 0.0, 0.0, store(to.overlap) - store(from.overlap)};
  double begin = 0.0, end = 1.0;
  if (pushes_first != pushes_last) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (pushesAt(middle) == pushes_first ? low : high) = middle;
    }
    (pushes_first ? end : begin) = 0.5 * (low + high);
  }
  const auto closingAt = [&](double s) {
    return ((1.0 - s) * from.n_W + s * to.n_W).normalized().dot(v_closing_W);
  };
  const double first = overlapAt(begin), last = overlapAt(end), middle = 0.5 * (begin + end);
  const double mean = (first * closingAt(begin) + 4.0 * overlapAt(middle) * closingAt(middle) +
                       last * closingAt(end)) /
                      6.0;
  const double time = (end - begin) * dt;
  return {scene_.contact.stiffness * mean * time, last - first, time,
          store(first) - store(from.overlap) + store(to.overlap) - store(last)};
}

}  // namespace tandem::demos::bench
