#include "island/rigid_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tandem {
namespace {

/// Bounds of a sweep's tolerance [m/s]. Sweeps end when no velocity changes by more than a tenth of
/// the first sweep's change. The next step corrects the rest, starting from this one's result.
constexpr double kLeastTolerance = 1e-9, kMostTolerance = 1e-7;
/// After this many relaxations the impatient tolerance is enough [m/s]: a row of bodies never
/// converges fully. Small groups may take more sweeps.
constexpr std::size_t kPatientRelaxations = 400;
constexpr double kImpatientTolerance = 1e-6;
constexpr int kMaxSweeps = 30;
/// Overlap that is tolerated, and gap that counts as contact [m]. Corners of a face that differ by
/// rounding would otherwise demand velocities that a rigid body cannot have together.
constexpr double kSlop = 1e-9;
/// Highest speed at which overlap is moved out [m/s].
constexpr double kMaxShiftSpeed = 0.25;
constexpr int kMaxShiftSweeps = 8;
/// A point nearer than this to one of the last step is the same point [m].
constexpr double kSamePoint = 1e-3;
/// Impulses that change a velocity by at most this count as predicted [m/s].
constexpr double kForeseen = 5e-4;
/// A point that opens or closes faster than this at the start of a step has an impact in it [m/s].
constexpr double kImpactSpeed = 1e-4;

}  // namespace

RigidStep::RigidStep(std::size_t body_count, std::size_t contact_capacity)
    : movers_(body_count),
      group_of_(body_count),
      place_of_(body_count),
      held_(body_count),
      allowance_(contact_capacity) {
  contacts_.reserve(contact_capacity);
  points_.reserve(contact_capacity);
  known_.reserve(contact_capacity);
  rows_.reserve(contact_capacity);
  groups_.reserve(body_count);
  members_.reserve(body_count);
}

void RigidStep::forget() noexcept {
  known_.clear();
  allowance_.forget();
  for (Wrench& held : held_) held = {};
}

void RigidStep::holdForces(const States& before) noexcept {
  for (Wrench& held : held_) held = {};
  for (const Known& known : known_) {
    held_[known.a].f_W += known.f_W;
    held_[known.a].t_W += (known.p_W - before[known.a].p_W).cross(known.f_W);
    if (known.b == kStanding) continue;
    held_[known.b].f_W -= known.f_W;
    held_[known.b].t_W -= (known.p_W - before[known.b].p_W).cross(known.f_W);
  }
}

bool RigidStep::correct(const IslandModel& model, ContactFinder& finder, const States& before,
                        double h, States& after) noexcept {
  contacts_.clear();
  finder.find(after, contacts_);
  setUp(model, before, after, h);
  if (points_.empty() && known_.empty()) return true;
  for (Point& point : points_) aim(h, point);
  startFromKnown(after, h);
  solveVelocities();
  sumShifts(h);
  moveOutOfOverlap(h);
  writeBack(after);
  const bool foreseen = wasForeseen();
  keepKnown(h);
  return foreseen;
}

void RigidStep::setUp(const IslandModel& model, const States& before, const States& after,
                      double h) noexcept {
  for (RigidMover& mover : movers_) mover.ready = false;
  const auto getReady = [&](BodyIndex body) {
    if (body != kStanding && !movers_[body].ready)
      movers_[body] = RigidMover(model.bodies[body], after[body]);
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
    Point& point = points_.back();
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
    // A point that is closing at the start of the step has an impact in it.
    const double opening = contact.n_W.dot(velocityBefore(contact.a, arm_a) -
                                           velocityBefore(contact.b, arm_b) - contact.v_W);
    point.lasts = std::abs(opening) < kImpactSpeed;
    const double mean = 0.5 * (opening + point.row.normalVelocity());
    allowance_.look(contact, contact.distance - h * mean);
  }
  allowance_.end();
  for (const Known& known : known_) {
    getReady(known.a);
    getReady(known.b);
  }
}

/// Chooses the wanted normal velocity of a point, and the time at which its impulse acts.
void RigidStep::aim(double h, Point& point) noexcept {
  const double u = point.row.normalVelocity();
  point.distance = point.contact.distance - allowance_.overlapOf(point.contact);
  point.gamma = 0.5;
  if (point.distance > kSlop) {
    // The point is open after the smooth motion. Other impulses may close it but no more. An
    // overlap at the start that held forces have opened asks for no velocity.
    point.row.wanted = std::min(0.0, u - point.distance / (point.gamma * h));
    return;
  }
  if (!point.lasts) point.gamma = u < 0.0 ? std::min(point.distance / (h * u), 1.0) : 1.0;
  const bool bounces = point.contact.restitution > 0.0 && -u > point.contact.min_bounce_speed;
  point.row.wanted = bounces ? -point.contact.restitution * u : 0.0;
}

