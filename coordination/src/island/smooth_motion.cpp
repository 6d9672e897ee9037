#include "island/smooth_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tandem {
namespace {

/// Chattering contacts are not followed forever: after this many events in one advance, steps may
/// hide the rest.
constexpr int kMaxEvents = 32;

constexpr double kMaxStepsPerPeriod = SmoothForces::kMostStepsPerPeriod;

/// Response time of the stiffest springs that hands feel [s]. A spring n times faster turns a
/// length error into n^2 times the energy, in n times as many steps. Its tolerance is n^3 times
/// smaller.
constexpr double kAnswerOfHands = 5e-4;

/// Turn of the fastest spring while a force of rigid contact is held [rad]. The smooth motion
/// beside it keeps to its own steps; that of the force is of second order, and measures its error.
constexpr double kMostTurnOfHold = 0.5;

/// Share of the allowed error for a step that passes an edge.
constexpr double kAtEdges = 1.0 / 64.0;

/// Shortest step of joints in haptic periods. A taut chain is nearly singular: its forces carry
/// noise that no shorter step takes out.
constexpr double kShortestOfJoints = 0.25;

/// Joined bodies turn at most this far in such a step [rad]. Beyond, errors of their forces grow.
constexpr double kMostTurnOfJoints = 0.36;

/// Steps of order 5 after one of order 4 that was not exact enough.
constexpr int kStepsOfOrder5 = 16;

/// Shortest step as a share of what the gains require. An error that does not shrink with the step
/// comes from a kink of the geometry.
constexpr double kShortest = 1.0 / 1024.0;

}  // namespace

SmoothMotion::SmoothMotion(const IslandModel& model, std::size_t max_touches, JointForces& joints)
    : forces_(model, max_touches, joints),
      period_(model.settings.haptic_period),
      tolerance_(model.settings.tolerance) {
  const auto size = static_cast<Eigen::Index>(SmoothForces::kMaxSize * model.bodies.size());
  y_.setZero(size);
  next_.setZero(size);
  for (Eigen::ArrayXd& k : k_) k.setZero(size);
  starts_.resize(max_touches);
  chooseLimits(model);
}

/// Largest step that resolves the stiffest contact or coupler. 0.36 rad of the fastest oscillation
/// keeps the energy of an elastic bounce to 1e-6, however small the bounce. 0.8 time constants of
/// the fastest decay keep it stable.
void SmoothMotion::chooseLimits(const IslandModel& model) noexcept {
  double fastest = 0.36 / period_, step = period_;
  const auto limit = [&](double stiffness, double damping, double inverse_mass) {
    const double decay = damping * inverse_mass;
    fastest = std::max(fastest, std::sqrt(stiffness * inverse_mass));
    if (decay > 0.0) step = std::min(step, SmoothForces::kDecayPerStep / decay);
  };
  for (const ModelCoupler& coupler : model.couplers) {
    const ModelBody& body = model.bodies[coupler.follower];
    limit(coupler.settings.linear.stiffness, coupler.settings.linear.damping, body.inverse_mass);
    limit(coupler.settings.angular.stiffness, coupler.settings.angular.damping,
          body.inverse_inertia_B.maxCoeff());
  }
  for (const IslandContact& contact : model.contacts)
    limit(contact.gains.stiffness, contact.gains.damping,
          model.bodies[contact.sphere].mobility + model.bodies[contact.other].mobility);
  for (const ModelGrip& grip : model.grips) {
    if (!grip.is_on) continue;
    const ModelBody& body = model.bodies[grip.hold.body];
    const CouplerSettings& gains = grip.hold.gains;
    const double arm = grip.hold.p_FG.norm(), turning = body.inverse_inertia_B.maxCoeff();
    limit(gains.linear.stiffness, gains.linear.damping,
          model.bodies[grip.hand].inverse_mass + body.inverse_mass + turning * arm * arm);
    limit(gains.angular.stiffness, gains.angular.damping, turning);
  }
  const CouplerGains& obstacle = model.settings.obstacle_contact;
  for (BodyIndex b = 0; b < static_cast<BodyIndex>(model.bodies.size()); ++b) {
    const ModelBody& body = model.bodies[b];
    limit(0.0, body.damping(), body.inverse_mass);
    limit(0.0, body.settings.angular_damping, 1.0);
    if (!body.settings.feels_obstacles) continue;
    limit(obstacle.stiffness, obstacle.damping, body.inverse_mass);
    for (BodyIndex slot : model.slots)
      if (model.bodies[slot].is_active)
        limit(obstacle.stiffness, obstacle.damping,
              body.inverse_mass + model.bodies[slot].mobility);
  }
  const double shortest = period_ / kMaxStepsPerPeriod;
  // Dampers do not count: they do not answer an error of velocity.
  answer_ = 0.9 / fastest;
  max_step_ = std::max({std::min(step, 0.36 / fastest), shortest});
  longest_hold_ = std::max(std::min(step, kMostTurnOfHold / fastest), shortest);
  min_step_ = std::max(kShortest * max_step_, shortest);
  step_ = max_step_;
  const double faster = std::max(1.0, kAnswerOfHands / answer_);
  allowed_error_ = tolerance_ / (faster * faster * faster);
}

