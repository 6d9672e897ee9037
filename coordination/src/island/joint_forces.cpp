#include "island/joint_forces.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// Stiffness of the penalties beside the rows' own: multipliers gain this factor per iteration.
constexpr double kStiffness = 1e4;
constexpr int kMaxIterations = 20;
/// Error of an acceleration that is none, beside the largest.
constexpr double kSettled = 1e-11;
/// Angular speed that stands for a linear one of 1 m/s [rad/s].
constexpr double kTurnOfWay = 10.0;

constexpr std::size_t kMaxTriples = kMostJointRows / 3 * kMaxJoints;

/// Rate of a row's speed, or the speed itself, by rates of both ends.
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
      force_(max_joints * static_cast<std::size_t>(kMostJointRows)),
      factor_(max_joints > 0 ? body_count : 0, max_joints > 0 ? kMaxTriples : 0) {
  if (max_joints == 0) return;
  joints_.reserve(max_joints);
  for (auto* bodies : {&ends_, &bodies_}) bodies->reserve(body_count);
  movers_.reserve(body_count);
  rows_.reserve(max_joints * static_cast<std::size_t>(kMostJointRows));
  for (auto* rows : {&now_, &later_}) rows->reserve(static_cast<std::size_t>(kMostJointRows));
  triples_.reserve(kMaxTriples);
  J_.reserve(kMaxTriples);
  D_.reserve(kMaxTriples);
  first_.reserve(body_count);
  x_.reserve(body_count);
  dx_.reserve(body_count);
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
    joints_.push_back({i, all[i].a, all[i].b});
    addEnd(all[i].a);
    addEnd(all[i].b);
  }
  orderBodies();
}

/// Bodies that are joined are near each other in the matrix: each chain from one of its ends on.
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

void JointForces::solve() noexcept {
  movers_.clear();
  for (const BodyIndex b : bodies_)
    movers_.emplace_back(model_->bodies[static_cast<std::size_t>(b)], end(b).state);
  const double moment = chooseMoment();
  gather(moment);
  build(moment);
  iterate();
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
  for (const Joint& joint : joints_) {
    const auto stateOf = [&](BodyIndex body) -> const RigidState& {
      return body == kStanding ? kNowhere : end(body).state;
    };
    now_.clear();
    source_->evaluate(joint.index, stateOf(joint.a), stateOf(joint.b), now_);
    later_.clear();
    if (moment > 0.0) {
      RigidState a = stateOf(joint.a), b = stateOf(joint.b);
      goOn(a, moment);
      goOn(b, moment);
      source_->evaluate(joint.index, a, b, later_);
    }
    for (const JointRow& row : now_) {
      force_[place(joint.index, row)] *= memory_.mode(joint.index, row) == JointMode::kHolds;
      switch (memory_.mode(joint.index, row)) {
        case JointMode::kLow:
          push(joint, row, row.low);
          continue;
        case JointMode::kHigh:
          push(joint, row, row.high);
          continue;
        case JointMode::kIdle:
          continue;
        case JointMode::kHolds:
          break;
      }
      const auto same = std::find_if(later_.begin(), later_.end(), [&](const JointRow& other) {
        return other.number == row.number && other.law == row.law;
      });
      rows_.push_back({&joint, row, same == later_.end() ? row : *same});
    }
  }
}

void JointForces::push(const Joint& joint, const JointRow& row, double force) noexcept {
  force_[place(joint.index, row)] = force;
  const auto accelerate = [&](BodyIndex body, const Vec3& n_W, const Vec3& turn_W) {
    if (body == kStanding || !moves(body)) return;
    const RigidMover& mover =
        movers_[static_cast<std::size_t>(block_of_[static_cast<std::size_t>(body)])];
    End& moved = end(body);
    moved.a_W += force * multiplyEach(mover.inverse_mass_W, PlainVec(n_W)).toVec3();
    moved.alpha_W += force * mover.turnBy(PlainVec(turn_W)).toVec3();
  };
  accelerate(joint.a, row.n_W, row.turn_a_W);
  accelerate(joint.b, -row.n_W, row.turn_b_W);
}