void RigidStep::startFromKnown(const States& after, double h) noexcept {
  // Contacts keep much the same order, so the search starts after the last match.
  std::size_t next = 0;
  for (Point& point : points_) {
    for (std::size_t i = 0; i < known_.size(); ++i) {
      const std::size_t place = (next + i) % known_.size();
      Known& known = known_[place];
      if (known.taken || known.a != point.contact.a || known.b != point.contact.b) continue;
      if ((known.p_W - point.contact.p_W).squaredNorm() > kSamePoint * kSamePoint) continue;
      known.taken = true;
      next = place + 1;
      point.held = point.row.toLocal(h * PlainVec(known.f_W));
      point.row.impulse = point.held;
      point.row.impulse.n = std::max(0.0, point.held.n);
      break;
    }
  }
  // The held force of a contact that disappeared is taken back.
  for (const Known& known : known_) {
    if (known.taken) continue;
    takeBack(known.a, after, known, -h * known.f_W, h);
    if (known.b != kStanding) takeBack(known.b, after, known, h * known.f_W, h);
  }
}

void RigidStep::takeBack(BodyIndex body, const States& after, const Known& known,
                         const Vec3& impulse_W, double h) noexcept {
  RigidMover& mover = movers_[body];
  const PlainVec dv = multiplyEach(mover.inverse_mass_W, PlainVec(impulse_W));
  const PlainVec dw =
      mover.turnBy(cross(PlainVec(Vec3(known.p_W - after[body].p_W)), PlainVec(impulse_W)));
  mover.v = mover.v + dv;
  mover.w = mover.w + dw;
  mover.shift = mover.shift + (0.5 * h) * dv;
  mover.turn = mover.turn + (0.5 * h) * dw;
}

/// Splits the points into groups of touching bodies. One group may converge and rest while another
/// moves.
void RigidStep::groupPoints() noexcept {
  for (std::size_t b = 0; b < group_of_.size(); ++b) group_of_[b] = static_cast<int>(b);
  for (const Point& point : points_) {
    if (point.contact.b == kStanding) continue;
    const int a = findGroup(point.contact.a), b = findGroup(point.contact.b);
    group_of_[std::max(a, b)] = std::min(a, b);
  }
  groups_.clear();
  for (std::size_t b = 0; b < group_of_.size(); ++b) {
    if (!movers_[b].ready) continue;
    const int root = findGroup(static_cast<BodyIndex>(b));
    if (root == static_cast<int>(b)) {
      place_of_[b] = groups_.size();
      groups_.emplace_back();
    }
    ++groups_[place_of_[static_cast<std::size_t>(root)]].member_count;
  }
  const auto groupOf = [&](BodyIndex body) -> Group& {
    return groups_[place_of_[static_cast<std::size_t>(findGroup(body))]];
  };
  for (const Point& point : points_) ++groupOf(point.contact.a).row_count;
  std::size_t row = 0, member = 0;
  for (Group& group : groups_) {
    group.first_row = row;
    group.first_member = member;
    row += std::exchange(group.row_count, 0);
    member += std::exchange(group.member_count, 0);
  }
  rows_.resize(row);
  members_.resize(member);
  // First the first point of each pair, then the second, and so on. Neighbours in the list share no
  // body, so the processor works on several at once.
  for (std::size_t left = points_.size(), round = 0; left > 0; ++round) {
    std::size_t in_pair = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const RigidContact& contact = points_[i].contact;
      const bool same =
          i > 0 && contact.a == points_[i - 1].contact.a && contact.b == points_[i - 1].contact.b;
      in_pair = same ? in_pair + 1 : 0;
      if (in_pair != round) continue;
      Group& group = groupOf(contact.a);
      rows_[group.first_row + group.row_count++] = &points_[i].row;
      --left;
    }
  }
  for (std::size_t b = 0; b < group_of_.size(); ++b) {
    if (!movers_[b].ready) continue;
    Group& group = groupOf(static_cast<BodyIndex>(b));
    members_[group.first_member + group.member_count++] = static_cast<BodyIndex>(b);
  }
}

/// The lowest body of the group of `body`.
int RigidStep::findGroup(BodyIndex body) noexcept {
  int group = group_of_[body];
  while (group_of_[group] != group) group = group_of_[group];
  group_of_[body] = group;
  return group;
}

