#include "island/contact_memory.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// A point nearer than this to one of the last step may be the same [m].
constexpr double kSamePoint = 1e-3;
/// A point as near as this to where it was expected is the same [m].
constexpr double kCertain = 1e-6;
/// Points and normals may go so much faster than surfaces roll and slip: a rolling ball is at the
/// limit, and rounding passes it.
constexpr double kMargin = 1.01;
/// Cosine of the angle between normals of the same point.
constexpr double kSameNormal = 0.7;

/// Forces are not foreseen farther than this, as a multiple of the time that their rate was seen.
constexpr double kFarthest = 2.5;

/// Rotates a vector by a small angle; right to its third power.
Vec3 turn(const Vec3& v, const Vec3& angle) noexcept {
  const Vec3 first = angle.cross(v);
  return v + first + 0.5 * angle.cross(first);
}

/// Rotates a vector along with a direction, the shortest way.
Vec3 turnAlong(const Vec3& v, const Vec3& from, const Vec3& to) noexcept {
  if (from == to) return v;
  const Vec3 axis = from.cross(to);
  const double cosine = from.dot(to);
  if (cosine <= 0.0) return Vec3::Zero();
  return v + axis.cross(v) + axis.cross(axis.cross(v)) / (1.0 + cosine);
}

struct Velocity {
  Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();
};

/// Velocity of the point of a body, or of a fixed surface, and how it turns.
Velocity velocityAt(BodyIndex body, const Vec3& p_W, const States& states) noexcept {
  if (body == kStanding) return {};
  const RigidState& state = states[static_cast<std::size_t>(body)];
  return {state.v_W + state.w_W.cross(p_W - state.p_W), state.w_W};
}

/// Velocity of a contact point that went at `seen_W` in the last step; `arm_W` leads to it from the
/// centre of a. It is a corner of a body, or goes along curved surfaces at most as fast as they
/// roll and slip. Else the finder has chosen another point.
Vec3 followPoint(const Vec3& seen_W, const Velocity& of_a, const Velocity& of_b,
                 const Vec3& arm_W) noexcept {
  const double off_a = (seen_W - of_a.v_W).squaredNorm();
  const double off_b = (seen_W - of_b.v_W).squaredNorm();
  const double off = std::min(off_a, off_b);
  const double slip = (of_a.v_W - of_b.v_W).squaredNorm();
  // Most points slip at least as fast, and need no root.
  if (off <= kMargin * kMargin * slip) return seen_W;
  const double roll = std::sqrt(arm_W.squaredNorm() * (of_a.w_W - of_b.w_W).squaredNorm());
  const double most = kMargin * (std::sqrt(slip) + roll);
  if (off <= most * most) return seen_W;
  return off_b < off_a ? of_b.v_W : of_a.v_W;
}

/// Turning rate of a normal that went at `seen_W`: with a body, or as fast as curved surfaces roll
/// and slip at most. Else the finder has chosen another normal.
Vec3 followNormal(const Vec3& seen_W, const Velocity& of_a, const Velocity& of_b,
                  const Vec3& arm_W) noexcept {
  const double seen = seen_W.squaredNorm();
  const double turn_a = of_a.w_W.squaredNorm(), turn_b = of_b.w_W.squaredNorm();
  if (seen <= kMargin * kMargin * (turn_a + turn_b)) return seen_W;
  const double slip = (of_a.v_W - of_b.v_W).norm(), reach = arm_W.norm();
  const double most =
      kMargin * (std::sqrt(turn_a) + std::sqrt(turn_b) + (reach > 0.0 ? slip / reach : 0.0));
  if (seen <= most * most) return seen_W;
  const bool is_nearer_a = (seen_W - of_a.w_W).squaredNorm() < (seen_W - of_b.w_W).squaredNorm();
  return is_nearer_a ? of_a.w_W : of_b.w_W;
}

}  // namespace

ContactMemory::ContactMemory(std::size_t capacity) {
  known_.reserve(capacity);
  trial_.reserve(capacity);
  learned_.reserve(capacity);
}

void ContactMemory::forget() noexcept {
  known_.clear();
  trial_.clear();
}

void ContactMemory::shiftOrigin(const Vec3& offset_W) noexcept {
  for (std::vector<Known>* list : {&known_, &trial_})
    for (Known& known : *list) known.p_W += offset_W;
}

