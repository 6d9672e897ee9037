#include "island/contact_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tandem {
namespace {

/// Stiffness of the penalties beside the points' own: multipliers gain this factor per iteration.
constexpr double kStiffness = 1e4;
/// Slip that is none, and slip that will do where it hardly falls [m/s]. Multipliers of a tall
/// stack converge slowly: the next step goes on with them.
constexpr double kSettled = 1e-9, kNearlySettled = 1e-6;
/// Joints of a loop that are open contradict each other, and never settle. Once they have been slow
/// for this many rounds what is left is theirs to share; contact between them may slip so fast
/// [m/s].
constexpr int kPatience = 3;
constexpr double kContradicted = 1e-2;
/// Residual of Newton's iteration that is none [m/s].
constexpr double kSmallResidual = 1e-10;
/// Change of a velocity with which iteration is lost [m/s]. Should it come back, speeds would be
/// off by its rounding.
constexpr double kLost = 1e4;
/// Bodies that would be slower than v without contact, and points too, are thrown if they get
/// faster than `kMostFromRest` + `kMostGain` v. [m/s]
constexpr double kMostFromRest = 1.0, kMostGain = 3.0;
/// A new point that opens slower is taken as closed at first [m/s].
constexpr double kTogether = 1e-3;
constexpr int kMaxFactorisations = 20, kMaxSteps = 40;
/// Steps of Newton's with each of the softer penalties.
constexpr int kSoftSteps = 5;
/// Groups with factors of their own.
constexpr std::size_t kMaxFactors = 8;
/// Laws of a group whose factors are kept, but for the first group: those of some 60 bodies.
constexpr std::size_t kMostKept = 512;

}  // namespace

ContactSolver::ContactSolver(std::size_t max_bodies, std::size_t max_points,
                             std::size_t max_holds) {
  bodies_.reserve(max_bodies);
  first_.reserve(max_bodies);
  rows_.reserve(max_points);
  points_.reserve(max_points);
  point_of_.reserve(max_points);
  twists_.reserve(max_points);
  answer_.reserve(max_points);
  twist_answer_.reserve(max_points);
  holds_.reserve(max_holds);
  hold_laws_.reserve(max_holds);
  hold_answer_.reserve(max_holds);
  const std::size_t max_laws = 2 * max_points + max_holds;
  J_.reserve(max_laws);
  D_.reserve(max_laws);
  x_.reserve(max_bodies);
  dx_.reserve(max_bodies);
  for (std::size_t i = 0; i <= kMaxFactors; ++i) {
    const std::size_t kept = i == 0 ? max_laws : std::min(max_laws, kMostKept);
    factors_.push_back({{max_bodies, kept}, {max_bodies, kept}, {max_bodies, kept}});
  }
}

bool ContactSolver::solve(RigidRow* const* rows, std::size_t row_count, RigidMover* const* movers,
                          std::size_t mover_count, JointHold* const* holds,
                          std::size_t hold_count) noexcept {
  factor_ = &factors_[next_factor_];
  next_factor_ = std::min(next_factor_ + 1, factors_.size() - 1);
  rows_.assign(rows, rows + row_count);
  holds_.assign(holds, holds + hold_count);
  orderBodies(movers, mover_count);
  x_.resize(mover_count);
  dx_.resize(mover_count);
  setUp();
  if (!settle()) {
    setUp();
    soften();
    if (!settle()) return false;
  }
  if (isThrow()) return false;
  finish();
  return true;
}

/// Begins with the impulses and modes of the rows, and their velocities.
void ContactSolver::setUp() noexcept {
  points_.assign(rows_.size(), PointLaw());
  J_.resize(rows_.size());
  point_of_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    setUpPoint(i);
    if (rows_[i]->resistsTurning()) point_of_.push_back(i);
  }
  twists_.assign(point_of_.size(), TwistLaw());
  J_.resize(rows_.size() + twists_.size());
  for (std::size_t i = 0; i < twists_.size(); ++i) setUpTwist(i);
  setUpHolds();
  shapeMatrix();
  if (!factor_->shape.isNear(J_, first_)) {
    factor_->shape.keep(J_, first_);
    factor_->whole.forget();
    factor_->positions.forget();
  }
  x_.assign(x_.size(), Six());
  has_answer_ = false;
  (void)measureResidual();
}

