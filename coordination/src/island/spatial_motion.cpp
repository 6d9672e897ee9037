#include "island/spatial_motion.h"

#include <algorithm>
#include <cmath>

#include "island/follow_faces.h"
#include "island/rest.h"

namespace tandem {
namespace {

/// Stiff springs shorten a step with rigid contact to SmoothMotion::longestHold(), but not below
/// this part of the inner step.
constexpr double kShortestInnerStep = 1.0 / 64.0;

/// Steps as multiples of the inner step: where contact lasts, and where it comes and goes.
constexpr double kLastingSteps = 4.0, kShortPartOfStep = 0.5;
/// Tries of steps in an advance after which each is taken as it is.
constexpr int kMaxTries = 48;

/// Most touches of spheres on obstacles; one fingertip never touches more.
constexpr std::size_t kMaxObstacleTouches = 64;

/// Most touches per slot; HIP and proxies are few.
constexpr std::size_t kMaxSlotTouches = 4;

/// Most touches of spheres on parts of compounds and pieces of meshes that move, besides one each.
constexpr std::size_t kMaxPartTouches = 64;

std::size_t countMostTouches(const IslandModel& model) {
  return model.contacts.size() + kMaxObstacleTouches + kMaxSlotTouches * model.slots.size() +
         kMaxPartTouches;
}

std::size_t countMostContacts(const IslandModel& model) {
  return model.finder ? kMaxRigidContacts : 0;
}

std::size_t countMostJoints(const IslandModel& model) { return model.joints ? kMaxJoints : 0; }

bool areOfOneShape(const Touch& a, const Touch& b) noexcept {
  return a.sphere == b.sphere && a.other == b.other && a.obstacle == b.obstacle && a.part == b.part;
}

bool isSame(const Touch& a, const Touch& b) noexcept {
  return areOfOneShape(a, b) && a.piece == b.piece;
}

bool any(const std::vector<char>& flags) noexcept {
  return std::any_of(flags.begin(), flags.end(), [](char flag) { return flag; });
}

}  // namespace

SpatialMotion::SpatialMotion(const IslandModel& model)
    : joints_(model.bodies.size(), countMostJoints(model)),
      joint_memory_aside_(countMostJoints(model)),
      rigid_step_(model.bodies.size(), countMostContacts(model), countMostJoints(model), joints_),
      rigid_step_aside_(model.bodies.size(), countMostContacts(model), countMostJoints(model),
                        joints_),
      tally_(countMostContacts(model)),
      smooth_(model, countMostTouches(model), joints_),
      sleepers_(model) {
  const std::size_t n = model.bodies.size();
  alone_motion_.resize(n);
  for (std::size_t b = 0; b < n; ++b) prepareAlone(model, static_cast<BodyIndex>(b));
  for (auto* flags : {&alone_, &turns_, &together_, &rigid_near_, &resting_, &awake_, &at_rest_,
                      &joined_, &moves_, &resting_aside_})
    flags->resize(n);
  for (auto* values : {&allowance_, &reach_, &still_, &still_aside_}) values->resize(n);
  touches_.reserve(countMostTouches(model));
  for (States* states : {&states_, &before_rigid_}) states->resize(n);
  f_W_.resize(n);
}

void SpatialMotion::refill(const IslandModel& model, BodyIndex slot) noexcept {
  prepareAlone(model, slot);
  alone_[slot] = turns_[slot] = together_[slot] = awake_[slot] = resting_[slot] = 0;
  reach_[slot] = -1.0;
  still_[slot] = 0.0;
  smooth_.chooseLimits(model);
}

void SpatialMotion::refit(const IslandModel& model, BodyIndex b, bool is_damping) noexcept {
  prepareAlone(model, b);
  // A change of shares does not matter: full gains are the fastest.
  if (is_damping) smooth_.chooseLimits(model);
}

void SpatialMotion::setAside() noexcept {
  std::swap(rigid_step_, rigid_step_aside_);
  std::swap(joints_.memory(), joint_memory_aside_);
  rigid_step_.forget();
  joints_.memory().forget();
  is_aside_ = true;
  resting_aside_ = resting_;
  still_aside_ = still_;
}

void SpatialMotion::takeBack(const IslandModel& model,
                             const std::vector<BodyIndex>& slots) noexcept {
  std::swap(rigid_step_, rigid_step_aside_);
  std::swap(joints_.memory(), joint_memory_aside_);
  is_aside_ = false;
  for (std::size_t b = 0; b < resting_.size(); ++b) prepareAlone(model, static_cast<BodyIndex>(b));
  smooth_.chooseLimits(model);
  resting_ = resting_aside_;
  still_ = still_aside_;
  for (BodyIndex slot : slots) {
    resting_[slot] = 0;
    still_[slot] = 0.0;
  }
}

void SpatialMotion::prepareAlone(const IslandModel& model, BodyIndex b) noexcept {
  const ModelBody& body = model.bodies[b];
  Alone& alone = alone_motion_[b];
  alone = {};
  double stiffness = 0.0;
  // Uneven factors leave the body's own damping alone: it acts apart.
  double damping = body.factors.way_is_even ? body.damping() / body.factors.linear : 0.0;
  for (const ModelCoupler& coupler : model.couplers) {
    if (coupler.follower != b) continue;
    stiffness += coupler.now.linear.stiffness;
    damping += coupler.now.linear.damping;
    const CouplerGains& angular = coupler.now.angular;
    alone.is_tied_to_turn |= angular.stiffness != 0.0 || angular.damping != 0.0;
  }
  alone.stiffness = stiffness * body.inverse_mass;
  alone.damping = damping * body.inverse_mass;
  alone.map = computeOscillatorMap(alone.stiffness, alone.damping, model.settings.haptic_period);
}

bool SpatialMotion::advance(IslandModel& model, double dt, IslandCounters& counters) noexcept {
  if (!model.is_listed) model.listPresent();
  for (const BodyIndex b : model.present) states_[b] = model.bodies[b].state;
  findLoners(model, dt, counters);
  if (!is_aside_) tally_.startAdvance();
  rigid_step_.mark();

  if (any(together_)) {
    joints_.choose(model, together_);
    smooth_.choose(model, together_, alone_, touches_);
    advanceTogether(model, dt, counters);
  }
  advanceAlone(model, dt);
  if (mustRepeat(model, dt)) {
    ++counters.repeated;
    if (!is_aside_) tally_.startAdvance();
    rigid_step_.goBack();
    joints_.memory().goBack();
    double way = 0.0;
    for (const BodyIndex b : model.present)
      way = std::max(way, (states_[b].p_W - model.bodies[b].state.p_W).norm());
    for (const BodyIndex b : model.present) {
      states_[b] = model.bodies[b].state;
      together_[b] = model.bodies[b].isDynamic();
      resting_[b] = 0;
      alone_[b] = turns_[b] = 0;
    }
    touches_.clear();
    forEachTouch(model, [&](const Touch& touch) {
      const bool is_mesh = isWholeMesh(model, touch);
      double allowance = allowance_[touch.sphere] + way;
      if (!touch.obstacle) allowance += allowance_[touch.other] + way;
      // Parts and pieces are many; only those nearby have room.
      if ((is_mesh || touch.part) && !couldMeet(model, touch, states_, allowance)) return;
      if (!is_mesh) return addTouch(model, touch);
      forEachPiece(model, touch, states_, allowance,
                   [&](const Touch& piece, double) { addTouch(model, piece); });
    });
    joints_.choose(model, together_);
    smooth_.choose(model, together_, alone_, touches_);
    advanceTogether(model, dt, counters);
    advanceAlone(model, dt);
  }
  if (!is_aside_) tally_.endAdvance();
  if (model.finder) letRest(model, dt);
  bool at_rest = true;
  for (const BodyIndex b : model.present) {
    at_rest_[b] = seemsAtRest(model.bodies[b], states_[b], dt);
    at_rest = at_rest && at_rest_[b];
    model.bodies[b].state = states_[b];
  }
  return at_rest;
}

void SpatialMotion::findLoners(IslandModel& model, double dt, IslandCounters& counters) noexcept {
  for (const BodyIndex b : model.present) {
    const ModelBody& body = model.bodies[b];
    const RigidState& s = states_[b];
    double speed = s.v_W.norm();
    if (s.w_W != Vec3::Zero()) speed += s.w_W.norm() * body.bounding_radius;
    allowance_[b] = 2.0 * dt * speed + 0.5 * kWatchDistance;
  }
  findJoined(model);
  sleepers_.wakeNear(model, states_, allowance_);
  findTouches(model, counters);
  lookAround(model);
  for (const BodyIndex b : model.present)
    alone_[b] = model.bodies[b].isDynamic() && !rigid_near_[b] && !resting_[b] && !joined_[b];
  for (const Touch& touch : touches_) alone_[touch.sphere] = alone_[touch.other] = 0;
  for (const int g : model.present_grips)
    alone_[model.grips[g].hand] = alone_[model.grips[g].hold.body] = 0;

  for (const BodyIndex b : model.present) {
    const ModelBody& body = model.bodies[b];
    counters.resting_bodies += resting_[b] != 0;
    const bool turning = body.rotates() && !resting_[b] && needsTurning(model, b);
    // A round body without torque keeps its axis: exact. So does one with uneven factors. All other
    // rotation is integrated.
    turns_[b] = turning && alone_[b] && body.turnsSteadily() && !alone_motion_[b].is_tied_to_turn &&
                body.t_external_W == Vec3::Zero();
    together_[b] = body.isDynamic() && !resting_[b] && (!alone_[b] || (turning && !turns_[b]));
    counters.exact_bodies += alone_[b] != 0;
    counters.exact_turns += turns_[b] != 0;
    counters.integrated_bodies += together_[b] != 0;
  }
}

void SpatialMotion::findTouches(IslandModel& model, IslandCounters& counters) noexcept {
  touches_.clear();
  model.faces.startLook();
  const auto allowanceOf = [&](const Touch& touch) {
    return allowance_[touch.sphere] + (touch.obstacle ? 0.0 : allowance_[touch.other]);
  };
  const auto look = [&](Touch& touch) {
    const double allowance = allowanceOf(touch);
    if (!couldMeet(model, touch, states_, allowance)) {
      ++counters.contact_searches_skipped;
      return;
    }
    ++counters.contact_searches;
    if (isWholeMesh(model, touch))
      followPieces(model, states_, touch, allowance,
                   [&](const Touch& piece) { addTouch(model, piece); });
    else if (followFace(model, states_, touch, allowance) < allowance)
      addTouch(model, touch);
  };
  forEachTouch(model, look, [&](const Touch& whole) {
    const bool could_meet = couldMeetAnyPart(model, whole, states_, allowanceOf(whole));
    counters.contact_searches_skipped += !could_meet;
    return could_meet;
  });
  model.faces.endLook();
}

void SpatialMotion::addTouch(const IslandModel& model, const Touch& touch) noexcept {
  if (touches_.size() == touches_.capacity()) return;
  touches_.push_back(touch);
  recall(model, touches_.back());
}

bool SpatialMotion::needsTurning(const IslandModel& model, BodyIndex b) const noexcept {
  const ModelBody& body = model.bodies[b];
  if (body.state.w_W != Vec3::Zero() || body.t_external_W != Vec3::Zero()) return true;
  if (!alone_motion_[b].is_tied_to_turn) return false;
  for (const int c : model.present_couplers) {
    const ModelCoupler& coupler = model.couplers[c];
    if (coupler.follower == b && (coupler.target.w_W != Vec3::Zero() ||
                                  coupler.target.q_WB.coeffs() != body.state.q_WB.coeffs()))
      return true;
  }
  return false;
}

void SpatialMotion::advanceAlone(const IslandModel& model, double dt) noexcept {
  for (const BodyIndex b : model.present)
    if (alone_[b]) f_W_[b] = model.bodies[b].f_external_W;
  // Sum of all forces except those of dampers on a body's own velocity.
  for (const int c : model.present_couplers) {
    const ModelCoupler& coupler = model.couplers[c];
    const BodyIndex b = coupler.follower;
    if (!alone_[b]) continue;
    const CouplerGains& gains = coupler.now.linear;
    f_W_[b] += gains.stiffness * (coupler.target.p_W - model.bodies[b].state.p_W) +
               gains.damping * coupler.target.v_W;
  }
  const bool is_period = dt == model.settings.haptic_period;
  for (const BodyIndex b : model.present) {
    const ModelBody& body = model.bodies[b];
    if (body.settings.motion == Motion::kPrescribed) states_[b] = extrapolate(body, dt);
    if (!alone_[b]) continue;
    const Alone& alone = alone_motion_[b];
    if (turns_[b]) turnAlone(body, dt, states_[b]);
    if (!body.factors.way_is_even) [[unlikely]] {
      goAloneByFactors(body, alone, f_W_[b], dt, states_[b]);
      continue;
    }
    const OscillatorMap map =
        is_period ? alone.map : computeOscillatorMap(alone.stiffness, alone.damping, dt);
    const Vec3 a_W = body.inverse_mass * f_W_[b];
    const Vec3& v_W = body.state.v_W;
    states_[b].p_W = body.state.p_W + map.velocity_to_way * v_W + map.acceleration_to_way * a_W;
    states_[b].v_W = map.velocity_to_velocity * v_W + map.acceleration_to_velocity() * a_W;
  }
}

/// Each axis of W has a mass of its own.
[[gnu::noinline]] void SpatialMotion::goAloneByFactors(const ModelBody& body, const Alone& alone,
                                                       const Vec3& f_W, double dt,
                                                       RigidState& state) noexcept {
  for (int i = 0; i < 3; ++i) {
    const double share = body.factors.way_W[i];
    const OscillatorMap map =
        computeOscillatorMap(share * alone.stiffness, share * alone.damping + body.decay(), dt);
    const double a = share * body.inverse_mass * f_W[i], v = body.state.v_W[i];
    state.p_W[i] = body.state.p_W[i] + map.velocity_to_way * v + map.acceleration_to_way * a;
    state.v_W[i] = map.velocity_to_velocity * v + map.acceleration_to_velocity() * a;
  }
}

void SpatialMotion::turnAlone(const ModelBody& body, double dt, RigidState& state) const noexcept {
  const OscillatorMap map = computeOscillatorMap(0.0, body.settings.angular_damping, dt);
  const Vec3 w_W = body.state.w_W;
  const double speed = w_W.norm();
  // The square of a tiny one is 0.
  if (speed == 0.0) return;
  const Quat turn(Eigen::AngleAxisd(map.velocity_to_way * speed, w_W / speed));
  state.q_WB = (turn * body.state.q_WB).normalized();
  state.w_W = map.velocity_to_velocity * w_W;
}

bool SpatialMotion::mustRepeat(IslandModel& model, double dt) noexcept {
  // If no body moved farther than its allowance, none met another.
  bool far = false;
  for (const BodyIndex b : model.present) {
    const RigidState &from = model.bodies[b].state, &to = states_[b];
    double way = (to.p_W - from.p_W).norm();
    if (to.w_W != Vec3::Zero())
      way += dt * std::max(from.w_W.norm(), to.w_W.norm()) * model.bodies[b].bounding_radius;
    far |= !(way <= allowance_[b]);
  }
  if (!far) return false;
  if (sleepers_.wakeNear(model, states_, allowance_)) return true;

  // Includes pairs in which each body already touched something else.
  bool met = false;
  std::size_t known = 0;
  forEachTouch(model, [&](const Touch& touch) {
    if (isWholeMesh(model, touch)) {
      const std::size_t first = known;
      while (known < touches_.size() && areOfOneShape(touches_[known], touch)) ++known;
      if (!couldMeet(model, touch, states_, 0.0)) return;
      forEachPiece(model, touch, states_, 0.0, [&](const Touch& piece, double gap) {
        met |= gap <= 0.0 && std::none_of(touches_.begin() + first, touches_.begin() + known,
                                          [&](const Touch& other) { return isSame(other, piece); });
      });
    } else if (known < touches_.size() && isSame(touches_[known], touch)) {
      ++known;
    } else if (couldMeet(model, touch, states_, 0.0)) {
      met |= computeTouchState(model, touch, states_).geometry.gap <= 0.0;
    }
  });
  return met;
}

void SpatialMotion::advanceTogether(const IslandModel& model, double dt,
                                    IslandCounters& counters) noexcept {
  bool near_rigid = !joints_.isEmpty();
  for (const BodyIndex b : model.present) near_rigid |= rigid_near_[b] && together_[b];
  if (!near_rigid) {
    rigid_step_.forget();
    joints_.memory().forget();
    smooth_.hold(rigid_step_.heldForces());
    return smooth_.advance(states_, dt, counters);
  }
  advanceWithRigid(model, dt, counters);
}

/// Steps as long as contacts last, and short ones where they come or go.
void SpatialMotion::advanceWithRigid(const IslandModel& model, double dt,
                                     IslandCounters& counters) noexcept {
  // Springs faster than a step would push a body against a rigid one for a whole step before that
  // one responds.
  const double inner = model.settings.inner_step;
  const double longest =
      std::clamp(smooth_.longestHold(), kShortestInnerStep * inner, kLastingSteps * inner);
  const double shortest = std::min(kShortPartOfStep * inner, longest);
  double length = longest;
  int tries_left = kMaxTries;
  rigid_step_.startAdvance();
  if (were_joined_pushed_) rigid_step_.answerBlows(model, states_);
  for (double rest = dt; rest > 1e-12 * dt;) {
    // Even parts: a short last step would cost as much as a long one.
    double h = rest / std::max(1.0, std::ceil(rest / length * (1.0 - 1e-9)));
    for (const BodyIndex b : model.present) before_rigid_[b] = states_[b];
    rigid_step_.begin();
    for (bool is_done = false; !is_done; --tries_left) {
      ++counters.rigid_steps;
      for (const BodyIndex b : model.present) states_[b] = before_rigid_[b];
      const bool may_repeat = tries_left > 0 && rigid_step_.hasWorkLeft();
      rigid_step_.holdForces(states_, h, may_repeat);
      joints_.trustLoad(!rigid_step_.knowsContacts());
      smooth_.hold(rigid_step_.heldForces());
      const std::uint64_t events_before = counters.events;
      smooth_.advance(states_, h, counters);
      const bool has_kink = counters.events != events_before;
      // Prescribed bodies move on with the others.
      for (const BodyIndex b : model.present)
        if (model.bodies[b].settings.motion == Motion::kPrescribed) goOn(states_[b], h);
      const double next =
          rigid_step_.correct(model, before_rigid_, h, shortest, may_repeat, has_kink, states_);
      is_done = rigid_step_.isDone();
      if (!is_done) h = std::min(next, rest);
    }
    counters.rigid_points = rigid_step_.points();
    counters.rigid_relaxations = rigid_step_.relaxations();
    counters.rigid_factorisations = rigid_step_.factorisations();
    rest -= h;
    length = std::min(2.0 * std::max(h, shortest), longest);
    if (is_aside_) continue;
    tally_.startStep(h);
    rigid_step_.visitPoints([&](const RigidContact& contact, const Vec3& impulse_W) {
      tally_.count(contact, impulse_W);
    });
    const JointHold* before = nullptr;
    rigid_step_.visitHolds([&](const JointHold& hold) {
      const bool is_first = !before || before->joint != hold.joint;
      model.joints->note(hold.joint, hold.row, hold.steady + hold.blow, h, is_first);
      before = &hold;
    });
  }
  if (tries_left <= 0 || !rigid_step_.hasWorkLeft()) ++counters.rigid_bounded;
}

}  // namespace tandem