/// Makes the equations of the rows that hold.
void JointForces::build(double moment) noexcept {
  triples_.clear();
  J_.clear();
  const auto a_W = [&](BodyIndex b) -> const Vec3& { return end(b).a_W; };
  const auto alpha_W = [&](BodyIndex b) -> const Vec3& { return end(b).alpha_W; };
  const auto v_W = [&](BodyIndex b) -> const Vec3& { return end(b).state.v_W; };
  const auto w_W = [&](BodyIndex b) -> const Vec3& { return end(b).state.w_W; };
  const Joint* joint_before = nullptr;
  for (const Row& row : rows_) {
    const BodyIndex a = row.joint->a, b = row.joint->b;
    double rate = along(row.now, a, b, a_W, alpha_W);
    if (moment > 0.0)
      rate += (along(row.later, a, b, v_W, w_W) - along(row.now, a, b, v_W, w_W)) / moment;
    addRow(row, -rate, row.joint != joint_before);
    joint_before = row.joint;
  }
  D_.clear();
  for (const Triple& triple : triples_) {
    ContactStiffness D;
    D.nn = triple.stiffness[0];
    D.ss = triple.stiffness[1];
    D.tt = triple.stiffness[2];
    D_.push_back(D);
  }
}

void JointForces::addRow(const Row& row, double wanted, bool is_first) noexcept {
  const auto blockOf = [&](BodyIndex body) {
    return body == kStanding ? -1 : block_of_[static_cast<std::size_t>(body)];
  };
  const int block_a = blockOf(row.joint->a), block_b = blockOf(row.joint->b);
  const auto moverOf = [&](int block) {
    return block < 0 ? nullptr : &movers_[static_cast<std::size_t>(block)];
  };
  if (is_first || triples_.back().count == 3) {
    triples_.emplace_back();
    J_.emplace_back();
    J_.back().a = block_a >= 0 ? block_a : block_b;
    J_.back().b = block_a >= 0 ? block_b : -1;
  }
  Triple& triple = triples_.back();
  const int i = triple.count++;
  setDirection(row.now, moverOf(block_a), moverOf(block_b), i, J_.back());
  const double mobility = J_.back().mobility(i);
  triple.place[i] = place(row.joint->index, row.now);
  triple.wanted[i] = wanted;
  triple.f[i] = force_[triple.place[i]];
  triple.stiffness[i] = mobility > 0.0 ? kStiffness / mobility : 0.0;
}

/// Finds x with J x = wanted, and adds it.
void JointForces::iterate() noexcept {
  first_.resize(bodies_.size());
  for (std::size_t i = 0; i < first_.size(); ++i) first_[i] = static_cast<int>(i);
  for (const ContactJacobian& J : J_) {
    if (J.b < 0) continue;
    int& first = first_[static_cast<std::size_t>(std::max(J.a, J.b))];
    first = std::min({first, J.a, J.b});
  }
  if (!factor_.isNear(J_, D_, first_) && !factor_.make(J_, D_, first_)) return;
  x_.assign(bodies_.size(), Six());
  dx_.resize(bodies_.size());
  double largest = 0.0;
  for (const Triple& triple : triples_)
    for (const double wanted : triple.wanted) largest = std::max(largest, std::abs(wanted));
  const auto missing = [&](std::size_t i, int row) {
    const ContactJacobian& J = J_[i];
    double found = dot(J.of_a[row], x_[static_cast<std::size_t>(J.a)]);
    if (J.b >= 0) found += dot(J.of_b[row], x_[static_cast<std::size_t>(J.b)]);
    return triples_[i].wanted[row] - found;
  };
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    for (std::size_t b = 0; b < x_.size(); ++b) {
      dx_[b].setZero();
      dx_[b].addScaled(-1.0, x_[b]);
    }
    for (std::size_t i = 0; i < triples_.size(); ++i) {
      const ContactJacobian& J = J_[i];
      const Triple& triple = triples_[i];
      for (int row = 0; row < triple.count; ++row) {
        const double f = triple.f[row] + triple.stiffness[row] * missing(i, row);
        dx_[static_cast<std::size_t>(J.a)].addScaled(f, J.of_a[row]);
        if (J.b >= 0) dx_[static_cast<std::size_t>(J.b)].addScaled(f, J.of_b[row]);
      }
    }
    factor_.solve(dx_);
    for (std::size_t b = 0; b < x_.size(); ++b) x_[b].add(dx_[b]);
    double worst = 0.0;
    for (std::size_t i = 0; i < triples_.size(); ++i)
      for (int row = 0; row < triples_[i].count; ++row) {
        const double error = missing(i, row);
        triples_[i].f[row] += triples_[i].stiffness[row] * error;
        worst = std::max(worst, std::abs(error));
      }
    if (worst <= kSettled * largest) break;
  }
  for (const Triple& triple : triples_)
    for (int row = 0; row < triple.count; ++row) force_[triple.place[row]] = triple.f[row];
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    End& moved = end(bodies_[i]);
    moved.a_W += multiplyEach(movers_[i].root_mass_W, PlainVec(x_[i].at)).toVec3();
    moved.alpha_W += movers_[i].rootTurn(PlainVec(x_[i].at + 3)).toVec3();
  }
}

}  // namespace tandem
