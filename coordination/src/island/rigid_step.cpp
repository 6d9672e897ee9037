#include "island/rigid_step.h"

#include <algorithm>
#include <cmath>

#include "island/impulse_sweeps.h"

namespace tandem {
namespace {

/// Gap of a new point that stands, or strikes with another, by rounding: it is closed as a known
/// one [m].
constexpr double kRounding = 1e-7;
/// Speed below which bodies stand on each other [m/s].
constexpr double kStandSpeed = 1e-6;
/// A point that moved with a body to this distance belongs to it, or hardly rolls [m].
constexpr double kSamePlace = 1e-6;
/// A new point that approaches faster has an impact [m/s].
constexpr double kImpactSpeed = 1e-3;
/// Overlap with which an impact is wanted, and how exactly [m].
constexpr double kImpactOverlap = 5e-9;
/// Steps shorter than this part of the shortest, up to an impact, tell nothing of forces.
constexpr double kTellingPart = 0.25;
constexpr int kMaxImpactTries = 8;
/// A coupler that yields lets the second try be off by a part of the first.
constexpr int kMaxTimesLearned = 2;
/// Error of position that a change of force may make in a step [m].
constexpr double kAllowedError = 3e-8;
/// Change of velocity by held forces, and of contacts against it, that is no error of foresight
/// [m/s].
constexpr double kThrown = 5.0;
/// Rows of a joint, on average.
constexpr std::size_t kMostHolds = 8;

}  // namespace

RigidStep::RigidStep(std::size_t body_count, std::size_t contact_capacity, std::size_t max_joints,
                     JointForces& joints)
    : movers_(body_count),
      held_(body_count),
      joints_(&joints),
      groups_(body_count, contact_capacity, max_joints * kMostHolds),
      memory_(contact_capacity),
      solver_(body_count, contact_capacity, max_joints * kMostHolds),
      allowance_(contact_capacity),
      allowance_before_(contact_capacity),
      allowance_marked_(contact_capacity) {
  contacts_.reserve(contact_capacity);
  points_.reserve(contact_capacity);
  gaps_.reserve(contact_capacity);
  ways_.reserve(max_joints * kMostHolds);
  holds_.reserve(max_joints * kMostHolds);
  if (max_joints > 0) joint_rows_.reserve(static_cast<std::size_t>(kMostJointRows));
}

void RigidStep::forget() noexcept {
  if (!knows_) return;
  knows_ = false;
  memory_.forget();
  allowance_.forget();
  for (HeldWrench& held : held_) held = {};
}

void RigidStep::begin() noexcept {
  allowance_before_ = allowance_;
  times_learned_ = 0;
  impact_tries_ = 0;
  latest_ = HUGE_VAL;
  is_let_go_ = false;
}

void RigidStep::holdForces(const States& before, double h, bool may_repeat) noexcept {
  knows_ = true;
  for (HeldWrench& held : held_) held = {};
  if (is_let_go_) memory_.forgetForces();
  if (is_let_go_ || !may_repeat) return memory_.letGo();
  memory_.hold(before, h, held_);
}

double RigidStep::correct(const IslandModel& model, const States& before, double h, double shortest,
                          bool may_repeat, bool has_kink, States& after) noexcept {
  is_done_ = true;
  contacts_.clear();
  if (model.finder) model.finder->find(after, contacts_);
  setUp(model, before, after, h);
  setUpJoints(model, before, after, h);
  if (points_.empty() && holds_.empty() && memory_.isEmpty()) return h;
  const auto repeat = [&](double next) {
    is_done_ = false;
    allowance_ = allowance_before_;
    return next;
  };
  const auto startAgain = [&] {
    times_learned_ = 0;
    memory_.startAgain();
    joints_->memory().startAgain();
  };
  if (const double impact = findImpacts(h); impact != h && may_repeat) {
    startAgain();
    return repeat(impact);
  }
  aim(h);
  takeBackGone(after, h);
  solveSteady(h);
  const double change = may_repeat && !is_let_go_ ? measureChange(after) : 0.0;
  if (change > kThrown && hasThrown(after, h)) {
    startAgain();
    is_let_go_ = true;
    return repeat(h);
  }
  if (h * change > kAllowedError) {
    // Joints are never held: without contact only their modes are to learn.
    const bool has_contact = !points_.empty() || memory_.hasGone();
    // No even force is that of a step with a kink.
    const bool is_long = h > shortest * (1.0 + 1e-9);
    if (times_learned_ < kMaxTimesLearned && !(has_kink && is_long) &&
        (hasUnknownForce() || haveJointModesChanged() ||
         (has_contact && h * measureEvents() < kAllowedError))) {
      ++times_learned_;
      memory_.learn(points_, after, h);
      learnJointModes();
      return repeat(h);
    }
    if (is_long) {
      startAgain();
      return repeat(std::max(shortest, 0.5 * h));
    }
  }
  moveOutOfOverlap(h);
  solveImpacts();
  writeBack(after);
  memory_.keep(points_, after, h, kTellingPart * shortest);
  learnJointModes();
  joints_->memory().keep();
  return h;
}

void RigidStep::setUp(const IslandModel& model, const States& before, const States& after,
                      double h) noexcept {
  for (RigidMover& mover : movers_) mover.ready = false;
  const auto getReady = [&](BodyIndex body) {
    if (body == kStanding || mover(body).ready) return;
    RigidMover& made = mover(body);
    made = RigidMover(model.bodies[body], after[body]);
    made.way = PlainVec(Vec3(after[body].p_W - before[body].p_W));
    made.back = PlainRotation(before[body].q_WB * after[body].q_WB.conjugate());
  };
  const auto armOf = [&](BodyIndex body, const Vec3& p_W) {
    return body == kStanding ? Vec3::Zero() : Vec3(p_W - after[body].p_W);
  };
  const auto velocityBefore = [&](BodyIndex body, const Vec3& arm) {
    return body == kStanding ? Vec3::Zero() : Vec3(before[body].v_W + before[body].w_W.cross(arm));
  };
  points_.clear();
  allowance_.begin();
  for (const RigidContact& contact : contacts_) {
    getReady(contact.a);
    getReady(contact.b);
    const Vec3 arm_a = armOf(contact.a, contact.p_W), arm_b = armOf(contact.b, contact.p_W);
    points_.emplace_back();
    ContactPoint& point = points_.back();
    point.contact = contact;
    point.row.setUp(mover(contact.a), mover(contact.b), PlainVec(arm_a), PlainVec(arm_b),
                    PlainVec(contact.n_W), PlainVec(contact.v_W));
    point.row.friction = contact.friction;
    point.row.rolling = contact.rolling;
    point.row.spinning = contact.spinning;
    if (!point.row.canMove()) {
      points_.pop_back();
      continue;
    }
    const Vec3 before_W =
        velocityBefore(contact.a, arm_a) - velocityBefore(contact.b, arm_b) - contact.v_W;
    point.opening = contact.n_W.dot(before_W);
    point.stood = before_W.squaredNorm() < kStandSpeed * kStandSpeed;
    const PlainVec way = wayOf(contact.a, contact, after) - wayOf(contact.b, contact, after);
    point.at_start = contact.distance - dot(PlainVec(contact.n_W), way - h * PlainVec(contact.v_W));
    allowance_.look(contact, point.at_start);
  }
  allowance_.end();
  for (ContactPoint& point : points_) {
    point.row.distance = point.contact.distance - allowance_.overlapOf(point.contact);
    point.at_start -= allowance_.overlapOf(point.contact);
  }
  memory_.match(points_, h);
  guessOpenPoints();
  for (ContactPoint& point : points_) anchor(point, after, h);
  memory_.visitGone([&](BodyIndex a, BodyIndex b, const auto&...) {
    getReady(a);
    getReady(b);
  });
}

/// Way of the point of a body that is at the contact since the start of the step [m].
PlainVec RigidStep::wayOf(BodyIndex body, const RigidContact& contact,
                          const States& after) noexcept {
  if (body == kStanding) return {};
  return mover(body).wayOf(PlainVec(Vec3(contact.p_W - after[body].p_W)));
}

/// Points that touched beside others of their pair, and had no force, are likely to have none.
void RigidStep::guessOpenPoints() noexcept {
  const auto isKnown = [](const ContactPoint& point) { return point.known >= 0; };
  forEachPair(points_, [&](auto first, auto last) {
    const bool have_met = std::any_of(first, last, isKnown);
    for (auto point = first; point != last; ++point) {
      point->have_met = have_met;
      const bool touched = std::abs(point->at_start) < kSmallGap && point->opening > -kImpactSpeed;
      if (have_met && !isKnown(*point) && touched) point->row.mode = RigidRow::Mode::kOpen;
    }
  });
}

/// A point that stuck, and belongs to one of its bodies, has slipped by the ways of both.
/// Velocities do not tell: a force that begins within the step moves bodies before friction knows
/// of it.
void RigidStep::anchor(ContactPoint& point, const States& after, double h) noexcept {
  RigidRow& row = point.row;
  const bool is_known = point.known >= 0;
  const bool stuck = is_known ? point.mode_before == RigidRow::Mode::kStick
                              : point.stood && std::abs(point.at_start) < kRounding;
  if (!stuck) return;
  const RigidContact& contact = point.contact;
  const PlainVec way_a = wayOf(contact.a, contact, after), way_b = wayOf(contact.b, contact, after);
  row.slip = row.toLocal(way_a - way_b - h * PlainVec(contact.v_W));
  row.is_anchored = true;
  if (!is_known) return;
  const PlainVec seen = PlainVec(contact.p_W) - memory_.startOf(point);
  const PlainVec off_a = seen - way_a, off_b = seen - way_b;
  row.is_anchored = std::min(dot(off_a, off_a), dot(off_b, off_b)) < kSamePlace * kSamePlace;
}

/// Marks new points that close within the step. Returns h if they close at its end, or else a
/// length at which the first of them does, by Newton's method.
double RigidStep::findImpacts(double h) noexcept {
  double earliest = HUGE_VAL;
  bool is_late = false, has_struck = false;
  const auto strikes = [](const ContactPoint& point) {
    if (point.known >= 0 || point.row.normalVelocity() > -kImpactSpeed) return false;
    // Else it stood there, and nothing was known of its force.
    return point.at_start >= kImpactOverlap || point.opening <= -kImpactSpeed;
  };
  for (ContactPoint& point : points_) {
    if (!strikes(point)) continue;
    point.is_impact = point.row.distance <= kSlop;
    has_struck |= point.is_impact;
    // Overlap that was there before is no matter of this step. Of two that had not met it gets no
    // deeper; inner edges of a mesh that is known would stop what slides over it.
    if (point.have_met && point.at_start < -kRounding) continue;
    const double depth = point.row.distance - std::min(0.0, point.at_start);
    earliest = std::min(earliest, (depth + kImpactOverlap) / -point.row.normalVelocity());
    is_late |= depth < -2.0 * kImpactOverlap;
  }
  // Corners of an edge that differ by rounding strike together: one alone would turn the body.
  if (has_struck)
    for (ContactPoint& point : points_)
      point.is_impact |= strikes(point) && point.row.distance < kRounding;
  for (JointHold& hold : holds_) {
    const double u = hold.reach * hold.speed(), way = hold.reach * hold.row.way;
    const double at_start = hold.reach * hold.at_start;
    if (!hold.isLimit() || hold.mode != JointMode::kIdle || u > -kImpactSpeed) continue;
    if (at_start < kImpactOverlap && hold.reach * hold.opening > -kImpactSpeed) continue;
    hold.is_impact = way <= kSlop;
    if (at_start < -2.0 * kImpactOverlap) continue;
    earliest = std::min(earliest, (way + kImpactOverlap) / -u);
    is_late |= way < -2.0 * kImpactOverlap;
  }
  if (earliest == HUGE_VAL || impact_tries_ >= kMaxImpactTries) return h;
  const bool is_early = impact_tries_ > 0 && earliest > 0.0 && h + earliest < latest_;
  if (!is_late && !is_early) return h;
  if (is_late) latest_ = std::min(latest_, h);
  ++impact_tries_;
  const double shorter = h + earliest;
  return shorter > 0.0 ? shorter : 0.01 * h;
}

/// Chooses the wanted normal velocity of each point.
void RigidStep::aim(double h) noexcept {
  for (ContactPoint& point : points_) {
    RigidRow& row = point.row;
    const double u = row.normalVelocity();
    row.wanted = 0.0;
    if (point.known >= 0 && std::abs(row.distance) < kSmallGap) continue;
    // Some corners that stand carry, others just miss, and they swap by rounding.
    if (std::abs(row.distance) < kRounding && point.opening > -kImpactSpeed) continue;
    // An open point may be closed by other impulses, but no more. An overlap at the start that held
    // forces have opened asks for no velocity.
    if (row.distance > kSlop) row.wanted = std::min(0.0, u - row.distance / (0.5 * h));
  }
  for (JointHold& hold : holds_) {
    hold.wanted = hold.row.speed;
    if (!hold.isLimit()) continue;
    if (hold.is_impact) hold.low = hold.high = 0.0;
    if (hold.mode == JointMode::kHolds || hold.reach * hold.row.way < kRounding) continue;
    hold.wanted = std::min(0.0, hold.speed() - hold.row.way / (0.5 * h));
  }
}

/// Takes back the held force of each contact that has gone.
void RigidStep::takeBackGone(const States& after, double h) noexcept {
  const auto push = [&](BodyIndex body, const PlainVec& p_W, const PlainVec& impulse_W,
                        const PlainVec& twist_W) {
    RigidMover& moved = mover(body);
    const PlainVec dv = multiplyEach(moved.inverse_mass_W, impulse_W);
    const PlainVec dw = moved.turnBy(cross(p_W - PlainVec(after[body].p_W), impulse_W) + twist_W);
    moved.v = moved.v + dv;
    moved.w = moved.w + dw;
    moved.shift = moved.shift + (0.5 * h) * dv;
    moved.turn = moved.turn + (0.5 * h) * dw;
  };
  memory_.visitGone(
      [&](BodyIndex a, BodyIndex b, const PlainVec& p_W, const PlainVec& f_W, const PlainVec& t_W) {
        push(a, p_W, -h * f_W, -h * t_W);
        if (b != kStanding) push(b, p_W, h * f_W, h * t_W);
      });
}

/// Solves for forces over the step, without impacts.
void RigidStep::solveSteady(double h) noexcept {
  point_count_ += points_.size();
  solver_.begin();
  groups_.make(points_, holds_, movers_,
               [](const ContactPoint& point) { return !point.is_impact; });
  for (const ContactGroups::Group& group : groups_.groups()) {
    if (isAnswered(group)) continue;
    const bool is_settled = solve(group);
    for (std::size_t i = 0; i < group.row_count; ++i) {
      RigidRow& row = *group.rows[i];
      const double time = 0.5 * h;
      row.shift({time * (row.impulse.n - row.held.n), time * (row.impulse.s - row.held.s),
                 time * (row.impulse.t - row.held.t)});
    }
    for (std::size_t i = 0; i < group.hold_count; ++i) {
      JointHold& hold = *group.holds[i];
      hold.steady = hold.impulse;
      hold.shift(0.5 * h * (hold.impulse - hold.held));
    }
    if (is_settled) closeGaps(group, h);
  }
  for (ContactPoint& point : points_) {
    point.steady = point.is_impact ? RigidRow::Local{} : point.row.impulse;
    point.steady_twist = point.is_impact ? RigidRow::Local{} : point.row.twist;
  }
}

/// Largest change of a body's velocity that was not foreseen [m/s].
double RigidStep::measureChange(const States& after) const noexcept {
  double most = 0.0;
  for (std::size_t b = 0; b < movers_.size(); ++b) {
    const RigidMover& moved = movers_[b];
    if (!moved.ready) continue;
    const PlainVec dv = moved.v - PlainVec(after[b].v_W), dw = moved.w - PlainVec(after[b].w_W);
    most = std::max(most, moved.squareOf(dv, dw));
  }
  return std::sqrt(most);
}

/// True if what was held moved a body, and contacts took it back: the forces of a jam are large,
/// and of no use once its contacts are a little different.
bool RigidStep::hasThrown(const States& after, double h) const noexcept {
  const auto isTakenBack = [](const PlainVec& given, const PlainVec& change, double scale) {
    const double least = kThrown * kThrown;
    return dot(given, change) < 0.0 && scale * dot(given, given) > least &&
           scale * dot(change, change) > least;
  };
  for (std::size_t b = 0; b < movers_.size(); ++b) {
    const RigidMover& moved = movers_[b];
    if (!moved.ready) continue;
    const HeldWrench& held = held_[b];
    const PlainVec push(Vec3(h * (held.start.f_W + 0.5 * h * held.rate.f_W)));
    const PlainVec twist(Vec3(h * (held.start.t_W + 0.5 * h * held.rate.t_W)));
    const PlainVec dv = moved.v - PlainVec(after[b].v_W), dw = moved.w - PlainVec(after[b].w_W);
    if (isTakenBack(multiplyEach(moved.inverse_mass_W, push), dv, 1.0) ||
        isTakenBack(moved.turnBy(twist), dw, moved.radius_squared))
      return true;
  }
  return false;
}

/// True if a point pushes of which no force was known.
bool RigidStep::hasUnknownForce() const noexcept {
  return std::any_of(points_.begin(), points_.end(), [&](const ContactPoint& point) {
    return point.steady.n > 0.0 && !memory_.hasForce(point);
  });
}

/// Largest velocity by which a point breaks the law that held it in the last step [m/s]. Where none
/// does, forces have changed without an event.
double RigidStep::measureEvents() const noexcept {
  using Mode = RigidRow::Mode;
  if (memory_.hasGone()) return HUGE_VAL;
  double most = 0.0;
  for (const ContactPoint& point : points_) {
    const RigidRow& row = point.row;
    if (point.known < 0 || point.mode_before == row.mode) continue;
    if (row.is_swept) return HUGE_VAL;
    const double slip = std::hypot(row.velocityAlong(1), row.velocityAlong(2));
    const double spare = row.friction * row.impulse.n - std::hypot(row.impulse.s, row.impulse.t);
    const double broken = row.mode == Mode::kOpen    ? row.normalVelocity()
                          : row.mode == Mode::kStick ? spare / row.inverse_normal
                                                     : slip;
    most = std::max(most, broken);
  }
  return most;
}

/// Solves for impulses that act at the end of the step. All points that touch take part.
void RigidStep::solveImpacts() noexcept {
  const auto isImpact = [](const auto& one) { return one.is_impact; };
  if (std::none_of(points_.begin(), points_.end(), isImpact) &&
      std::none_of(holds_.begin(), holds_.end(), isImpact))
    return;
  for (JointHold& hold : holds_) hold.startBlow();
  for (ContactPoint& point : points_) {
    RigidRow& row = point.row;
    const double u = row.normalVelocity();
    const RigidContact& contact = point.contact;
    const bool bounces =
        point.is_impact && contact.restitution > 0.0 && -u > contact.min_bounce_speed;
    row.wanted = bounces ? -contact.restitution * u : 0.0;
    row.held = row.impulse = row.twist_held = row.twist = {};
    row.mode = RigidRow::Mode::kUnknown;
  }
  // First as if nothing else touched, then with all: a blow spreads from where it struck. Where
  // several ways share it, that chooses one.
  const auto solveAll = [&](auto counts) {
    groups_.make(points_, holds_, movers_, counts);
    solver_.beginImpacts();
    for (const ContactGroups::Group& group : groups_.groups()) (void)solve(group);
    for (ContactPoint& point : points_) {
      point.row.held = point.row.impulse;
      point.row.twist_held = point.row.twist;
      point.row.mode = RigidRow::Mode::kUnknown;
    }
    for (JointHold& hold : holds_) hold.held = hold.impulse;
  };
  solveAll([](const ContactPoint& point) { return point.is_impact; });
  solveAll([](const ContactPoint& point) {
    return point.is_impact || point.steady.n > 0.0 || point.row.distance <= kSlop;
  });
  for (ContactPoint& point : points_) point.blow = point.row.impulse;
  for (JointHold& hold : holds_) hold.endBlow();
}

/// False if sweeps had to do what the solver could not.
bool RigidStep::solve(const ContactGroups::Group& group) noexcept {
  if (solver_.solve(group.rows, group.row_count, group.movers, group.mover_count, group.holds,
                    group.hold_count))
    return true;
  relaxation_count_ += sweepImpulses(group);
  return false;
}

}  // namespace tandem
