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
PlainVec turn(const PlainVec& v, const PlainVec& angle) noexcept {
  const PlainVec first = cross(angle, v);
  return v + first + 0.5 * cross(angle, first);
}

/// Rotates a vector along with a direction, the shortest way.
PlainVec turnAlong(const PlainVec& v, const PlainVec& from, const PlainVec& to) noexcept {
  if (from == to) return v;
  const double cosine = dot(from, to);
  if (cosine <= 0.0) return {};
  const PlainVec axis = cross(from, to), first = cross(axis, v);
  return v + first + (1.0 / (1.0 + cosine)) * cross(axis, first);
}

PlainVec normalize(const PlainVec& v) noexcept { return v / std::sqrt(dot(v, v)); }

double squareOf(const PlainVec& v) noexcept { return dot(v, v); }

struct Velocity {
  PlainVec v_W, w_W;
};

/// Velocity of the point of a body at `arm_W` from its centre, and how it turns.
Velocity velocityAt(const RigidState& state, const PlainVec& arm_W) noexcept {
  const PlainVec w_W(state.w_W);
  return {PlainVec(state.v_W) + cross(w_W, arm_W), w_W};
}

/// Velocity of a contact point that went at `seen_W` in the last step; `arm_W` leads to it from the
/// centre of a. It is a corner of a body, or goes along curved surfaces at most as fast as they
/// roll and slip. Else the finder has chosen another point.
PlainVec followPoint(const PlainVec& seen_W, const Velocity& of_a, const Velocity& of_b,
                     const PlainVec& arm_W) noexcept {
  const double off_a = squareOf(seen_W - of_a.v_W), off_b = squareOf(seen_W - of_b.v_W);
  const double off = std::min(off_a, off_b);
  const double slip = squareOf(of_a.v_W - of_b.v_W);
  // Most points slip at least as fast, and need no root.
  if (off <= kMargin * kMargin * slip) return seen_W;
  const double roll = std::sqrt(squareOf(arm_W) * squareOf(of_a.w_W - of_b.w_W));
  const double most = kMargin * (std::sqrt(slip) + roll);
  if (off <= most * most) return seen_W;
  return off_b < off_a ? of_b.v_W : of_a.v_W;
}

/// Turning rate of a normal that went at `seen_W`: with a body, or as fast as curved surfaces roll
/// and slip at most. Else the finder has chosen another normal.
PlainVec followNormal(const PlainVec& seen_W, const Velocity& of_a, const Velocity& of_b,
                      const PlainVec& arm_W) noexcept {
  const double seen = squareOf(seen_W);
  const double turn_a = squareOf(of_a.w_W), turn_b = squareOf(of_b.w_W);
  if (seen <= kMargin * kMargin * (turn_a + turn_b)) return seen_W;
  const double slip = std::sqrt(squareOf(of_a.v_W - of_b.v_W));
  const double reach = std::sqrt(squareOf(arm_W));
  const double most =
      kMargin * (std::sqrt(turn_a) + std::sqrt(turn_b) + (reach > 0.0 ? slip / reach : 0.0));
  if (seen <= most * most) return seen_W;
  const bool is_nearer_a = squareOf(seen_W - of_a.w_W) < squareOf(seen_W - of_b.w_W);
  return is_nearer_a ? of_a.w_W : of_b.w_W;
}

}  // namespace

ContactMemory::ContactMemory(std::size_t capacity) {
  for (std::vector<Known>* list : {&known_, &learned_, &next_known_, &marked_})
    list->reserve(capacity);
  held_.reserve(capacity);
}

void ContactMemory::forget() noexcept {
  known_.clear();
  tries_learned_ = false;
  held_.clear();
}

void ContactMemory::goBack() noexcept {
  known_ = marked_;
  tries_learned_ = false;
  held_.clear();
}

void ContactMemory::shiftOrigin(const Vec3& offset_W) noexcept {
  tries_learned_ = false;
  for (Known& known : known_) known.p_W = known.p_W + PlainVec(offset_W);
}

