#include "arms/held_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/bullet_bridge/convert.h"

#include "arms/host_arm.h"

namespace tandem {
namespace {

/// Part of a row's mobility that is new at least: rows before hold all but a lever of 3 %.
constexpr double kNew = 1e-3;
/// A row that moves less than this is held by joints [1/kg].
constexpr double kLeastMobility = 1e-6;
/// Motions ask for no more than this, 100 g. Where rows say what others do, they may contradict
/// motors and limits, too, and pull no harder than 30 g [m/s^2].
constexpr double kMostAcceleration = 1e3, kMostInLoops = 3e2;
/// Lever by which turns count as much as ways [m].
constexpr double kLever = 0.1;

}  // namespace

void HeldRows::reserve(std::size_t constraints, const std::vector<const HostArm*>& arms,
                       const std::vector<const btRigidBody*>& bodies) {
  arms_.clear();
  bodies_.clear();
  dofs_ = 0;
  for (const HostArm* arm : arms) {
    const std::size_t count = arm->countFree();
    arms_.push_back({arm, dofs_, count, {}, {}, {}});
    arms_.back().unit.resize(count * arm->model().size());
    arms_.back().links.resize(arm->model().size());
    ArmModel::read(arm->body(), arms_.back().at);
    dofs_ += count;
  }
  for (const btRigidBody* body : bodies) {
    bodies_.push_back({body, dofs_});
    dofs_ += 6;
  }
  const std::size_t most_rows = 6 * constraints;
  rows_.reserve(most_rows);
  along_.resize(most_rows * dofs_);
  // No more rows than degrees of freedom say something new.
  for (auto* matrix : {&held_, &moved_, &normal_}) matrix->resize(dofs_ * dofs_);
  reachable_.resize(dofs_);
}

void HeldRows::begin() noexcept {
  rows_.clear();
  for (Arm& arm : arms_) arm.is_seen = false;
  for (Body& body : bodies_) body.is_seen = false;
}

void HeldRows::lookAt(Arm& arm) noexcept {
  if (std::exchange(arm.is_seen, true)) return;
  const ArmModel& model = arm.arm->model();
  ArmModel::read(arm.arm->body(), arm.at);
  arm.at.base.v_W = arm.at.base.w_W = Vec3::Zero();
  for (ArmCoordinates::Joint& joint : arm.at.joints) joint.u = {};
  std::size_t next = 0;
  const auto tell = [&](double& velocity) {
    velocity = 1.0;
    model.findLinks(arm.at, arm.links);
    velocity = 0.0;
    std::copy(arm.links.begin(), arm.links.end(),
              arm.unit.begin() + static_cast<std::ptrdiff_t>(next++ * model.size()));
  };
  if (!model.isBaseFixed()) {
    for (int k = 0; k < 3; ++k) tell(arm.at.base.w_W[k]);
    for (int k = 0; k < 3; ++k) tell(arm.at.base.v_W[k]);
  }
  for (std::size_t place = 1; place < model.size(); ++place)
    for (std::size_t k = 0; k < model.links()[place].dofs; ++k) tell(arm.at.joints[place].u[k]);
}

void HeldRows::add(const JointRow& row, double force, const HeldEnd& a, const HeldEnd& b) noexcept {
  if (rows_.size() == rows_.capacity()) return;
  double* const J = along(rows_.size());
  std::fill(J, J + dofs_, 0.0);
  addEnd(a, row.n_W, row.turn_a_W, J);
  addEnd(b, -row.n_W, row.turn_b_W, J);
  rows_.push_back({force, row.way, 0.0, row.n_W == Vec3::Zero() ? kLever * kLever : 1.0});
}

void HeldRows::compare() noexcept {
  count_ = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    multiplyByMobility(along(i), reachable_.data());
    rows_[i].mobility = rows_[i].rest = rows_[i].weight * dot(along(i), reachable_.data());
  }
  while (Row* next = count_ < dofs_ ? chooseNext() : nullptr) hold(*next);
  findOpenWays();
  const double most = count_ == rows_.size() ? kMostAcceleration : kMostInLoops;
  for (Row& row : rows_)
    if (row.is_new) row.force = std::min(row.force, most * std::sqrt(row.weight) / row.mobility);
}

/// The row that is to be held next; null: all others are held.
HeldRows::Row* HeldRows::chooseNext() noexcept {
  Row* best = nullptr;
  for (Row& row : rows_) {
    if (row.is_done || !(row.rest > kLeastMobility + kNew * row.mobility)) continue;
    const bool is_better =
        !best || row.force > best->force || (row.force == best->force && row.rest > best->rest);
    if (is_better) best = &row;
  }
  return best;
}