/// Iterates until all laws hold. False if the modes do not settle.
bool ContactSolver::settle() noexcept {
  double slip_before = HUGE_VAL, hold_slip_before = HUGE_VAL, residual_before = HUGE_VAL;
  int factorisations = 0, slow = 0;
  gatherStiffness();
  bool is_factored = factor_->whole.isNear(D_);
  for (int steps = 0; steps < kMaxSteps; ++steps) {
    if (!is_factored) {
      if (++factorisations > kMaxFactorisations || !factorise()) break;
      is_factored = true;
    }
    step();
    if (!(measureLargest(x_) < kLost)) return false;
    const Modes modes = chooseModes();
    const double residual = measureResidual();
    if (residual > kSmallResidual || modes.are_forced) {
      // Sliding is not linear: its direction follows the slip.
      is_factored = !modes.have_changed && residual < 0.1 * residual_before;
      residual_before = residual;
      continue;
    }
    const double touch_slip = measureSlip(), hold_slip = measureHoldSlip();
    const double slip = std::max(touch_slip, hold_slip);
    if (slip < kSettled || (slip > 0.5 * slip_before && slip < kNearlySettled)) return true;
    slow = hold_slip > kNearlySettled && hold_slip > 0.5 * hold_slip_before ? slow + 1 : 0;
    if (slow >= kPatience && touch_slip < kContradicted) return true;
    hold_slip_before = hold_slip;
    if (slip < kNearlySettled) keepAnswer();
    slip_before = slip;
    residual_before = HUGE_VAL;
    updateMultipliers();
    is_factored = !chooseModes().have_changed && !modes.have_changed;
    (void)measureResidual();
  }
  // Better multipliers may have upset modes that were nearly right.
  if (!has_answer_) return false;
  takeAnswer();
  return true;
}

/// Finds multipliers and modes with softer penalties, whose modes depend less on each other, and
/// then with harder ones.
void ContactSolver::soften() noexcept {
  const auto setStiffness = [&](double stiffness) {
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i].setStiffness(J_[i], stiffness);
    (void)chooseModes();
    (void)measureResidual();
  };
  for (const double stiffness : {1e1, 1e2, 1e3}) {
    setStiffness(stiffness);
    for (int i = 0; i < kSoftSteps; ++i) {
      if (!factorise()) return;
      step();
      (void)chooseModes();
      if (measureResidual() < kNearlySettled) {
        updateMultipliers();
        (void)chooseModes();
        (void)measureResidual();
      }
    }
  }
  setStiffness(kStiffness);
}

void ContactSolver::updateMultipliers() noexcept {
  for (PointLaw& point : points_) point.P0 = point.P;
  for (TwistLaw& twist : twists_) twist.T0 = twist.T;
  for (HoldLaw& law : hold_laws_) std::copy_n(law.P, 3, law.P0);
}

