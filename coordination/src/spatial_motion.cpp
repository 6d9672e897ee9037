#include "spatial_motion.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// A body alone is still watched when something comes this close [m].
constexpr double kWatchDistance = 1e-4;

/// Contacts that chatter are not followed for ever: after this many events in an inner step one may
/// be hidden.
constexpr int kMaxEventsPerStep = 32;

/// Inner steps in a tick at the most, however stiff.
constexpr double kMaxStepsPerTick = 2048;

/// Largest inner step at which Runge-Kutta 4 resolves the stiffest contact or coupler: a quarter
/// radian of the fastest oscillation, half of the fastest decay.
double chooseInnerStep(const IslandModel& model) {
  double step = model.settings.inner_step;
  const auto limit = [&](double stiffness, double damping, double inverse_mass) {
    const double frequency = std::sqrt(stiffness * inverse_mass);
    const double decay = damping * inverse_mass;
    if (frequency > 0.0) step = std::min(step, 0.25 / frequency);
    if (decay > 0.0) step = std::min(step, 0.5 / decay);
  };
  // How easily a push anywhere on the surface moves the surface there.
  const auto mobility = [&](BodyIndex b) {
    const ModelBody& body = model.bodies[b];
    const double turn = body.inverse_inertia_B.maxCoeff();
    return body.inverse_mass +
           (turn > 0.0 ? turn * body.bounding_radius * body.bounding_radius : 0.0);
  };
  for (const ModelCoupler& coupler : model.couplers) {
    const ModelBody& body = model.bodies[coupler.follower];
    limit(coupler.settings.linear.stiffness, coupler.settings.linear.damping, body.inverse_mass);
    limit(coupler.settings.angular.stiffness, coupler.settings.angular.damping,
          body.inverse_inertia_B.maxCoeff());
  }
  for (const ModelContact& contact : model.contacts)
    limit(contact.gains.stiffness, contact.gains.damping,
          mobility(contact.sphere) + mobility(contact.other));
  for (BodyIndex b = 0; b < static_cast<BodyIndex>(model.bodies.size()); ++b) {
    const ModelBody& body = model.bodies[b];
    limit(0.0, body.settings.damping, body.inverse_mass);
    if (body.settings.feels_obstacles)
      limit(model.settings.obstacle_contact.stiffness, model.settings.obstacle_contact.damping,
            body.inverse_mass);
  }
  return std::max(step, model.settings.haptic_period / kMaxStepsPerTick);
}

/// Capacity for spheres on obstacles; nearest ones count, and more than these never touch one
/// fingertip.
constexpr std::size_t kMaxObstacleTouches = 64;

}  // namespace

SpatialMotion::SpatialMotion(const IslandModel& model) : inner_step_(chooseInnerStep(model)) {
  const std::size_t n = model.bodies.size();
  alone_maps_.resize(n);
  for (std::size_t b = 0; b < n; ++b) {
    const ModelBody& body = model.bodies[b];
    if (!body.isDynamic()) continue;
    double stiffness = 0.0, damping = body.settings.damping;
    for (const ModelCoupler& coupler : model.couplers) {
      if (coupler.follower != static_cast<BodyIndex>(b)) continue;
      stiffness += coupler.settings.linear.stiffness;
      damping += coupler.settings.linear.damping;
    }
    const auto scalar = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
    alone_maps_[b] =
        LinearMap(model.settings.haptic_period, Eigen::VectorXd::Constant(1, body.settings.mass),
                  scalar(damping), scalar(stiffness));
  }
  alone_.resize(n);
  together_.resize(n);
  rigid_near_.resize(n);
  touches_.reserve(model.contacts.size() + kMaxObstacleTouches);
  guards_.reserve(touches_.capacity());
  for (States* states : {&states_, &start_, &next_, &before_rigid_}) states->resize(n);
  for (auto* rates : {&k1_, &k2_, &k3_, &k4_}) rates->resize(n);
  wrenches_.resize(n);
}

/// Keeps the touches whose gap `is_near` accepts, as many as there is room for.
template <typename IsNear>
void SpatialMotion::collectTouches(const IslandModel& model, IsNear is_near) noexcept {
  touches_.clear();
  forEachTouch(model, [&](const Touch& touch) {
    if (touches_.size() < touches_.capacity() &&
        is_near(touch, computeTouchState(model, touch, states_).geometry.gap))
      touches_.push_back(touch);
  });
}