/// A force that changes evenly moves a body by h^3 / 12 of its rate less than its mean does, and
/// what the body leans on by as much.
void ContactMemory::hold(const States& before, double h, std::vector<HeldWrench>& held) noexcept {
  const double half = 0.5 * h;
  for (Known& known : trial_) {
    known.is_taken = false;
    const double ahead = 0.5 * (known.last.h + h);
    Vec3 f_W = known.is_learned ? known.f_learned_W : known.last.f_W;
    Vec3 rate_W = Vec3::Zero();
    if (ahead < kFarthest * known.base) {
      rate_W = known.slope_W;
      const double time = known.is_learned ? half : ahead;
      const double size = time * time * rate_W.squaredNorm(), most = f_W.squaredNorm();
      if (size > most) rate_W *= std::sqrt(most / size);
      if (!known.is_learned) f_W += ahead * rate_W;
    }
    // A contact does not pull.
    const bool pushes = f_W.dot(known.n_W) > 0.0;
    known.f_held_W = pushes ? turn(f_W, half * known.turn_W) : Vec3(Vec3::Zero());
    known.t_held_W = known.is_learned ? known.t_learned_W : known.last.t_W;
    known.p_held_W = known.p_W + half * known.v_W;
    if (pushes)
      rate_W += known.turn_W.cross(known.f_held_W);
    else
      rate_W.setZero();
    const auto push = [&](BodyIndex body, double sign) {
      const RigidState& state = before[static_cast<std::size_t>(body)];
      const Vec3 arm_W = known.p_held_W - (state.p_W + half * state.v_W);
      const Vec3 t_rate_W = arm_W.cross(rate_W) + Vec3(known.v_W - state.v_W).cross(known.f_held_W);
      const Vec3 t_W = arm_W.cross(known.f_held_W) + known.t_held_W;
      held[static_cast<std::size_t>(body)].add(
          {known.f_held_W - half * rate_W, t_W - half * t_rate_W}, {rate_W, t_rate_W}, sign);
    };
    push(known.a, 1.0);
    if (known.b != kStanding) push(known.b, -1.0);
  }
}

void ContactMemory::letGo() noexcept {
  for (Known& known : trial_) {
    known.is_taken = false;
    known.f_held_W = known.t_held_W = Vec3::Zero();
    known.p_held_W = known.p_W;
  }
}

void ContactMemory::forgetForces() noexcept {
  for (Known& known : trial_) {
    known.last.f_W = known.last.t_W = Vec3::Zero();
    known.is_learned = false;
  }
}

/// The nearest point of the same two bodies or surfaces that is free. Points come pair by pair, and
/// in much the same order as before.
ContactMemory::Known* ContactMemory::findNearest(const ContactPoint& point, double h) noexcept {
  const RigidContact& contact = point.contact;
  const std::size_t count = trial_.size();
  if (next_ >= count) next_ = 0;
  const auto isFree = [&](const Known& known) {
    return !known.is_taken && known.n_W.dot(contact.n_W) >= kSameNormal;
  };
  const auto expected = [&](const Known& known) {
    return (known.p_W + h * known.v_W - contact.p_W).squaredNorm();
  };
  // Where it is expected no other can be as near.
  if (count > 0 && areOfOnePair(trial_[next_], contact) && isFree(trial_[next_]) &&
      expected(trial_[next_]) < kCertain * kCertain)
    return &trial_[next_++];
  std::size_t looked = 0, first = next_;
  if (first > 0 && areOfOnePair(trial_[first - 1], contact)) --first;
  while (looked < count && !areOfOnePair(trial_[first], contact))
    first = (first + 1) % count, ++looked;
  if (looked == count) return nullptr;
  while (first > 0 && areOfOnePair(trial_[first - 1], contact)) --first;
  Known* nearest = nullptr;
  double least = kSamePoint * kSamePoint;
  for (std::size_t i = first; i < count && areOfOnePair(trial_[i], contact); ++i) {
    Known& known = trial_[i];
    if (!isFree(known)) continue;
    const double way = std::min(expected(known), (known.p_W - contact.p_W).squaredNorm());
    if (way >= least) continue;
    least = way;
    nearest = &known;
  }
  if (nearest) next_ = static_cast<std::size_t>(nearest - trial_.data()) + 1;
  return nearest;
}

void ContactMemory::match(std::vector<ContactPoint>& points, double h) noexcept {
  next_ = 0;
  for (ContactPoint& point : points) {
    Known* known = findNearest(point, h);
    if (!known) continue;
    known->is_taken = true;
    point.known = static_cast<int>(known - trial_.data());
    const Vec3& n_W = point.contact.n_W;
    const Vec3 n_held_W = turn(known->n_W, 0.5 * h * known->turn_W).normalized();
    const Vec3 f_W = known->is_learned ? known->f_learned_W : known->last.f_W;
    RigidRow& row = point.row;
    row.held = row.toLocal(h * PlainVec(turnAlong(known->f_held_W, n_held_W, n_W)));
    row.impulse = row.toLocal(h * PlainVec(turnAlong(f_W, known->n_W, n_W)));
    row.impulse.n = std::max(0.0, row.impulse.n);
    row.mode = point.mode_before = known->mode;
    row.slide = row.toLocal(PlainVec(known->slide_W));
    row.twist_held = row.twist = row.toLocal(h * PlainVec(known->t_held_W));
  }
}