/// Cuthill and McKee's order: bodies that touch are near each other in the matrix.
void ContactSolver::orderBodies(RigidMover* const* movers, std::size_t mover_count) noexcept {
  const auto forEachPair = [&](auto visit) {
    for (const RigidRow* row : rows_)
      if (row->b->ready) visit(*row->a, *row->b);
    const JointHold* before = nullptr;
    for (const JointHold* hold : holds_) {
      const bool is_same = before && hold->joint == before->joint;
      before = hold;
      if (!is_same && hold->a && hold->b) visit(*hold->a, *hold->b);
    }
  };
  bodies_.clear();
  for (std::size_t i = 0; i < mover_count; ++i) {
    movers[i]->place = -1;
    movers[i]->degree = 0;
  }
  forEachPair([](RigidMover& a, RigidMover& b) {
    ++a.degree;
    ++b.degree;
  });
  const auto place = [&](RigidMover& mover) {
    mover.place = static_cast<int>(bodies_.size());
    bodies_.push_back(&mover);
  };
  RigidMover* const start = *std::min_element(
      movers, movers + mover_count,
      [](const RigidMover* x, const RigidMover* y) { return x->degree < y->degree; });
  place(*start);
  for (std::size_t next = 0; next < bodies_.size(); ++next) {
    const std::size_t first = bodies_.size();
    forEachPair([&](RigidMover& a, RigidMover& b) {
      if (&a == bodies_[next] && b.place < 0) place(b);
      if (&b == bodies_[next] && a.place < 0) place(a);
    });
    // Few come at once; std::stable_sort() would allocate.
    for (std::size_t i = first + 1; i < bodies_.size(); ++i)
      for (std::size_t j = i; j > first && bodies_[j]->degree < bodies_[j - 1]->degree; --j)
        std::swap(bodies_[j], bodies_[j - 1]);
    for (std::size_t i = first; i < bodies_.size(); ++i) bodies_[i]->place = static_cast<int>(i);
  }
}

void ContactSolver::setUpPoint(std::size_t index) noexcept {
  const RigidRow& row = *rows_[index];
  ContactJacobian& J = J_[index];
  J.a = row.a->place;
  J.b = row.b->ready ? row.b->place : -1;
  for (int i = 0; i < 3; ++i) {
    const PlainVec& direction = row.direction(i);
    J.of_a[i] = row.a->roots.scale(direction, row.armOfA(i));
    if (J.b >= 0) J.of_b[i] = row.b->roots.scale(-1.0 * direction, -1.0 * row.armOfB(i));
  }
  PointLaw& law = points_[index];
  law.setStiffness(J, kStiffness);
  law.friction = row.friction;
  law.u = {row.velocityAlong(0), row.velocityAlong(1), row.velocityAlong(2)};
  law.u.n -= row.wanted;
  law.held = row.held;
  law.P0 = row.impulse;
  law.mode = row.mode == RigidRow::Mode::kUnknown ? law.findMode() : row.mode;
  // Else a stack that falls together would be stopped cube by cube, with a factorisation each.
  if (row.mode == RigidRow::Mode::kUnknown && law.mode == RigidRow::Mode::kOpen &&
      law.u.n < kTogether)
    law.mode = row.friction > 0.0 ? RigidRow::Mode::kStick : RigidRow::Mode::kSlide;
  // Slip before the solution may have any direction, and with stiff penalties much weight.
  if (row.mode == RigidRow::Mode::kSlide && row.impulse.n > 0.0)
    law.respondNear(row.slide);
  else
    law.respond();
}

void ContactSolver::setUpTwist(std::size_t index) noexcept {
  const std::size_t point = point_of_[index];
  const RigidRow& row = *rows_[point];
  ContactJacobian& J = J_[points_.size() + index];
  J.a = J_[point].a;
  J.b = J_[point].b;
  double w[3] = {};
  for (int i = 0; i < 3; ++i) {
    const PlainVec& axis = row.direction(i);
    const auto fill = [&](const RigidMover& mover, double sign, Six& along) {
      along = mover.roots.scale(PlainVec(), sign * axis);
      w[i] += sign * dot(axis, mover.w);
    };
    fill(*row.a, 1.0, J.of_a[i]);
    if (J.b >= 0) fill(*row.b, -1.0, J.of_b[i]);
  }
  TwistLaw& law = twists_[index];
  law.w = {w[0], w[1], w[2]};
  law.setStiffness(J, kStiffness);
  law.held = row.twist_held;
  law.T0 = row.twist;
  respond(index);
}