void SmoothMotion::choose(const IslandModel& model, const std::vector<char>& together,
                          const std::vector<char>& alone,
                          const std::vector<Touch>& touches) noexcept {
  forces_.choose(model, together, alone, touches);
}

void SmoothMotion::advance(States& states, double dt, IslandCounters& counters) noexcept {
  forces_.load(states, y_.data());
  forces_.evaluate(0.0, y_.data(), k_[0].data(), SmoothForces::Look::kDecide);
  rememberStart();
  int events_left = kMaxEvents;
  for (double done = 0.0; dt - done > 1e-12 * dt;) {
    double h = takeStep(done, dt - done, counters);
    bool changed = hasChanged();
    if (!changed && events_left > 0) {
      // Check for a touch made and broken within the step, or the reverse.
      if (const double t = findHiddenTouch(h); t < h) {
        h = t;
        tryStep(done, h);
        changed = hasChanged();
        --events_left;
      }
    }
    if (changed && events_left > 0) {
      h = locateChange(done, h, counters);
      --events_left;
      ++counters.events;
    }
    ++counters.integrated_steps;
    done += h;
    y_.swap(next_);
    if (changed || forces_.hasTurnedOver()) {
      forces_.evaluate(done, y_.data(), k_[0].data(), SmoothForces::Look::kDecide);
    } else {
      k_[0].swap(k_[6]);
    }
    rememberStart();
  }
  forces_.store(y_.data(), states);
}

double SmoothMotion::takeStep(double from, double rest, IslandCounters& counters) noexcept {
  // Forces of joints are dear: fewer stages first.
  if (forces_.hasJoints() && steps_of_order_5_-- <= 0) {
    steps_of_order_5_ = 0;
    const double h = divideEvenly(rest);
    tryStepOfOrder4(from, h);
    if (acceptsStep(h, estimateErrorOfOrder4(h))) {
      ++counters.steps_of_order_4;
      return h;
    }
    ++counters.rejected_steps;
    steps_of_order_5_ = kStepsOfOrder5;
  }
  for (;;) {
    const double h = divideEvenly(rest);
    tryStep(from, h);
    const double error = estimateError(h);
    if (acceptsStep(h, error)) return h;
    // The margin allows for rounding: the rest is divided evenly.
    const double shortest = computeShortestStep();
    if (h <= shortest * (1.0 + 1e-6)) return h;
    ++counters.rejected_steps;
    step_ = std::max(shortest, (error < 32.0 * allowed_error_ ? 0.5 : 0.25) * h);
  }
}

double SmoothMotion::divideEvenly(double rest) const noexcept {
  return rest / std::max(1.0, std::ceil(rest / step_ * (1.0 - 1e-9)));
}

bool SmoothMotion::acceptsStep(double h, double error) noexcept {
  if (!(error <= (hasPassedEdge() ? kAtEdges * allowed_error_ : allowed_error_))) return false;
  // The error falls with the fourth power of the step at least.
  if (error < allowed_error_ / 64.0) step_ = std::min(std::max(step_, 2.0 * h), max_step_);
  return true;
}

double SmoothMotion::computeShortestStep() const noexcept {
  if (!forces_.hasJoints()) return min_step_;
  double fastest = 0.0;
  for (const SmoothForces::Mover& mover : forces_.movers())
    if (mover.turns)
      fastest = std::max(fastest, y_.segment<3>(mover.offset + SmoothForces::kW).matrix().norm());
  const double shortest = kShortestOfJoints * period_;
  return std::max(min_step_, std::min(shortest, kMostTurnOfJoints / fastest));
}