/// A force that changes evenly moves a body by h^3 / 12 of its rate less than its mean does, and
/// what the body leans on by as much.
void ContactMemory::hold(const States& before, double h,
                         std::vector<HeldWrench>& wrenches) noexcept {
  const double half = 0.5 * h;
  const std::vector<Known>& all = trial();
  held_.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Known& known = all[i];
    Held& held = held_[i];
    held.is_taken = false;
    const double ahead = 0.5 * (known.last.h + h);
    PlainVec f_W = known.is_learned ? known.f_learned_W : known.last.f_W;
    PlainVec rate_W;
    if (ahead < kFarthest * known.base) {
      rate_W = known.slope_W;
      const double time = known.is_learned ? half : ahead;
      const double size = time * time * squareOf(rate_W), most = squareOf(f_W);
      if (size > most) rate_W = std::sqrt(most / size) * rate_W;
      if (!known.is_learned) f_W = f_W + ahead * rate_W;
    }
    // A contact does not pull.
    if (!(dot(f_W, known.n_W) > 0.0)) f_W = rate_W = {};
    held.f_W = f_W;
    held.n_W = known.n_W;
    if (!(known.turn_W == PlainVec())) {
      held.f_W = turn(f_W, half * known.turn_W);
      held.n_W = normalize(turn(known.n_W, half * known.turn_W));
      rate_W = rate_W + cross(known.turn_W, held.f_W);
    }
    held.t_W = known.is_learned ? known.t_learned_W : known.last.t_W;
    held.p_W = known.p_W + half * known.v_W;
    const PlainVec f_start_W = held.f_W - half * rate_W;
    const auto push = [&](BodyIndex body, double sign) {
      const RigidState& state = before[static_cast<std::size_t>(body)];
      const PlainVec v_W(state.v_W);
      const PlainVec arm_W = held.p_W - (PlainVec(state.p_W) + half * v_W);
      const PlainVec t_rate_W = cross(arm_W, rate_W) + cross(known.v_W - v_W, held.f_W);
      const PlainVec t_W = cross(arm_W, held.f_W) + held.t_W;
      wrenches[static_cast<std::size_t>(body)].add(
          {f_start_W.toVec3(), (t_W - half * t_rate_W).toVec3()},
          {rate_W.toVec3(), t_rate_W.toVec3()}, sign);
    };
    push(known.a, 1.0);
    if (known.b != kStanding) push(known.b, -1.0);
  }
}

void ContactMemory::letGo() noexcept {
  held_.clear();
  for (const Known& known : trial()) held_.push_back({{}, {}, known.p_W, known.n_W, false});
}

void ContactMemory::forgetForces() noexcept {
  for (Known& known : trial()) {
    known.last.f_W = known.last.t_W = {};
    known.is_learned = false;
  }
}

/// Points of the last step of the two bodies or surfaces of `contact`. Points come pair by pair,
/// and in much the same order as before.
ContactMemory::Range ContactMemory::findPair(const RigidContact& contact) const noexcept {
  const std::vector<Known>& all = trial();
  const std::size_t count = all.size();
  const auto isOfPair = [&](std::size_t i) { return areOfOnePair(all[i], contact); };
  std::size_t first = next_ < count ? next_ : 0, looked = 0;
  if (first > 0 && isOfPair(first - 1)) --first;
  while (looked < count && !isOfPair(first)) first = (first + 1) % count, ++looked;
  if (looked == count) return {};
  std::size_t last = first + 1;
  while (first > 0 && isOfPair(first - 1)) --first;
  while (last < count && isOfPair(last)) ++last;
  return {first, last};
}

/// Square of the distance of a point to where that of the last step was expected [m^2].
double ContactMemory::squareOff(const ContactPoint& point, std::size_t place,
                                double h) const noexcept {
  const Known& known = trial()[place];
  return squareOf(known.p_W + h * known.v_W - PlainVec(point.contact.p_W));
}