/// Makes a row the next e, and takes what it holds off the others.
void HeldRows::hold(Row& row) noexcept {
  row.is_done = true;
  double *e = held(count_), *Me = moved(count_);
  const double* J = along(static_cast<std::size_t>(&row - rows_.data()));
  std::copy(J, J + dofs_, e);
  for (std::size_t i = 0; i < count_; ++i) {
    const double part = dot(J, moved(i));
    for (std::size_t k = 0; k < dofs_; ++k) e[k] -= part * held(i)[k];
  }
  multiplyByMobility(e, Me);
  const double square = dot(e, Me);
  if (!(square > 0.0)) return;
  row.is_new = true;
  const double scale = 1.0 / std::sqrt(square);
  for (std::size_t k = 0; k < dofs_; ++k) {
    e[k] *= scale;
    Me[k] *= scale;
  }
  ++count_;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double part = dot(along(i), Me);
    rows_[i].rest -= rows_[i].weight * part * part;
  }
}

/// Rows that are not new leave some ways open: those that no motion closes.
void HeldRows::findOpenWays() noexcept {
  if (count_ == rows_.size() || !solveReachable()) return;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    rows_[i].open = rows_[i].way;
    for (std::size_t k = 0; k < count_; ++k)
      rows_[i].open -= dot(along(i), moved(k)) * reachable_[k];
  }
}

/// Least squares of all ways by motions along e: normal equations, by Cholesky.
bool HeldRows::solveReachable() noexcept {
  const std::size_t n = count_;
  std::fill(normal_.begin(), normal_.end(), 0.0);
  std::fill(reachable_.begin(), reachable_.end(), 0.0);
  for (std::size_t i = 0; i < rows_.size(); ++i)
    for (std::size_t k = 0; k < n; ++k) {
      const double part = rows_[i].weight * dot(along(i), moved(k));
      reachable_[k] += part * rows_[i].way;
      for (std::size_t j = 0; j <= k; ++j) normal_[k * n + j] += part * dot(along(i), moved(j));
    }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j <= k; ++j) {
      double sum = normal_[k * n + j];
      for (std::size_t i = 0; i < j; ++i) sum -= normal_[k * n + i] * normal_[j * n + i];
      if (j == k && !(sum > 0.0)) return false;
      normal_[k * n + j] = j == k ? std::sqrt(sum) : sum / normal_[j * n + j];
    }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < k; ++i) reachable_[k] -= normal_[k * n + i] * reachable_[i];
    reachable_[k] /= normal_[k * n + k];
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t i = k + 1; i < n; ++i) reachable_[k] -= normal_[i * n + k] * reachable_[i];
    reachable_[k] /= normal_[k * n + k];
  }
  return true;
}

/// Adds the speed of an end along a row, by each degree of freedom.
void HeldRows::addEnd(const HeldEnd& end, const Vec3& n_W, const Vec3& turn_W,
                      double* along) noexcept {
  for (Arm& arm : arms_) {
    if (arm.arm != end.arm) continue;
    lookAt(arm);
    const std::size_t links = arm.arm->model().size();
    for (std::size_t k = 0; k < arm.count; ++k) {
      const RigidState& state = arm.unit[k * links + end.place];
      along[arm.first + k] += n_W.dot(state.v_W) + turn_W.dot(state.w_W);
    }
  }
  for (Body& body : bodies_) {
    if (body.body != end.rigid) continue;
    body.is_seen = true;
    for (int k = 0; k < 3; ++k) {
      along[body.first + static_cast<std::size_t>(k)] += n_W[k];
      along[body.first + static_cast<std::size_t>(k) + 3] += turn_W[k];
    }
  }
}

double HeldRows::dot(const double* one, const double* other) const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < dofs_; ++k) sum += one[k] * other[k];
  return sum;
}

void HeldRows::multiplyByMobility(const double* along, double* mobile) const noexcept {
  std::fill(mobile, mobile + dofs_, 0.0);
  for (const Arm& arm : arms_)
    for (std::size_t i = 0; arm.is_seen && i < arm.count; ++i)
      for (std::size_t k = 0; k < arm.count; ++k)
        mobile[arm.first + i] += arm.arm->mobility(i, k) * along[arm.first + k];
  for (const Body& body : bodies_) {
    if (!body.is_seen) continue;
    const double* own = along + body.first;
    const btVector3 turn = toBullet(Vec3(own[3], own[4], own[5]));
    const Vec3 turned = fromBullet(body.body->getInvInertiaTensorWorld() * turn);
    for (int k = 0; k < 3; ++k) {
      double* of_body = mobile + body.first + k;
      of_body[0] = static_cast<double>(body.body->getInvMass()) * own[k];
      of_body[3] = turned[k];
    }
  }
}

}  // namespace tandem
