#include <algorithm>
#include <cmath>

#include "site/surroundings.h"

// Runs in the thread that ticks: applies the results of the host's searches, and moves newcomers on
// to the island's time.

namespace tandem {
namespace {

/// Time in which the prediction error of a kinematic body is corrected [s]. A longer time leaves
/// the error for longer; a shorter one hits touched bodies harder.
constexpr double kMendingTime = 0.1;

}  // namespace

void Surroundings::mirror() noexcept {
  if (settings_.guide) return;
  mirror_.island_time = timeline_.time();
  mirror_.depth = island_.deepestTouch();
  for (std::size_t b = 0; b < mirror_.states.size(); ++b)
    mirror_.states[b] = island_.state(static_cast<BodyIndex>(b));
  std::fill(mirror_.moves.begin(), mirror_.moves.end(), char{0});
  for (const BodyIndex b : island_.awakeBodies()) mirror_.moves[static_cast<std::size_t>(b)] = 1;
}

void Surroundings::takeContacts() noexcept {
  const std::vector<ContactSum>& sums = island_.takeContacts();
  contacts_.assign(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(
                                                    std::min(sums.size(), contacts_.capacity())));
  for (std::size_t b = 0; b < still_.size(); ++b)
    still_[b] = island_.isStill(static_cast<BodyIndex>(b)) ? 1 : 0;
}

void Surroundings::takeLeaving() noexcept {
  if (joints_.dropGone()) island_.wake();
  if (leaving_.empty() && !has_more_) return;
  takeObstacles();
  for (Neighbour* neighbour : leaving_) takeOut(*neighbour);
}

void Surroundings::take() noexcept {
  if (settings_.guide) return;
  takeObstacles();
  for (Neighbour* neighbour : leaving_) takeOut(*neighbour);
  takeNewcomers();
  takeJoints();
  spring_speed_ = island_.isAsleep() ? 0.0 : computeSpeedInSprings();
  catchUp();
  peers_.noteSearched();
}

void Surroundings::takeJoints() noexcept {
  if (!joints_.take()) return;
  static_cast<void>(joints_.refresh({clock_.step(), 0.0, 0.0, 0.0}));
  island_.wake();
}

void Surroundings::takeObstacles() noexcept {
  obstacles_.commit();
  island_.setObstacles(obstacles_.nearSpheres());
  if (has_changed_) island_.wake();
  has_changed_ = has_more_ = false;
}

void Surroundings::takeOut(Neighbour& neighbour) noexcept {
  const BodyIndex index = neighbour.body.index;
  std::erase(newcomers_, index);
  joints_.drop(index);
  if (neighbour.body.is_held) {
    hand_.energy().countNeighbour(neighbour.settings, island_.state(index), -1.0);
    neighbour.owed = forces_.computeOwed(neighbour.body);
  }
  island_.clear(index);
  neighbour.body.is_held = false;
  neighbour.is_new = false;
}

void Surroundings::takeNewcomers() noexcept {
  for (Neighbour& neighbour : neighbours_) {
    if (!neighbour.is_new) continue;
    neighbour.is_new = false;
    SiteBody& body = neighbour.body;
    body.is_held = body.bullet != nullptr;
    if (neighbour.driven) neighbour.settings.start = neighbour.driven->at(timeline_.time());
    island_.fill(body.index, neighbour.settings);
    if (body.is_held) {
      body.seen = neighbour.settings.start;
      forces_.setWeight(body, body.step.f_gravity_W);
      newcomers_.push_back(body.index);
    }
    timeline_.enter(body.index, neighbour.settings.start);
  }
}

void Surroundings::catchUp() noexcept {
  if (newcomers_.empty()) return;
  double time = clock_.time();
  std::fill(asides_.begin(), asides_.end(), Aside{});
  readStates(time, from_states_);
  while (timeline_.time() - time > kClockTolerance) {
    // Stop where the host's next steps end: the host asks for their states there.
    const double stop = std::min(timeline_.time(), timeline_.nextKeptAfter(time + kClockTolerance));
    readStates(stop, to_states_);
    island_.catchUp(newcomers_, from_states_, to_states_, stop - time, asides_);
    if (auto* states = timeline_.findStates(stop))
      for (const BodyIndex b : newcomers_)
        (*states)[static_cast<std::size_t>(b)] = island_.state(b);
    time = stop;
    from_states_.swap(to_states_);
  }
  for (const BodyIndex b : newcomers_) {
    timeline_.setStart(b, island_.state(b));
    hand_.energy().countNeighbour(island_.body(b), island_.state(b), 1.0);
  }
  newcomers_.clear();
  // Bodies that newcomers touched in the past receive the momentum now.
  bodies_.forEach([&](SiteBody& body) {
    const Aside& aside = asides_[static_cast<std::size_t>(body.index)];
    const RigidState& now = island_.state(body.index);
    const IslandBody& own = island_.body(body.index);
    forces_.give(body, {own.mass * aside.v_W,
                        now.q_WB * own.inertia_B.cwiseProduct(now.q_WB.conjugate() * aside.w_W)});
  });
}

/// Reads the states of all bodies at `time` [s].
void Surroundings::readStates(double time, std::vector<RigidState>& states) noexcept {
  timeline_.readStates(time, states);
  for (const Neighbour& neighbour : neighbours_)
    if (neighbour.driven && !neighbour.body.is_leaving)
      states[static_cast<std::size_t>(neighbour.body.index)] = neighbour.driven->at(time);
}

/// Upper bound of the speed that stretched springs can add to any body [m/s]. A spring of stiffness
/// K stretched by x moves m no faster than x sqrt(K / m).
double Surroundings::computeSpeedInSprings() const noexcept {
  double most = 0.0;
  bodies_.forEach([&](const SiteBody& body) {
    const BodyIndex b = body.index;
    if (body.bullet->isParked() || !island_.isDynamic(b)) return;
    const double mass = island_.body(b).mass;
    double speed = 0.0;
    if (settings_.contact.stiffness > 0.0)
      speed +=
          island_.computeContactForce(b).norm() / std::sqrt(settings_.contact.stiffness * mass);
    for (CouplerIndex c = 0; c < island_.couplerCount(); ++c) {
      if (island_.follower(c) != b) continue;
      const RigidState& target = island_.target(c);
      const double way = (target.p_W - island_.state(b).p_W).norm();
      const double stiffness = island_.presentGains(c).linear.stiffness;
      speed += target.v_W.norm() + way * std::sqrt(stiffness / mass);
    }
    most = std::max(most, speed);
  });
  return most;
}

/// Updates damping that the host changed while the island holds the body.
void Surroundings::followDamping() noexcept {
  for (Neighbour& neighbour : neighbours_) {
    if (!neighbour.body.is_held || !neighbour.followDamping()) continue;
    neighbour.settings.start = island_.state(neighbour.body.index);
    island_.fill(neighbour.body.index, neighbour.settings);
    forces_.renew(neighbour.body);
  }
}

/// Steers kinematic bodies to the host's latest pose. If the ticks of the host's step are still to
/// run, they arrive in time. Otherwise the step is over, and the small prediction error is
/// corrected slowly.
void Surroundings::steerDriven(bool ticks_in_step) noexcept {
  for (Neighbour& neighbour : neighbours_) {
    if (!neighbour.driven || neighbour.is_new || neighbour.body.is_leaving) continue;
    DrivenBody& driven = *neighbour.driven;
    const BodyIndex index = neighbour.body.index;
    // The rest of a fast host's step may be rounding. An error divided by it would be a blow.
    const double rest = std::max(driven.seenAt() - timeline_.time(), timeline_.period());
    const double within = ticks_in_step ? rest : kMendingTime;
    const RigidState state = driven.steer(island_.state(index), timeline_.time(), within);
    if (driven.motion() != neighbour.settings.motion) {
      neighbour.settings.motion = driven.motion();
      neighbour.settings.start = state;
      island_.fill(index, neighbour.settings);
    }
    island_.setState(index, state);
    if (state.v_W != Vec3::Zero() || state.w_W != Vec3::Zero()) hand_.energy().refill();
  }
}

}  // namespace tandem
