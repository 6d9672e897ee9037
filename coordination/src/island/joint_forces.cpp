#include "island/joint_forces.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tandem {
namespace {

/// Compliance of a row beside its own mobility: far below what anybody feels.
constexpr double kCompliance = 1e-11;
constexpr int kMaxIterations = 4;
/// Error of an acceleration that is none, beside the largest.
constexpr double kSettled = 1e-10;
/// Acceleration that no joint gives: that of a whip's end at 300 m/s and 0.1 m [m/s^2].
constexpr double kMostAcceleration = 1e6;
/// Angular speed that stands for a linear one of 1 m/s [rad/s].
constexpr double kTurnOfWay = 10.0;

constexpr std::size_t kMostRows = 6 * kMaxJoints;
/// Entries of a row's skyline, on average: those of a wide tree.
constexpr std::size_t kEntriesPerRow = 48;

/// Speed of a row, or its rate, by those of both ends.
template <typename Linear, typename Angular>
double along(const JointRow& row, BodyIndex a, BodyIndex b, Linear linear,
             Angular angular) noexcept {
  double sum = 0.0;
  if (a != kStanding) sum += row.n_W.dot(linear(a)) + row.turn_a_W.dot(angular(a));
  if (b != kStanding) sum += row.turn_b_W.dot(angular(b)) - row.n_W.dot(linear(b));
  return sum;
}

}  // namespace

JointForces::JointForces(std::size_t body_count, std::size_t max_joints)
    : memory_(max_joints),
      block_of_(body_count, -1),
      is_end_(body_count),
      moved_(body_count),
      at_(max_joints > 0 ? body_count : 0),
      matrix_(max_joints > 0 ? kMostRows : 0, max_joints > 0 ? kEntriesPerRow * kMostRows : 0),
      force_(max_joints * static_cast<std::size_t>(kMostJointRows)) {
  if (max_joints == 0) return;
  joints_.reserve(max_joints);
  first_row_.reserve(max_joints);
  for (auto* bodies : {&ends_, &bodies_}) bodies->reserve(body_count);
  movers_.reserve(body_count);
  rows_.reserve(kMostRows);
  part_.reserve(kMostRows);
  for (auto* rows : {&now_, &later_}) rows->reserve(static_cast<std::size_t>(kMostJointRows));
  x_.reserve(body_count);
}

void JointForces::choose(const IslandModel& model, const std::vector<char>& moved) noexcept {
  joints_.clear();
  ends_.clear();
  source_ = model.joints;
  model_ = &model;
  if (!source_ || at_.empty()) return;
  std::fill(is_end_.begin(), is_end_.end(), char{0});
  std::copy(moved.begin(), moved.end(), moved_.begin());
  const auto isMoved = [&](BodyIndex body) {
    return body != kStanding && moved_[static_cast<std::size_t>(body)];
  };
  const auto addEnd = [&](BodyIndex body) {
    if (body == kStanding || is_end_[static_cast<std::size_t>(body)]) return;
    is_end_[static_cast<std::size_t>(body)] = 1;
    ends_.push_back(body);
  };
  const std::vector<JointEnds>& all = source_->joints();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!isMoved(all[i].a) && !isMoved(all[i].b)) continue;
    if (!model.isJoinedNow(all[i].a, all[i].b)) continue;
    joints_.push_back({i, all[i].a, all[i].b, 0});
    addEnd(all[i].a);
    addEnd(all[i].b);
  }
  orderBodies();
  orderJoints();
}

/// Bodies that are joined are near each other: each chain from one of its ends on.
void JointForces::orderBodies() noexcept {
  std::fill(block_of_.begin(), block_of_.end(), -1);
  bodies_.clear();
  const auto isFree = [&](BodyIndex body) {
    return body != kStanding && moved_[static_cast<std::size_t>(body)] &&
           block_of_[static_cast<std::size_t>(body)] < 0;
  };
  const auto place = [&](BodyIndex body) {
    block_of_[static_cast<std::size_t>(body)] = static_cast<int>(bodies_.size());
    bodies_.push_back(body);
  };
  const auto countJoints = [&](BodyIndex body) {
    return std::count_if(joints_.begin(), joints_.end(), [&](const Joint& joint) {
      return (joint.a == body && joint.b != kStanding) || (joint.b == body && joint.a != kStanding);
    });
  };
  for (std::size_t next = 0;;) {
    for (; next < bodies_.size(); ++next)
      for (const Joint& joint : joints_) {
        if (joint.a == bodies_[next] && isFree(joint.b)) place(joint.b);
        if (joint.b == bodies_[next] && isFree(joint.a)) place(joint.a);
      }
    BodyIndex start = kStanding;
    std::ptrdiff_t least = 0;
    for (const BodyIndex body : ends_) {
      if (!isFree(body)) continue;
      const std::ptrdiff_t count = countJoints(body);
      if (start != kStanding && count >= least) continue;
      start = body;
      least = count;
    }
    if (start == kStanding) return;
    place(start);
  }
}

