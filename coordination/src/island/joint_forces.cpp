#include "island/joint_forces.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tandem {
namespace {

/// Compliance of a row beside its own mobility: far below what anybody feels.
constexpr double kCompliance = 1e-11;
constexpr int kMaxIterations = 4;
/// Solutions of an evaluation, and force beside a motor's greatest with which it lets go.
constexpr int kMaxRounds = 4;
constexpr double kOverload = 100.0;
/// Error of an acceleration that is none, beside the largest.
constexpr double kSettled = 1e-9;
/// Speed at which joints give no force, and acceleration that none gives: those of a whip's end
/// [m/s, m/s^2].
constexpr double kMostSpeed = 300.0, kMostAcceleration = 1e6;
/// Joints take motion away, and so answer a load by no more of it: this share of its square.
constexpr double kMostOfLoad = 1.5;
/// Angular speed that stands for a linear one of 1 m/s [rad/s].
constexpr double kTurnOfWay = 10.0;

/// Joints with more rows that hold are rare.
constexpr std::size_t kMostPanels = kMaxJoints + kMaxJoints / 4;
/// Blocks of a panel, on average: those of a wide tree.
constexpr std::size_t kBlocksPerPanel = 8;

const RigidState kNowhere;

/// Speed of a row.
double measureSpeed(const JointRow& row, const RigidState& a, const RigidState& b) noexcept {
  return row.n_W.dot(a.v_W - b.v_W) + row.turn_a_W.dot(a.w_W) + row.turn_b_W.dot(b.w_W);
}

}  // namespace

JointForces::JointForces(std::size_t body_count, std::size_t max_joints)
    : memory_(max_joints),
      block_of_(body_count, -1),
      is_end_(body_count),
      moved_(body_count),
      at_(max_joints > 0 ? body_count : 0),
      matrix_(max_joints > 0 ? kMostPanels : 0, max_joints > 0 ? kBlocksPerPanel * kMostPanels : 0),
      force_(max_joints * static_cast<std::size_t>(kMostJointRows)) {
  if (max_joints == 0) return;
  joints_.reserve(max_joints);
  first_panel_.reserve(max_joints);
  for (auto* bodies : {&ends_, &bodies_}) bodies->reserve(body_count);
  movers_.reserve(body_count);
  panels_.reserve(kMostPanels);
  part_.reserve(kMostPanels);
  for (auto* rows : {&now_, &later_}) rows->reserve(static_cast<std::size_t>(kMostJointRows));
  for (auto* motions : {&x_, &pushed_}) motions->reserve(body_count);
}

void JointForces::choose(const IslandModel& model, const std::vector<char>& moved) noexcept {
  joints_.clear();
  ends_.clear();
  bodies_.clear();
  source_ = model.joints;
  model_ = &model;
  if (!source_ || at_.empty() || source_->joints().empty()) return;
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
    Joint& joint = joints_.emplace_back();
    joint.index = i;
    joint.a = all[i].a;
    joint.b = all[i].b;
    addEnd(all[i].a);
    addEnd(all[i].b);
  }
  orderBodies();
  orderJoints();
}

/// Bodies that are joined are near each other: each chain from one of its ends on.
void JointForces::orderBodies() noexcept {
  std::fill(block_of_.begin(), block_of_.end(), -1);
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
    joints_[i].block_a = blockOf(joints_[i].a);
    joints_[i].block_b = blockOf(joints_[i].b);
  }
}

const RigidState& JointForces::stateOf(BodyIndex body) const noexcept {
  return body == kStanding ? kNowhere : at_[static_cast<std::size_t>(body)].state;
}

void JointForces::solve() noexcept {
  setUpMovers();
  for (int round = 0; round < kMaxRounds; ++round) {
    gather();
    x_ = pushed_;
    if (panels_.empty() || !factorise()) break;
    iterate();
    if (!letGo()) break;
  }
  accelerate();
}

void JointForces::setUpMovers() noexcept {
  movers_.clear();
  for (const BodyIndex b : bodies_) {
    const ModelBody& body = model_->bodies[static_cast<std::size_t>(b)];
    movers_.push_back(
        {{body, PlainRotation(stateOf(b).q_WB)}, body.bounding_radius * body.bounding_radius});
  }
}