bool ContactMemory::isFree(std::size_t place, const ContactPoint& point) const noexcept {
  return !held_[place].is_taken &&
         dot(trial()[place].n_W, PlainVec(point.contact.n_W)) >= kSameNormal;
}

/// Matches a point with the one of the last step that was expected here. False if there is none.
bool ContactMemory::matchExpected(ContactPoint& point, double h) noexcept {
  const auto isExpected = [&](std::size_t i) {
    return isFree(i, point) && squareOff(point, i, h) < kCertain * kCertain;
  };
  const std::vector<Known>& all = trial();
  const bool is_next =
      next_ < all.size() && areOfOnePair(all[next_], point.contact) && isExpected(next_);
  const Range pair = is_next ? Range{next_, next_ + 1} : findPair(point.contact);
  for (std::size_t i = pair.first; i < pair.last; ++i) {
    if (!is_next && !isExpected(i)) continue;
    next_ = i + 1;
    take(point, i, h);
    return true;
  }
  return false;
}

/// Matches what is left of the points of a pair: those nearest to each other first.
void ContactMemory::matchNearest(PointIterator first, PointIterator last, double h) noexcept {
  const Range pair = findPair(first->contact);
  for (;;) {
    ContactPoint* nearest = nullptr;
    double least = kSamePoint * kSamePoint;
    std::size_t place = 0;
    for (PointIterator point = first; point != last; ++point) {
      if (point->known >= 0) continue;
      for (std::size_t i = pair.first; i < pair.last; ++i) {
        if (!isFree(i, *point)) continue;
        const double stayed = squareOf(trial()[i].p_W - PlainVec(point->contact.p_W));
        const double off = std::min(squareOff(*point, i, h), stayed);
        if (off >= least) continue;
        least = off;
        nearest = &*point;
        place = i;
      }
    }
    if (!nearest) return;
    take(*nearest, place, h);
  }
}

/// A corner that is about to touch must not be taken for one that does, a step before.
void ContactMemory::match(std::vector<ContactPoint>& points, double h) noexcept {
  next_ = 0;
  bool are_all_known = true;
  for (ContactPoint& point : points) {
    point.known = -1;
    are_all_known &= matchExpected(point, h);
  }
  if (are_all_known) return;
  next_ = 0;
  forEachPair(points, [&](auto first, auto last) { matchNearest(first, last, h); });
}

/// Matches a point with one of the last step.
void ContactMemory::take(ContactPoint& point, std::size_t place, double h) noexcept {
  point.known = static_cast<int>(place);
  const Known& known = knownOf(point);
  Held& held = held_[place];
  held.is_taken = true;
  const PlainVec n_W(point.contact.n_W);
  const PlainVec& f_W = known.is_learned ? known.f_learned_W : known.last.f_W;
  RigidRow& row = point.row;
  row.held = row.toLocal(h * turnAlong(held.f_W, held.n_W, n_W));
  row.impulse = row.toLocal(h * turnAlong(f_W, known.n_W, n_W));
  row.impulse.n = std::max(0.0, row.impulse.n);
  row.mode = point.mode_before = known.mode;
  row.slide = row.toLocal(known.slide_W);
  row.twist_held = row.twist = row.toLocal(h * held.t_W);
}

/// Force that a known point was expected to have [N].
double ContactMemory::expectedForceOf(const ContactPoint& point) const noexcept {
  if (point.known < 0) return 0.0;
  const Known& known = knownOf(point);
  return std::sqrt(squareOf(known.is_learned ? known.f_learned_W : known.last.f_W));
}

/// Where bodies are jammed, sweeps ask for impulses that do not fall with the step's length: what
/// is beyond the expected force is not foreseen.
void ContactMemory::limit(Force& force, double most) noexcept {
  const double size = std::sqrt(squareOf(force.f_W));
  if (size <= most) return;
  force.f_W = (most / size) * force.f_W;
  force.t_W = (most / size) * force.t_W;
}