void RigidStep::solveVelocities() noexcept {
  point_count_ += points_.size();
  groupPoints();
  for (const Group& group : groups_)
    if (group.row_count > 0) solve(group);
}

void RigidStep::solve(const Group& group) noexcept {
  double tolerance = 0.0;
  const auto patient_sweeps = static_cast<int>(kPatientRelaxations / group.row_count);
  (void)measureChange(group);
  const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(group.first_row);
  const auto last = first + static_cast<std::ptrdiff_t>(group.row_count);
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    relaxation_count_ += group.row_count;
    // Alternate the direction, so that a change at one end of a row reaches the other in one sweep.
    if (sweep % 2 == 0) {
      for (auto row = first; row != last; ++row) (*row)->solve();
    } else {
      for (auto row = last; row != first;) (*--row)->solve();
    }
    const double change = measureChange(group);
    if (sweep == 0) tolerance = std::clamp(0.1 * change, kLeastTolerance, kMostTolerance);
    if (change < (sweep < patient_sweeps ? tolerance : kImpatientTolerance)) return;
  }
}

/// Largest change of a body's velocity since the last call [m/s]. Points may still share a load
/// differently without it: four corners can do so in many ways.
double RigidStep::measureChange(const Group& group) noexcept {
  double change = 0.0;
  for (std::size_t i = 0; i < group.member_count; ++i) {
    RigidMover& mover = movers_[members_[group.first_member + i]];
    const PlainVec dv = mover.v - mover.v_last, dw = mover.w - mover.w_last;
    change = std::max({change, dot(dv, dv), mover.radius_squared * dot(dw, dw)});
    mover.v_last = mover.v;
    mover.w_last = mover.w;
  }
  return std::sqrt(change);
}

void RigidStep::sumShifts(double h) noexcept {
  for (Point& point : points_) {
    const RigidRow::Local& impulse = point.row.impulse;
    const double time = point.gamma * h;
    point.row.shift({time * (impulse.n - point.held.n), time * (impulse.s - point.held.s),
                     time * (impulse.t - point.held.t)});
  }
}

void RigidStep::moveOutOfOverlap(double h) noexcept {
  for (Point& point : points_) {
    const double distance = point.distance + point.row.normalShift();
    point.aim_distance = std::min(0.0, distance + kMaxShiftSpeed * h);
    point.shift = 0.0;
  }
  for (int sweep = 0; sweep < kMaxShiftSweeps; ++sweep) {
    double most = 0.0;
    for (Point& point : points_) {
      const double missing = point.aim_distance - point.distance - point.row.normalShift();
      const double shift_before = point.shift;
      point.shift = std::max(0.0, shift_before + missing * point.row.inverse_normal);
      const double change = point.shift - shift_before;
      if (change == 0.0) continue;
      point.row.shift({change, 0.0, 0.0});
      most = std::max(most, std::abs(change) / point.row.inverse_normal);
    }
    if (most < kSlop) return;
  }
}

void RigidStep::writeBack(States& after) noexcept {
  for (std::size_t b = 0; b < movers_.size(); ++b) {
    const RigidMover& mover = movers_[b];
    if (!mover.ready) continue;
    RigidState& state = after[b];
    state.v_W = mover.v.toVec3();
    state.w_W = mover.w.toVec3();
    state.p_W += mover.shift.toVec3();
    const Vec3 turn_W = mover.turn.toVec3();
    const double angle = turn_W.norm();
    if (angle > 0.0)
      state.q_WB = (Quat(Eigen::AngleAxisd(angle, turn_W / angle)) * state.q_WB).normalized();
  }
}

/// True if every lasting contact kept its predicted impulse and none disappeared.
bool RigidStep::wasForeseen() const noexcept {
  for (const Known& known : known_)
    if (!known.taken) return false;
  for (const Point& point : points_) {
    if (!point.lasts) continue;
    const RigidRow::Local& impulse = point.row.impulse;
    const double change =
        std::hypot(impulse.n - point.held.n, impulse.s - point.held.s, impulse.t - point.held.t);
    if (change > kForeseen * point.row.inverse_normal) return false;
  }
  return true;
}

void RigidStep::keepKnown(double h) noexcept {
  known_.clear();
  for (const Point& point : points_)
    if (point.lasts && point.row.impulse.n > 0.0)
      known_.push_back({point.contact.a, point.contact.b, point.contact.p_W,
                        point.row.toWorld(point.row.impulse).toVec3() / h, false});
}

}  // namespace tandem