/// Asks for all rows, and lets those push whose force is known.
void JointForces::gather() noexcept {
  panels_.clear();
  first_panel_.clear();
  pushed_.assign(bodies_.size(), Six());
  moment_ = -1.0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    first_panel_.push_back(panels_.size());
    gather(j);
  }
}

void JointForces::gather(std::size_t j) noexcept {
  const Joint& joint = joints_[j];
  const RigidState &a = stateOf(joint.a), &b = stateOf(joint.b);
  now_.clear();
  source_->evaluate(joint.index, a, b, now_);
  measureBends(joint);
  for (const JointRow& row : now_) {
    double& force = force_[place(joint.index, row)];
    force = 0.0;
    const Direction along = findDirection(joint, row);
    const RowMobility mobility = mobilityOf(joint, row, along);
    if (mobility.perImpulse() == 0.0) continue;
    if (isSoft(row, mobility.speed)) {
      force = computeSpringForce(row, measureSpeed(row, a, b));
      push(joint, along, force);
      continue;
    }
    const JointMode mode = memory_.mode(joint.index, row);
    if (mode == JointMode::kLow) push(joint, along, force = row.low);
    if (mode == JointMode::kHigh) push(joint, along, force = row.high);
    if (mode == JointMode::kHolds) hold(j, row, along, mobility.freed());
  }
}

/// Finds the rates of rows that do not tell them, from the rows a moment later.
void JointForces::measureBends(const Joint& joint) noexcept {
  const auto tells = [](const JointRow& row) { return row.tells_bend; };
  if (std::all_of(now_.begin(), now_.end(), tells)) return;
  if (moment_ < 0.0) moment_ = chooseMoment();
  if (moment_ == 0.0) return;
  RigidState a = stateOf(joint.a), b = stateOf(joint.b);
  goOn(a, moment_);
  goOn(b, moment_);
  later_.clear();
  source_->evaluate(joint.index, a, b, later_);
  for (JointRow& row : now_) {
    if (row.tells_bend) continue;
    // Rows hardly ever come or go within a moment.
    const auto same = std::find_if(later_.begin(), later_.end(), [&](const JointRow& other) {
      return other.number == row.number;
    });
    if (same != later_.end())
      row.bend = (measureSpeed(*same, a, b) - measureSpeed(row, a, b)) / moment_;
  }
}

/// Time over which the change of directions is measured [s]: their rounding and their bend do the
/// same harm. 0 if nothing moves.
double JointForces::chooseMoment() const noexcept {
  double fastest = 0.0;
  for (const BodyIndex b : ends_) {
    const RigidState& state = stateOf(b);
    fastest = std::max({fastest, kTurnOfWay * state.v_W.norm(), state.w_W.norm()});
  }
  return fastest > 0.0 ? std::sqrt(source_->rounding()) / fastest : 0.0;
}

JointForces::Direction JointForces::findDirection(const Joint& joint,
                                                  const JointRow& row) const noexcept {
  const auto scale = [&](int block, const PlainVec& n, const Vec3& turn_W) {
    if (block < 0) return Six();
    return movers_[static_cast<std::size_t>(block)].roots.scale(n, PlainVec(turn_W));
  };
  const PlainVec n(row.n_W);
  return {scale(joint.block_a, n, row.turn_a_W), scale(joint.block_b, -1.0 * n, row.turn_b_W)};
}

RowMobility JointForces::mobilityOf(const Joint& joint, const JointRow& row,
                                    const Direction& along) const noexcept {
  RowMobility mobility;
  const auto add = [&](int block, const Six& six, const Vec3& turn_W) {
    if (block < 0) return;
    const MassRoots& roots = movers_[static_cast<std::size_t>(block)].roots;
    mobility.add(roots, six, PlainVec(row.n_W), PlainVec(turn_W));
  };
  add(joint.block_a, along.of_a, row.turn_a_W);
  add(joint.block_b, along.of_b, row.turn_b_W);
  return mobility;
}