/// Rows of a joint come one after the other.
void ContactSolver::setUpHolds() noexcept {
  hold_laws_.clear();
  for (JointHold* hold : holds_) {
    if (hold_laws_.empty() || !hold_laws_.back().hasRoomFor(*hold)) {
      hold_laws_.emplace_back();
      J_.emplace_back();
      J_.back().a = hold->a ? hold->a->place : hold->b->place;
      J_.back().b = hold->a && hold->b ? hold->b->place : -1;
    }
    hold_laws_.back().add(*hold, J_.back(), kStiffness);
  }
  bool has_changed = false, is_forced = false;
  for (HoldLaw& law : hold_laws_) law.choose(has_changed, is_forced);
}

void ContactSolver::shapeMatrix() noexcept {
  first_.resize(bodies_.size());
  for (std::size_t i = 0; i < first_.size(); ++i) first_[i] = static_cast<int>(i);
  for (const ContactJacobian& J : J_) {
    if (J.b < 0) continue;
    int& first = first_[static_cast<std::size_t>(std::max(J.a, J.b))];
    first = std::min({first, J.a, J.b});
  }
}

void ContactSolver::respond(std::size_t twist) noexcept {
  const std::size_t point = point_of_[twist];
  const double push = std::max(0.0, points_[point].P.n);
  twists_[twist].respond(rows_[point]->spinning * push, rows_[point]->rolling * push);
}

/// Chooses the modes that the present velocities ask for, and the impulses by their laws.
ContactSolver::Modes ContactSolver::chooseModes() noexcept {
  Modes modes;
  for (PointLaw& point : points_) point.choose(modes.have_changed, modes.are_forced);
  for (std::size_t i = 0; i < twists_.size(); ++i) {
    const ContactStiffness before = twists_[i].D;
    respond(i);
    modes.have_changed |= !(twists_[i].D == before);
  }
  for (HoldLaw& law : hold_laws_) law.choose(modes.have_changed, modes.are_forced);
  return modes;
}

void ContactSolver::gatherStiffness() noexcept {
  D_.clear();
  for (const PointLaw& point : points_) D_.push_back(point.D);
  for (const TwistLaw& twist : twists_) D_.push_back(twist.D);
  for (const HoldLaw& law : hold_laws_) D_.push_back(law.D);
}

bool ContactSolver::factorise() noexcept {
  if (work_left_ <= 0) return false;
  work_left_ -= static_cast<int>(bodies_.size());
  ++factorisation_count_;
  gatherStiffness();
  return factor_->whole.make(J_, D_, first_);
}

/// Adds J^T push to dx_.
void ContactSolver::addPush(const ContactJacobian& J, const RigidRow::Local& push) noexcept {
  const auto add = [&](Six& to, const Six(&along)[3]) {
    to.add(combine(push.n, push.s, push.t, along));
  };
  add(dx_[static_cast<std::size_t>(J.a)], J.of_a);
  if (J.b >= 0) add(dx_[static_cast<std::size_t>(J.b)], J.of_b);
}

/// Adds J dx_.
void ContactSolver::addMotion(const ContactJacobian& J, RigidRow::Local& velocity) const noexcept {
  const auto add = [&](const Six& motion, const Six(&along)[3]) {
    velocity.n += dot(along[0], motion);
    velocity.s += dot(along[1], motion);
    velocity.t += dot(along[2], motion);
  };
  add(dx_[static_cast<std::size_t>(J.a)], J.of_a);
  if (J.b >= 0) add(dx_[static_cast<std::size_t>(J.b)], J.of_b);
}

/// One step of Newton's from the present velocities, whose residual has been measured.
void ContactSolver::step() noexcept {
  factor_->whole.solve(dx_);
  addMotions();
}