void SpatialMotion::advance(IslandModel& model, double dt) noexcept {
  const std::size_t n = model.bodies.size();
  for (std::size_t b = 0; b < n; ++b) states_[b] = model.bodies[b].state;
  findLoners(model, dt);
  start_ = states_;

  advanceTogether(model, dt);
  advanceAlone(model, dt);
  if (!wasAlone(model)) {
    states_ = start_;
    for (std::size_t b = 0; b < n; ++b) {
      together_[b] = model.bodies[b].isDynamic();
      alone_[b] = 0;
    }
    collectTouches(model, [](const Touch&, double) { return true; });
    advanceTogether(model, dt);
  }
  for (std::size_t b = 0; b < n; ++b) model.bodies[b].state = states_[b];
}

void SpatialMotion::findLoners(const IslandModel& model, double dt) noexcept {
  const auto travel = [&](BodyIndex b) {
    const RigidState& s = states_[b];
    return 2.0 * dt * (s.v_W.norm() + s.w_W.norm() * model.bodies[b].bounding_radius);
  };
  collectTouches(model, [&](const Touch& touch, double gap) {
    return gap < travel(touch.sphere) + travel(touch.other) + kWatchDistance;
  });

  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    alone_[b] = body.isDynamic();
    rigid_near_[b] = body.settings.is_rigid && model.rigid &&
                     model.rigid->isNear(static_cast<BodyIndex>(b), body.state,
                                         travel(static_cast<BodyIndex>(b)) + kWatchDistance);
    if (rigid_near_[b]) alone_[b] = 0;
  }
  for (const Touch& touch : touches_) alone_[touch.sphere] = alone_[touch.other] = 0;

  // Turning is integrated even for a body alone, unless it is at rest.
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    bool turns =
        body.rotates() && (body.state.w_W != Vec3::Zero() || body.t_external_W != Vec3::Zero());
    for (const ModelCoupler& coupler : model.couplers)
      if (coupler.follower == static_cast<BodyIndex>(b) && body.rotates())
        turns |= computeCouplerWrench(coupler, body.state).t_W != Vec3::Zero();
    together_[b] = body.isDynamic() && (!alone_[b] || turns);
  }
}

void SpatialMotion::advanceAlone(const IslandModel& model, double dt) noexcept {
  const std::uint64_t parts = countParts(dt, model.settings.haptic_period);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    if (!body.isDynamic()) states_[b] = extrapolate(body, dt);
    if (!alone_[b]) continue;
    Vec3 u = body.f_external_W;
    for (const ModelCoupler& coupler : model.couplers)
      if (coupler.follower == static_cast<BodyIndex>(b))
        u += coupler.settings.linear.stiffness * coupler.target.p_W +
             coupler.settings.linear.damping * coupler.target.v_W;
    for (int axis = 0; axis < 3; ++axis) {
      double state[2] = {start_[b].p_W[axis], start_[b].v_W[axis]};
      const double rate = 0.0;
      for (int level = 0; level < LinearMap::kLevels; ++level) {
        if (!(parts & kPartsPerPeriod >> level)) continue;
        double next[2];
        alone_maps_[b].step(level, state, &u[axis], &rate, next);
        state[0] = next[0], state[1] = next[1];
      }
      states_[b].p_W[axis] = state[0];
      states_[b].v_W[axis] = state[1];
    }
  }
}

bool SpatialMotion::wasAlone(const IslandModel& model) const noexcept {
  if (std::none_of(alone_.begin(), alone_.end(), [](char alone) { return alone; })) return true;
  bool met = false;
  forEachTouch(model, [&](const Touch& touch) {
    if (alone_[touch.sphere] || alone_[touch.other])
      met |= computeTouchState(model, touch, states_).geometry.gap <= 0.0;
  });
  return !met;
}

void SpatialMotion::advanceTogether(const IslandModel& model, double dt) noexcept {
  if (std::none_of(together_.begin(), together_.end(), [](char together) { return together; }))
    return;
  const double count = std::ceil(dt / inner_step_ * (1.0 - 1e-9));
  const double h = dt / count;
  for (double i = 0; i < count; ++i) {
    if (model.rigid) before_rigid_ = states_;
    advanceSmoothly(model, h);
    if (model.rigid) correctRigid(model, h);
  }
}