void JointForces::push(const Joint& joint, const Direction& along, double force) noexcept {
  const auto move = [&](int block, const Six& six) {
    if (block >= 0) pushed_[static_cast<std::size_t>(block)].addScaled(force, six);
  };
  move(joint.block_a, along.of_a);
  move(joint.block_b, along.of_b);
}

void JointForces::hold(std::size_t j, const JointRow& row, const Direction& along,
                       double freed) noexcept {
  const Joint& joint = joints_[j];
  if (panels_.size() == first_panel_.back() || panels_.back().count == kPanelRows) {
    if (panels_.size() == panels_.capacity()) return;
    panels_.emplace_back();
    panels_.back().joint = j;
  }
  Panel& panel = panels_.back();
  for (int m = 0; m < 6; ++m) {
    panel.of_a[m].at[panel.count] = along.of_a.at[m];
    panel.of_b[m].at[panel.count] = along.of_b.at[m];
  }
  panel.wanted.at[panel.count] = row.speed_rate - row.bend - rateOf(joint, row);
  panel.freed[panel.count] = freed;
  panel.bound[panel.count] =
      row.law == JointLaw::kMotor ? std::max(std::abs(row.low), std::abs(row.high)) : HUGE_VAL;
  panel.number[panel.count] = row.number;
  panel.place[panel.count++] = place(joint.index, row);
}

/// Rate of a row's speed by accelerations of the bodies that joints move.
double JointForces::rateOf(const Joint& joint, const JointRow& row) const noexcept {
  double rate = 0.0;
  if (joint.block_a >= 0) {
    const End& moved = at_[static_cast<std::size_t>(joint.a)];
    rate += row.n_W.dot(moved.a_W) + row.turn_a_W.dot(moved.alpha_W);
  }
  if (joint.block_b >= 0) {
    const End& moved = at_[static_cast<std::size_t>(joint.b)];
    rate += row.turn_b_W.dot(moved.alpha_W) - row.n_W.dot(moved.a_W);
  }
  return rate;
}

/// Makes J M^-1 J^T and its factor.
bool JointForces::factorise() noexcept {
  matrix_.clear();
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    const Panel& panel = panels_[i];
    const std::size_t first = first_panel_[joints_[panel.joint].first];
    if (!matrix_.hasRoomFor(first)) return false;
    SixBySix* const blocks = matrix_.addPanel(panel.count, first);
    for (std::size_t j = first; j <= i; ++j) fillBlock(panel, panels_[j], blocks[j - first]);
    for (int c = 0; c < panel.count; ++c) {
      double& mobility = blocks[i - first].column[c].at[c];
      mobility += kCompliance * std::max(mobility, panel.freed[c]);
    }
  }
  return matrix_.factorise();
}

/// Adds what impulses along the rows of `other`, the columns, do along those of `panel`.
void JointForces::fillBlock(const Panel& panel, const Panel& other,
                            SixBySix& block) const noexcept {
  const Joint &rows = joints_[panel.joint], &columns = joints_[other.joint];
  const auto add = [&](const Six* of_rows, const Six* of_columns) {
    for (int c = 0; c < other.count; ++c) {
      Six column = block.column[c];
      for (int m = 0; m < 6; ++m) column.addScaled(of_columns[m].at[c], of_rows[m]);
      block.column[c] = column;
    }
  };
  const auto isShared = [](int one, int another) { return one >= 0 && one == another; };
  if (isShared(rows.block_a, columns.block_a)) add(panel.of_a, other.of_a);
  if (isShared(rows.block_a, columns.block_b)) add(panel.of_a, other.of_b);
  if (isShared(rows.block_b, columns.block_a)) add(panel.of_b, other.of_a);
  if (isShared(rows.block_b, columns.block_b)) add(panel.of_b, other.of_b);
}