/// Joints follow their bodies.
void JointForces::orderJoints() noexcept {
  const auto keyOf = [&](const Joint& joint) {
    const int a = blockOf(joint.a), b = blockOf(joint.b);
    return std::tuple(std::max(a, b), std::min(a, b), joint.index);
  };
  std::sort(joints_.begin(), joints_.end(),
            [&](const Joint& x, const Joint& y) { return keyOf(x) < keyOf(y); });
  const auto shareBody = [&](const Joint& x, const Joint& y) {
    const auto is = [&](BodyIndex body) {
      return blockOf(body) >= 0 && (body == y.a || body == y.b);
    };
    return is(x.a) || is(x.b);
  };
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    std::size_t first = 0;
    while (first < i && !shareBody(joints_[i], joints_[first])) ++first;
    joints_[i].first = first;
  }
}

void JointForces::solve() noexcept {
  movers_.clear();
  for (const BodyIndex b : bodies_)
    movers_.emplace_back(model_->bodies[static_cast<std::size_t>(b)], end(b).state);
  gather(chooseMoment());
  if (rows_.empty()) return;
  lookAtAccelerations();
  if (factorise()) iterate();
}

/// Time over which the change of directions is measured [s]: their rounding and their bend do the
/// same harm. 0 if nothing moves.
double JointForces::chooseMoment() const noexcept {
  double fastest = 0.0;
  for (const BodyIndex b : ends_) {
    const RigidState& state = at_[static_cast<std::size_t>(b)].state;
    fastest = std::max({fastest, kTurnOfWay * state.v_W.norm(), state.w_W.norm()});
  }
  return fastest > 0.0 ? std::sqrt(source_->rounding()) / fastest : 0.0;
}

/// Asks for all rows, and lets those push whose force is known.
void JointForces::gather(double moment) noexcept {
  static const RigidState kNowhere;
  rows_.clear();
  first_row_.clear();
  for (const Joint& joint : joints_) {
    const auto stateOf = [&](BodyIndex body) -> const RigidState& {
      return body == kStanding ? kNowhere : end(body).state;
    };
    now_.clear();
    later_.clear();
    source_->evaluate(joint.index, stateOf(joint.a), stateOf(joint.b), now_);
    if (moment > 0.0) {
      RigidState a = stateOf(joint.a), b = stateOf(joint.b);
      goOn(a, moment);
      goOn(b, moment);
      source_->evaluate(joint.index, a, b, later_);
    }
    first_row_.push_back(rows_.size());
    for (const JointRow& row : now_) {
      double& force = force_[place(joint.index, row)];
      force = 0.0;
      const double mobility = mobilityOf(joint, row);
      if (mobility == 0.0) continue;
      if (isSoft(row, mobility)) {
        const auto v_W = [&](BodyIndex b) -> const Vec3& { return end(b).state.v_W; };
        const auto w_W = [&](BodyIndex b) -> const Vec3& { return end(b).state.w_W; };
        force = computeSpringForce(row, along(row, joint.a, joint.b, v_W, w_W));
        push(joint, row, force);
        continue;
      }
      const JointMode mode = memory_.mode(joint.index, row);
      if (mode == JointMode::kLow) push(joint, row, force = row.low);
      if (mode == JointMode::kHigh) push(joint, row, force = row.high);
      if (mode != JointMode::kHolds || rows_.size() == rows_.capacity()) continue;
      // Rows hardly ever come or go within a moment.
      const auto same = std::find_if(later_.begin(), later_.end(), [&](const JointRow& other) {
        return other.number == row.number;
      });
      addRow(joint, row, same != later_.end() ? &*same : nullptr, moment);
    }
  }
}

double JointForces::mobilityOf(const Joint& joint, const JointRow& row) const noexcept {
  const auto of = [&](BodyIndex body, const Vec3& turn_W) {
    const int block = blockOf(body);
    if (block < 0) return 0.0;
    return computeMobility(movers_[static_cast<std::size_t>(block)], PlainVec(row.n_W),
                           PlainVec(turn_W));
  };
  return of(joint.a, row.turn_a_W) + of(joint.b, row.turn_b_W);
}

void JointForces::push(const Joint& joint, const JointRow& row, double force) noexcept {
  const auto accelerate = [&](BodyIndex body, const Vec3& n_W, const Vec3& turn_W) {
    const int block = blockOf(body);
    if (block < 0) return;
    const RigidMover& mover = movers_[static_cast<std::size_t>(block)];
    End& moved = end(body);
    moved.a_W += force * multiplyEach(mover.inverse_mass_W, PlainVec(n_W)).toVec3();
    moved.alpha_W += force * mover.turnBy(PlainVec(turn_W)).toVec3();
  };
  accelerate(joint.a, row.n_W, row.turn_a_W);
  accelerate(joint.b, -row.n_W, row.turn_b_W);
}