/// Moves on by dx_.
void ContactSolver::addMotions() noexcept {
  for (std::size_t i = 0; i < x_.size(); ++i) x_[i].add(dx_[i]);
  for (std::size_t i = 0; i < points_.size(); ++i) addMotion(J_[i], points_[i].u);
  for (std::size_t i = 0; i < twists_.size(); ++i) addMotion(J_[points_.size() + i], twists_[i].w);
  for (std::size_t i = 0; i < hold_laws_.size(); ++i) {
    double(&u)[3] = hold_laws_[i].u;
    RigidRow::Local motion{u[0], u[1], u[2]};
    addMotion(J_[firstHold() + i], motion);
    u[0] = motion.n, u[1] = motion.s, u[2] = motion.t;
  }
}

/// Change of velocity that the impulses give beyond the present one: sets dx_, and returns the
/// largest of a body [m/s].
double ContactSolver::measureResidual() noexcept {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    dx_[i] = x_[i].scaled(-1.0);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) addPush(J_[i], points_[i].P - points_[i].held);
  for (std::size_t i = 0; i < twists_.size(); ++i)
    addPush(J_[points_.size() + i], twists_[i].T - twists_[i].held);
  for (std::size_t i = 0; i < hold_laws_.size(); ++i)
    addPush(J_[firstHold() + i], hold_laws_[i].missing());
  return measureLargest(dx_);
}

/// Largest change of a body's velocity among `changes` [m/s].
double ContactSolver::measureLargest(const std::vector<Six>& changes) const noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const RigidMover& mover = *bodies_[i];
    const PlainVec dv = mover.roots.linear(changes[i]);
    const PlainVec dw = mover.roots.angular(changes[i]);
    const double square = mover.squareOf(dv, dw);
    if (!(square <= most)) most = square;
  }
  return std::sqrt(most);
}

/// Largest velocity that a law forbids [m/s].
double ContactSolver::measureSlip() const noexcept {
  double most = 0.0;
  for (const PointLaw& law : points_) {
    if (law.mode == RigidRow::Mode::kOpen) continue;
    most = std::max(most, std::abs(law.u.n));
    if (law.mode == RigidRow::Mode::kStick)
      most = std::max(most, std::sqrt(law.u.s * law.u.s + law.u.t * law.u.t));
  }
  for (std::size_t i = 0; i < twists_.size(); ++i) {
    const TwistLaw& law = twists_[i];
    // Within its limits nothing turns.
    const double radius = std::sqrt(rows_[point_of_[i]]->a->radius_squared);
    if (law.D.nn > 0.0) most = std::max(most, radius * std::abs(law.w.n));
    if (law.D.ss == law.rho_t && law.D.tt == law.rho_t)
      most = std::max(most, radius * std::sqrt(law.w.s * law.w.s + law.w.t * law.w.t));
  }
  return most;
}

/// The same of joints [m/s].
double ContactSolver::measureHoldSlip() const noexcept {
  double most = 0.0;
  for (const HoldLaw& law : hold_laws_) most = std::max(most, law.slip());
  return most;
}

/// True if bodies get much faster than anything would be without contact. A jam that gives way by a
/// small angle has such an answer, with forces of any size: it is exact, and no body is that rigid.
bool ContactSolver::isThrow() noexcept {
  const auto measureFastest = [&](const std::vector<Six>& changes) {
    double most = 0.0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const RigidMover& mover = *bodies_[i];
      most = std::max(most, mover.squareOf(mover.v + mover.roots.linear(changes[i]),
                                           mover.w + mover.roots.angular(changes[i])));
    }
    return most;
  };
  const double after = measureFastest(x_);
  if (after <= kMostFromRest * kMostFromRest) return false;

  // What is held goes, too.
  const RigidRow::Local none;
  for (Six& dx : dx_) dx.setZero();
  for (std::size_t i = 0; i < points_.size(); ++i) addPush(J_[i], none - points_[i].held);
  for (std::size_t i = 0; i < twists_.size(); ++i)
    addPush(J_[points_.size() + i], none - twists_[i].held);
  for (std::size_t i = 0; i < hold_laws_.size(); ++i)
    addPush(J_[firstHold() + i], none - hold_laws_[i].held());
  const double before = measureFastest(dx_);
  // Points have the speeds of the answer.
  for (std::size_t i = 0; i < dx_.size(); ++i) dx_[i].addScaled(-1.0, x_[i]);
  double slip = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    RigidRow::Local u = points_[i].u;
    addMotion(J_[i], u);
    slip = std::max({slip, std::abs(u.n + rows_[i]->wanted), std::abs(u.s), std::abs(u.t)});
  }
  const double most = kMostFromRest + kMostGain * std::max(slip, std::sqrt(before));
  return after > most * most;
}