/// False if rows that contradict each other ask for what no joint does, or have asked for it: a
/// body that cannot yield gives its partner any energy. Then impulses at the end of the step do
/// what can be done.
bool JointForces::isBelievable() const noexcept {
  double load = 0.0, answer = 0.0, fastest = 0.0;
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const Mover& mover = movers_[i];
    const RigidState& state = stateOf(bodies_[i]);
    const double speed =
        std::max(state.v_W.squaredNorm(), mover.radius_squared * state.w_W.squaredNorm());
    if (!(speed < kMostSpeed * kMostSpeed)) return false;
    Six held = x_[i];
    held.addScaled(-1.0, pushed_[i]);
    const PlainVec a = mover.roots.linear(held), alpha = mover.roots.angular(held);
    const double way = dot(a, a), turn = mover.radius_squared * dot(alpha, alpha);
    fastest = std::max({fastest, way, turn});
    const End& end = at_[static_cast<std::size_t>(bodies_[i])];
    const double mass = 1.0 / model_->bodies[static_cast<std::size_t>(bodies_[i])].inverse_mass;
    answer += mass * (way + turn);
    load += mass * (end.a_W.squaredNorm() + mover.radius_squared * end.alpha_W.squaredNorm());
  }
  if (fastest < kMostAcceleration * kMostAcceleration) return true;
  return trusts_load_ && answer < kMostOfLoad * load;
}

/// Writes the rates that are missing into part_; returns the largest.
double JointForces::measureMissing() noexcept {
  part_.clear();
  double worst = 0.0;
  for (const Panel& panel : panels_) {
    const Joint& joint = joints_[panel.joint];
    Six missing = panel.wanted;
    const auto takeOff = [&](int block, const Six* of) {
      if (block < 0) return;
      const Six& x = x_[static_cast<std::size_t>(block)];
      for (int m = 0; m < 6; ++m) missing.addScaled(-x.at[m], of[m]);
    };
    takeOff(joint.block_a, panel.of_a);
    takeOff(joint.block_b, panel.of_b);
    for (int r = 0; r < panel.count; ++r) worst = std::max(worst, std::abs(missing.at[r]));
    part_.push_back(missing);
  }
  return worst;
}

/// Adds the forces in part_, and the motion that they make.
void JointForces::addForces() noexcept {
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    const Panel& panel = panels_[i];
    const Joint& joint = joints_[panel.joint];
    for (int r = 0; r < panel.count; ++r) force_[panel.place[r]] += part_[i].at[r];
    const auto move = [&](int block, const Six* of) {
      if (block < 0) return;
      Six& x = x_[static_cast<std::size_t>(block)];
      for (int m = 0; m < 6; ++m) x.at[m] += dot(of[m], part_[i]);
    };
    move(joint.block_a, panel.of_a);
    move(joint.block_b, panel.of_b);
  }
}

/// Finds the forces of rows that hold.
void JointForces::iterate() noexcept {
  double worst = measureMissing();
  const double settled = kSettled * worst;
  for (int iteration = 0; iteration < kMaxIterations && worst > settled; ++iteration) {
    matrix_.solve(part_);
    addForces();
    const double worst_before = worst;
    worst = measureMissing();
    // Of rows that say the same, rounding may ask for what none can do.
    if (worst > 0.1 * worst_before) break;
  }
  if (isBelievable()) return;
  x_ = pushed_;
  for (const Panel& panel : panels_)
    for (int r = 0; r < panel.count; ++r) force_[panel.place[r]] = 0.0;
}

/// A motor that would need far more than its force does not hold, now and in the rest of the try:
/// where motors contradict each other their forces are without limit. True if any let go.
bool JointForces::letGo() noexcept {
  bool has_let_go = false;
  for (const Panel& panel : panels_)
    for (int r = 0; r < panel.count; ++r) {
      const double force = force_[panel.place[r]];
      if (!(std::abs(force) > kOverload * panel.bound[r])) continue;
      memory_.setMode(joints_[panel.joint].index, panel.number[r],
                      force < 0.0 ? JointMode::kLow : JointMode::kHigh);
      has_let_go = true;
    }
  return has_let_go;
}

/// Adds the motion by joints to the accelerations of their ends.
void JointForces::accelerate() noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    End& moved = end(bodies_[i]);
    moved.a_W += movers_[i].roots.linear(x_[i]).toVec3();
    moved.alpha_W += movers_[i].roots.angular(x_[i]).toVec3();
  }
}

}  // namespace tandem