/// True if a pushed centre passed from over a face to over an edge, or back. The force is smooth
/// there but not its rate, and the estimate of the error may miss that.
bool SmoothMotion::hasPassedEdge() const noexcept {
  std::size_t i = 0;
  for (const SmoothForces::Contact& contact : forces_.contacts())
    if (starts_[i++].under != contact.under && contact.pushes) return true;
  return false;
}

void SmoothMotion::rememberStart() noexcept {
  forces_.acceptFaces();
  std::size_t i = 0;
  for (const SmoothForces::Contact& contact : forces_.contacts())
    starts_[i++] = {contact.overlap, contact.rate, contact.guard, contact.under};
}

bool SmoothMotion::hasChanged() const noexcept {
  for (const SmoothForces::Contact& contact : forces_.contacts())
    if ((contact.guard > 0.0) != contact.pushes) return true;
  return false;
}

double SmoothMotion::findHiddenTouch(double h) const noexcept {
  std::size_t i = 0;
  double earliest = h;
  for (const SmoothForces::Contact& contact : forces_.contacts()) {
    const Start& start = starts_[i++];
    // The overlap has an extremum within the step, on the side where neither end is.
    const double side = contact.pushes ? -1.0 : 1.0;
    if (!(side * start.rate > 0.0 && side * contact.rate < 0.0)) continue;
    const double t = h * start.rate / (start.rate - contact.rate);
    const double top = start.overlap + 0.5 * t * start.rate;
    // Near an end there is nothing to gain.
    if (side * top > 0.0 && t > 0.05 * h && t < 0.95 * h) earliest = std::min(earliest, t);
  }
  return earliest;
}

double SmoothMotion::locateChange(double from, double h, IslandCounters& counters) noexcept {
  // y_ is the state at `from`, next_ that at from + h. False position (Illinois) on the guard of a
  // touch finds the earliest change. It starts with the touch that seems first; an earlier one
  // takes over. The step ends just behind the change.
  const std::vector<SmoothForces::Contact>& contacts = forces_.contacts();
  double late = h;
  for (std::size_t round = 0; round < contacts.size(); ++round) {
    // Find the touch that changes first by linear interpolation, among those changed by `late`.
    int first = -1;
    double first_time = late;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const double end = contacts[i].guard;
      if ((end > 0.0) == contacts[i].pushes) continue;
      const double share = starts_[i].guard / (starts_[i].guard - end);
      const double time = std::isfinite(share) ? late * std::clamp(share, 0.0, 1.0) : 0.0;
      if (first < 0 || time < first_time) first = static_cast<int>(i), first_time = time;
    }
    if (first < 0) break;
    const SmoothForces::Contact& contact = contacts[first];

    double low = 0.0, high = late, at = late;
    double g_low = starts_[first].guard, g_high = contact.guard;
    // A guard that starts on the wrong side by rounding changes at once.
    if ((g_low > 0.0) != contact.pushes) g_low = contact.pushes ? 1e-30 : -1e-30;
    const double exact = 1e-13 + 1e-10 * h;
    int kept = 0;  // the end that the last try has left: -1 low, 1 high
    for (int i = 0; i < 60 && high - low > exact; ++i) {
      double middle = (low * g_high - high * g_low) / (g_high - g_low);
      if (!std::isfinite(middle) || i > 20) middle = 0.5 * (low + high);
      // One end may be the change itself: the other comes near it at once.
      tryStep(from, at = std::clamp(middle, low + 0.5 * exact, high - 0.5 * exact));
      ++counters.event_tries;
      const double g = contact.guard;
      // An end that is left twice counts half, or the other would creep.
      if ((g > 0.0) == contact.pushes) {
        low = at, g_low = g;
        if (std::exchange(kept, 1) == 1) g_high *= 0.5;
      } else {
        high = at, g_high = g;
        if (std::exchange(kept, -1) == -1) g_low *= 0.5;
      }
    }
    if (at != high) tryStep(from, high);
    const bool same = high == late;
    late = high;
    if (same && round > 0) break;
  }
  return late;
}

}  // namespace tandem