/// Force that a known point was expected to have [N].
double ContactMemory::expectedForceOf(const ContactPoint& point) const noexcept {
  if (point.known < 0) return 0.0;
  const Known& known = trial_[static_cast<std::size_t>(point.known)];
  return (known.is_learned ? known.f_learned_W : known.last.f_W).norm();
}

/// Where bodies are jammed, sweeps ask for impulses that do not fall with the step's length: what
/// is beyond the expected force is not foreseen.
void ContactMemory::limit(Force& force, double most) noexcept {
  const double size = force.f_W.norm();
  if (size <= most) return;
  force.f_W *= most / size;
  force.t_W *= most / size;
}

/// A point as it is known after a step.
ContactMemory::Known ContactMemory::describe(const ContactPoint& point, const States& after,
                                             double h) const noexcept {
  const RigidContact& contact = point.contact;
  Known known{};
  known.a = contact.a;
  known.b = contact.b;
  known.surface = contact.surface;
  known.mode = point.row.mode;
  known.slide_W = point.row.toWorld(point.row.slide).toVec3();
  known.p_W = contact.p_W;
  known.n_W = contact.n_W;
  known.slope_W.setZero();
  known.base = 0.0;
  const Velocity of_a = velocityAt(contact.a, contact.p_W, after);
  const Velocity of_b = velocityAt(contact.b, contact.p_W, after);
  // The arm of a new point stays.
  known.v_W = after[static_cast<std::size_t>(contact.a)].v_W;
  known.turn_W = of_b.w_W;
  known.last = {point.row.toWorld(point.steady).toVec3() / h,
                point.row.toWorld(point.steady_twist).toVec3() / h, contact.n_W, h, 1};
  if (point.row.is_swept) limit(known.last, expectedForceOf(point));
  if (point.known < 0) return known;
  const Known& old = trial_[static_cast<std::size_t>(point.known)];
  const Vec3 arm_W = contact.p_W - after[static_cast<std::size_t>(contact.a)].p_W;
  known.v_W = followPoint((contact.p_W - old.p_W) / h, of_a, of_b, arm_W);
  const Vec3 spin_W = contact.n_W * contact.n_W.dot(of_b.w_W);
  known.turn_W = followNormal(old.n_W.cross(contact.n_W) / h + spin_W, of_a, of_b, arm_W);
  return known;
}

void ContactMemory::learn(const std::vector<ContactPoint>& points, const States& after,
                          double h) noexcept {
  learned_.clear();
  for (const ContactPoint& point : points) {
    if (point.is_impact || !(point.steady.n > 0.0)) continue;
    Known known = describe(point, after, h);
    known.is_learned = true;
    known.t_learned_W = known.last.t_W;
    known.f_learned_W = turn(known.last.f_W, -h * known.turn_W);
    known.p_W -= h * known.v_W;
    known.n_W = turn(known.n_W, -h * known.turn_W).normalized();
    known.last = {};
    if (point.known >= 0) {
      const Known& old = trial_[static_cast<std::size_t>(point.known)];
      known.last = old.last;
      known.slope_W = old.slope_W;
      known.base = old.base;
    }
    learned_.push_back(known);
  }
  trial_.swap(learned_);
}

void ContactMemory::keep(const std::vector<ContactPoint>& points, const States& after, double h,
                         double least) noexcept {
  known_.clear();
  for (const ContactPoint& point : points) {
    const bool pushes = !point.is_impact && point.steady.n > 0.0;
    const bool has_closed = point.is_impact && point.row.mode != RigidRow::Mode::kOpen;
    if (!pushes && !has_closed) continue;
    known_.push_back(describe(point, after, h));
    Known& known = known_.back();
    const bool is_telling = !has_closed && h >= least;
    const int age = point.known < 0 ? 0 : trial_[static_cast<std::size_t>(point.known)].last.age;
    if (!is_telling && age == 0) known.last = {};
    if (has_closed || age == 0) continue;
    const Known& old = trial_[static_cast<std::size_t>(point.known)];
    const Vec3 old_f_W = turnAlong(old.last.f_W, old.last.n_W, point.contact.n_W);
    if (!is_telling) {
      known.last = {old_f_W, old.last.t_W, point.contact.n_W, old.last.h, age};
      known.slope_W = turnAlong(old.slope_W, old.last.n_W, point.contact.n_W);
      known.base = old.base;
      continue;
    }
    known.base = 0.5 * (h + old.last.h);
    known.slope_W = (known.last.f_W - old_f_W) / known.base;
    known.last.age = age + 1;
  }
  trial_ = known_;
}

}  // namespace tandem