void SpatialMotion::correctRigid(const IslandModel& model, double h) noexcept {
  bool any = false;
  for (BodyIndex b = 0; b < static_cast<BodyIndex>(model.bodies.size()); ++b) {
    if (!rigid_near_[b] || !together_[b]) continue;
    model.rigid->predict(b, before_rigid_[b], states_[b]);
    any = true;
  }
  if (!any) return;
  model.rigid->solve(h);
  for (BodyIndex b = 0; b < static_cast<BodyIndex>(model.bodies.size()); ++b)
    if (rigid_near_[b] && together_[b]) model.rigid->correct(b, states_[b]);
}

void SpatialMotion::updateModes(const IslandModel& model, const States& states) noexcept {
  for (Touch& touch : touches_)
    touch.pushes = computePush(touch, computeTouchState(model, touch, states)) > 0.0;
}

double SpatialMotion::computeGuard(const IslandModel& model, const Touch& touch,
                                   const States& states) const noexcept {
  // Positive exactly while the contact pushes; in metres, so that both parts weigh alike.
  const TouchState state = computeTouchState(model, touch, states);
  const double scale = touch.gains.stiffness + touch.gains.damping / inner_step_;
  if (!(scale > 0.0)) return -1.0;
  const double push =
      touch.gains.stiffness * state.overlap() + touch.gains.damping * state.overlap_rate;
  return std::min(state.overlap(), push / scale);
}

void SpatialMotion::advanceSmoothly(const IslandModel& model, double h) noexcept {
  updateModes(model, states_);
  for (int events = 0; h > 0.0; ++events) {
    rungeKutta(model, states_, h, next_);
    double done = h;
    const bool changed = std::any_of(touches_.begin(), touches_.end(), [&](const Touch& touch) {
      return (computeGuard(model, touch, next_) > 0.0) != touch.pushes;
    });
    if (changed && events < kMaxEventsPerStep) done = locateEvent(model, h);
    states_.swap(next_);
    if (changed) updateModes(model, states_);
    h = done < h ? h - done : 0.0;
  }
}

double SpatialMotion::locateEvent(const IslandModel& model, double h) noexcept {
  // States at 0 are states_, at h next_. Find the earliest change by false position (Illinois) on
  // the guard of the touch that seems to change first; another that turns out to be earlier takes
  // over. Ends just behind it.
  double late = h;
  guards_.clear();
  for (const Touch& touch : touches_) guards_.push_back(computeGuard(model, touch, states_));

  for (std::size_t round = 0; round < touches_.size(); ++round) {
    // Which of the touches that have changed by `late` changes first, on a straight line?
    int first = -1;
    double first_time = late;
    for (std::size_t i = 0; i < touches_.size(); ++i) {
      const double end = computeGuard(model, touches_[i], next_);
      if ((end > 0.0) == touches_[i].pushes) continue;
      const double share = guards_[i] / (guards_[i] - end);
      const double time = std::isfinite(share) ? late * std::clamp(share, 0.0, 1.0) : 0.0;
      if (first < 0 || time < first_time) first = static_cast<int>(i), first_time = time;
    }
    if (first < 0) break;
    const Touch& touch = touches_[first];

    double low = 0.0, high = late;
    double g_low = guards_[first], g_high = computeGuard(model, touch, next_);
    // A guard that starts on the wrong side by rounding changes at once.
    if ((g_low > 0.0) != touch.pushes) g_low = touch.pushes ? 1e-30 : -1e-30;
    for (int i = 0; i < 60 && high - low > 1e-13 + 1e-10 * h; ++i) {
      double middle = (low * g_high - high * g_low) / (g_high - g_low);
      if (!(middle > low && middle < high) || i > 20) middle = 0.5 * (low + high);
      rungeKutta(model, states_, middle, next_);
      const double g = computeGuard(model, touch, next_);
      if ((g > 0.0) == touch.pushes) {
        low = middle, g_low = g, g_high *= 0.5;
      } else {
        high = middle, g_high = g, g_low *= 0.5;
      }
    }
    rungeKutta(model, states_, high, next_);
    const bool same = high == late;
    late = high;
    if (same && round > 0) break;
  }
  return late;
}