void ContactSolver::keepAnswer() noexcept {
  answer_.assign(points_.begin(), points_.end());
  twist_answer_.assign(twists_.begin(), twists_.end());
  hold_answer_.assign(hold_laws_.begin(), hold_laws_.end());
  has_answer_ = true;
}

void ContactSolver::takeAnswer() noexcept {
  points_.assign(answer_.begin(), answer_.end());
  twists_.assign(twist_answer_.begin(), twist_answer_.end());
  hold_laws_.assign(hold_answer_.begin(), hold_answer_.end());
}

void ContactSolver::finish() noexcept {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    RigidRow& row = *rows_[i];
    const PointLaw& law = points_[i];
    row.mode = law.mode;
    row.apply(law.P - law.held);
    row.impulse = law.P;
    row.slide = {0.0, law.u.s, law.u.t};
  }
  for (std::size_t i = 0; i < twists_.size(); ++i) {
    RigidRow& row = *rows_[point_of_[i]];
    const TwistLaw& law = twists_[i];
    row.applyTwist(law.T - law.held);
    row.twist = law.T;
  }
  for (HoldLaw& law : hold_laws_) law.finish();
}

void ContactSolver::repair(const std::vector<RigidRow::Local>& gaps,
                           const std::vector<double>& ways) noexcept {
  // Friction of sliding points and motors are no matter of positions.
  bool slides = false;
  for (PointLaw& point : points_) {
    if (point.mode != RigidRow::Mode::kSlide) continue;
    point.D = {};
    point.D.nn = point.rho_n;
    slides = true;
  }
  auto way = ways.begin();
  for (HoldLaw& law : hold_laws_) {
    for (int i = 0; i < law.count; ++i) law.u[i] = *way++;
    slides |= law.leaveMotorsOut();
  }
  gatherStiffness();
  ContactFactor& factor = slides ? factor_->positions : factor_->whole;
  if (!factor.isNear(D_)) {
    ++factorisation_count_;
    work_left_ -= static_cast<int>(bodies_.size());
    if (!factor.make(J_, D_, first_)) return;
  }
  for (Six& x : x_) x.setZero();
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].u = gaps[i];
  for (int round = 0; round < 2; ++round) {
    for (Six& dx : dx_) dx.setZero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const ContactStiffness& D = D_[i];
      const RigidRow::Local& u = points_[i].u;
      addPush(J_[i], {-D.nn * u.n, -D.ss * u.s - D.st * u.t, -D.st * u.s - D.tt * u.t});
    }
    for (std::size_t i = 0; i < hold_laws_.size(); ++i) {
      const HoldLaw& law = hold_laws_[i];
      addPush(J_[firstHold() + i],
              {-law.D.nn * law.u[0], -law.D.ss * law.u[1], -law.D.tt * law.u[2]});
    }
    factor.solve(dx_);
    addMotions();
  }
  for (std::size_t i = 0; i < x_.size(); ++i) {
    RigidMover& mover = *bodies_[i];
    mover.shift = mover.shift + mover.roots.linear(x_[i]);
    mover.turn = mover.turn + mover.roots.angular(x_[i]);
  }
}

}  // namespace tandem