void JointForces::addRow(const Joint& joint, const JointRow& now, const JointRow* later,
                         double moment) noexcept {
  const auto fill = [&](int block, const PlainVec& n, const PlainVec& turn, Six& along) {
    if (block < 0) return;
    const RigidMover& mover = movers_[static_cast<std::size_t>(block)];
    multiplyEach(mover.root_mass_W, n).store(along.at);
    PlainVec(dot(mover.root_x, turn), dot(mover.root_y, turn), dot(mover.root_z, turn))
        .store(along.at + 3);
  };
  rows_.emplace_back();
  Row& row = rows_.back();
  row.place = place(joint.index, now);
  row.block_a = blockOf(joint.a);
  row.block_b = blockOf(joint.b);
  row.n = PlainVec(now.n_W);
  row.turn_a = PlainVec(now.turn_a_W);
  row.turn_b = PlainVec(now.turn_b_W);
  fill(row.block_a, row.n, row.turn_a, row.of_a);
  fill(row.block_b, -1.0 * row.n, row.turn_b, row.of_b);
  if (!later) return;
  const auto v_W = [&](BodyIndex b) -> const Vec3& { return end(b).state.v_W; };
  const auto w_W = [&](BodyIndex b) -> const Vec3& { return end(b).state.w_W; };
  row.wanted =
      (along(now, joint.a, joint.b, v_W, w_W) - along(*later, joint.a, joint.b, v_W, w_W)) / moment;
}

/// Takes off what the other forces do, when all of them are known.
void JointForces::lookAtAccelerations() noexcept {
  const auto rateOf = [&](int block, const PlainVec& n, const PlainVec& turn) {
    if (block < 0) return 0.0;
    const End& moved = end(bodies_[static_cast<std::size_t>(block)]);
    return dot(n, PlainVec(moved.a_W)) + dot(turn, PlainVec(moved.alpha_W));
  };
  for (Row& row : rows_)
    row.wanted -=
        rateOf(row.block_a, row.n, row.turn_a) + rateOf(row.block_b, -1.0 * row.n, row.turn_b);
}

/// Makes J M^-1 J^T and its factor.
bool JointForces::factorise() noexcept {
  matrix_.clear();
  std::size_t next = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const std::size_t first = first_row_[joints_[j].first];
    const std::size_t end = j + 1 < joints_.size() ? first_row_[j + 1] : rows_.size();
    for (; next < end; ++next) {
      if (!matrix_.hasRoomFor(first)) return false;
      const Row& row = rows_[next];
      double* entry = matrix_.addRow(first);
      for (std::size_t i = first; i <= next; ++i) {
        const Row& other = rows_[i];
        double sum = 0.0;
        if (row.block_a >= 0) {
          if (row.block_a == other.block_a) sum += dot(row.of_a, other.of_a);
          if (row.block_a == other.block_b) sum += dot(row.of_a, other.of_b);
        }
        if (row.block_b >= 0) {
          if (row.block_b == other.block_a) sum += dot(row.of_b, other.of_a);
          if (row.block_b == other.block_b) sum += dot(row.of_b, other.of_b);
        }
        *entry++ = sum;
      }
      entry[-1] *= 1.0 + kCompliance;
    }
  }
  return matrix_.factorise();
}

/// False if rows that contradict each other ask for what no joint does. Then impulses at the end of
/// the step do what can be done.
bool JointForces::isBelievable() const noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const RigidMover& mover = movers_[i];
    const PlainVec a = multiplyEach(mover.root_mass_W, PlainVec(x_[i].at));
    const PlainVec alpha = mover.rootTurn(PlainVec(x_[i].at + 3));
    const double square = std::max(dot(a, a), mover.radius_squared * dot(alpha, alpha));
    if (!(square < kMostAcceleration * kMostAcceleration)) return false;
  }
  return true;
}

/// Finds the forces and adds what they do.
void JointForces::iterate() noexcept {
  x_.assign(bodies_.size(), Six());
  double largest = 0.0;
  for (const Row& row : rows_) largest = std::max(largest, std::abs(row.wanted));
  double worst_before = HUGE_VAL;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    part_.clear();
    double worst = 0.0;
    for (const Row& row : rows_) {
      double missing = row.wanted;
      if (row.block_a >= 0) missing -= dot(row.of_a, x_[static_cast<std::size_t>(row.block_a)]);
      if (row.block_b >= 0) missing -= dot(row.of_b, x_[static_cast<std::size_t>(row.block_b)]);
      part_.push_back(missing);
      worst = std::max(worst, std::abs(missing));
    }
    // Of rows that say the same, rounding may ask for what none can do.
    if (worst <= kSettled * largest || worst > 0.1 * worst_before) break;
    worst_before = worst;
    matrix_.solve(part_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row& row = rows_[i];
      force_[row.place] += part_[i];
      if (row.block_a >= 0) x_[static_cast<std::size_t>(row.block_a)].addScaled(part_[i], row.of_a);
      if (row.block_b >= 0) x_[static_cast<std::size_t>(row.block_b)].addScaled(part_[i], row.of_b);
    }
  }
  if (!isBelievable()) {
    for (const Row& row : rows_) force_[row.place] = 0.0;
    return;
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    End& moved = end(bodies_[i]);
    moved.a_W += multiplyEach(movers_[i].root_mass_W, PlainVec(x_[i].at)).toVec3();
    moved.alpha_W += movers_[i].rootTurn(PlainVec(x_[i].at + 3)).toVec3();
  }
}

}  // namespace tandem