/// Sets `known` to the point as it is known after a step.
void ContactMemory::describe(const ContactPoint& point, const States& after, double h,
                             Known& known) const noexcept {
  const RigidContact& contact = point.contact;
  const PlainVec p_W(contact.p_W), n_W(contact.n_W);
  known.a = contact.a;
  known.b = contact.b;
  known.surface = contact.surface;
  known.mode = point.row.mode;
  known.slide_W = point.row.toWorld(point.row.slide);
  known.p_W = p_W;
  known.n_W = n_W;
  const RigidState& state_a = after[static_cast<std::size_t>(contact.a)];
  const PlainVec arm_W = p_W - PlainVec(state_a.p_W);
  const double rate = 1.0 / h;
  known.last = {rate * point.row.toWorld(point.steady), {}, n_W, h, 1};
  if (point.row.resistsTurning()) known.last.t_W = rate * point.row.toWorld(point.steady_twist);
  if (point.row.is_swept) limit(known.last, expectedForceOf(point));
  Velocity of_b;
  if (contact.b != kStanding) {
    const RigidState& state_b = after[static_cast<std::size_t>(contact.b)];
    of_b = velocityAt(state_b, p_W - PlainVec(state_b.p_W));
  }
  if (point.known < 0) {
    // The arm of a new point stays.
    known.v_W = PlainVec(state_a.v_W);
    known.turn_W = of_b.w_W;
    return;
  }
  const Known& old = knownOf(point);
  const Velocity of_a = velocityAt(state_a, arm_W);
  known.v_W = followPoint(rate * (p_W - old.p_W), of_a, of_b, arm_W);
  const PlainVec spin_W = dot(n_W, of_b.w_W) * n_W;
  known.turn_W = followNormal(rate * cross(old.n_W, n_W) + spin_W, of_a, of_b, arm_W);
}

void ContactMemory::learn(const std::vector<ContactPoint>& points, const States& after,
                          double h) noexcept {
  next_known_.clear();
  for (const ContactPoint& point : points) {
    if (point.is_impact || !(point.steady.n > 0.0)) continue;
    Known& known = next_known_.emplace_back();
    describe(point, after, h, known);
    known.is_learned = true;
    known.t_learned_W = known.last.t_W;
    known.f_learned_W = turn(known.last.f_W, -h * known.turn_W);
    known.p_W = known.p_W - h * known.v_W;
    known.n_W = normalize(turn(known.n_W, -h * known.turn_W));
    known.last = {};
    if (point.known < 0) continue;
    const Known& old = knownOf(point);
    known.last = old.last;
    known.slope_W = old.slope_W;
    known.base = old.base;
  }
  learned_.swap(next_known_);
  tries_learned_ = true;
}

void ContactMemory::keep(const std::vector<ContactPoint>& points, const States& after, double h,
                         double least) noexcept {
  next_known_.clear();
  for (const ContactPoint& point : points) {
    const bool pushes = !point.is_impact && point.steady.n > 0.0;
    const bool has_closed = point.is_impact && point.row.mode != RigidRow::Mode::kOpen;
    if (!pushes && !has_closed) continue;
    Known& known = next_known_.emplace_back();
    describe(point, after, h, known);
    const bool is_telling = !has_closed && h >= least;
    const int age = point.known < 0 ? 0 : knownOf(point).last.age;
    if (!is_telling && age == 0) known.last = {};
    if (has_closed || age == 0) continue;
    const Known& old = knownOf(point);
    const PlainVec old_f_W = turnAlong(old.last.f_W, old.last.n_W, known.n_W);
    if (!is_telling) {
      known.last = {old_f_W, old.last.t_W, known.n_W, old.last.h, age};
      known.slope_W = turnAlong(old.slope_W, old.last.n_W, known.n_W);
      known.base = old.base;
      continue;
    }
    known.base = 0.5 * (h + old.last.h);
    known.slope_W = (1.0 / known.base) * (known.last.f_W - old_f_W);
    known.last.age = age + 1;
  }
  known_.swap(next_known_);
  tries_learned_ = false;
}

}  // namespace tandem