void SpatialMotion::rungeKutta(const IslandModel& model, const States& from, double h,
                               States& to) noexcept {
  computeRates(model, from, k1_);
  setStage(model, from, k1_, 0.5 * h, to);
  computeRates(model, to, k2_);
  setStage(model, from, k2_, 0.5 * h, to);
  computeRates(model, to, k3_);
  setStage(model, from, k3_, h, to);
  computeRates(model, to, k4_);
  for (std::size_t b = 0; b < from.size(); ++b) {
    if (!together_[b]) continue;
    k1_[b].v = (k1_[b].v + 2.0 * (k2_[b].v + k3_[b].v) + k4_[b].v) / 6.0;
    k1_[b].a = (k1_[b].a + 2.0 * (k2_[b].a + k3_[b].a) + k4_[b].a) / 6.0;
    k1_[b].alpha = (k1_[b].alpha + 2.0 * (k2_[b].alpha + k3_[b].alpha) + k4_[b].alpha) / 6.0;
    k1_[b].q_dot = (k1_[b].q_dot + 2.0 * (k2_[b].q_dot + k3_[b].q_dot) + k4_[b].q_dot) / 6.0;
  }
  setStage(model, from, k1_, h, to);
}

void SpatialMotion::setStage(const IslandModel& model, const States& from,
                             const std::vector<Rates>& rates, double h, States& to) const noexcept {
  for (std::size_t b = 0; b < from.size(); ++b) {
    to[b] = from[b];
    if (together_[b]) {
      to[b].p_W += h * rates[b].v;
      to[b].v_W += h * rates[b].a;
      if (model.bodies[b].rotates()) {
        to[b].w_W += h * rates[b].alpha;
        to[b].q_WB.coeffs() += h * rates[b].q_dot;
        to[b].q_WB.normalize();
      }
    } else if (model.bodies[b].settings.motion == Motion::kPrescribed) {
      to[b].p_W += h * from[b].v_W;
    }
  }
}

void SpatialMotion::computeRates(const IslandModel& model, const States& states,
                                 std::vector<Rates>& rates) noexcept {
  for (std::size_t b = 0; b < states.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    wrenches_[b].f_W = body.f_external_W - body.settings.damping * states[b].v_W;
    wrenches_[b].t_W = body.t_external_W;
  }
  for (const ModelCoupler& coupler : model.couplers) {
    const Wrench wrench = computeCouplerWrench(coupler, states[coupler.follower]);
    wrenches_[coupler.follower].f_W += wrench.f_W;
    wrenches_[coupler.follower].t_W += wrench.t_W;
  }
  for (const Touch& touch : touches_) {
    if (!touch.pushes) continue;
    // Not clipped inside a step: the law stays smooth, and the step ends where it would change.
    const TouchState state = computeTouchState(model, touch, states);
    const double push =
        touch.gains.stiffness * state.overlap() + touch.gains.damping * state.overlap_rate;
    addPush(model, touch, state, push, states, wrenches_);
  }
  for (std::size_t b = 0; b < states.size(); ++b) {
    if (!together_[b]) continue;
    const ModelBody& body = model.bodies[b];
    rates[b].v = states[b].v_W;
    rates[b].a = body.inverse_mass * wrenches_[b].f_W;
    rates[b].alpha.setZero();
    rates[b].q_dot.setZero();
    if (!body.rotates()) continue;
    // Euler's equation in B: I w' = t - w x I w.
    const Quat& q = states[b].q_WB;
    const Vec3 w_B = q.conjugate() * states[b].w_W;
    const Vec3 t_B = q.conjugate() * wrenches_[b].t_W;
    const Vec3 alpha_B = body.inverse_inertia_B.cwiseProduct(
        t_B - w_B.cross(body.settings.inertia_B.cwiseProduct(w_B)));
    rates[b].alpha = q * alpha_B;
    const Quat spin(0.0, states[b].w_W.x(), states[b].w_W.y(), states[b].w_W.z());
    rates[b].q_dot = 0.5 * (spin * q).coeffs();
  }
}

}  // namespace tandem
