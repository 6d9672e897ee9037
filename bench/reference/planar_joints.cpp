#include "bench/reference/planar_joints.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tandem::demos::bench {
namespace {

/// Newton's method ends when nothing locked is off by more at the end of a step [m or rad]. What
/// is left does not add up from step to step.
constexpr double kClosed = 1e-15;
constexpr int kMostRounds = 8;

const PlanarBody kPlane{};  // what a joint without a second body is fixed to

const PlanarBody& bodyB(const PlanarScene& scene, const PlanarJoint& joint) {
  return joint.b ? scene.bodies[*joint.b] : kPlane;
}

Vec2 turned(const Vec2& a, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * a.x() - s * a.y(), s * a.x() + c * a.y()};
}

PlanarBody movedOn(PlanarBody body, double h) {
  body.p += h * body.v;
  body.angle += h * body.w;
  return body;
}

/// Two locked coordinates, then the free one.
std::array<double, 3> computeCoordinates(const PlanarJoint& joint, const PlanarBody& a,
                                         const PlanarBody& b) {
  const Vec2 apart = a.p + turned(joint.at_a, a.angle) - b.p - turned(joint.at_b, b.angle);
  const double turn = a.angle - b.angle - joint.turn;
  if (!joint.is_slider) return {apart.x(), apart.y(), turn};
  const Vec2 along = turned(joint.axis, b.angle);
  return {turnQuarter(along).dot(apart), turn, along.dot(apart)};
}

/// Derivative of n . (pivot of a - pivot of b), where n turns with b if `n_turns`.
void setPointRow(const PlanarJoint& joint, const PlanarBody& a, const PlanarBody& b, const Vec2& n,
                 bool n_turns, Eigen::Ref<Eigen::RowVectorXd> row) {
  const Vec2 arm_a = turned(joint.at_a, a.angle), arm_b = turned(joint.at_b, b.angle);
  const auto i = static_cast<Eigen::Index>(3 * joint.a);
  row.segment<2>(i) = n.transpose();
  row[i + 2] = cross(arm_a, n);
  if (!joint.b) return;
  const auto k = static_cast<Eigen::Index>(3 * *joint.b);
  const Vec2 arm = n_turns ? Vec2(a.p + arm_a - b.p) : arm_b;
  row.segment<2>(k) = -n.transpose();
  row[k + 2] = -cross(arm, n);
}

void setTurnRow(const PlanarJoint& joint, Eigen::Ref<Eigen::RowVectorXd> row) {
  row[static_cast<Eigen::Index>(3 * joint.a) + 2] = 1.0;
  if (joint.b) row[static_cast<Eigen::Index>(3 * *joint.b) + 2] = -1.0;
}

void readVelocities(const PlanarScene& scene, Eigen::VectorXd& v) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(3 * i);
    v.segment<2>(k) = scene.bodies[i].v;
    v[k + 2] = scene.bodies[i].w;
  }
}

void addVelocities(const Eigen::VectorXd& change, PlanarScene& scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(3 * i);
    scene.bodies[i].v += change.segment<2>(k);
    scene.bodies[i].w += change[k + 2];
  }
}

}  // namespace

PlanarJoints::PlanarJoints(const PlanarScene& scene)
    : count_(static_cast<Eigen::Index>(scene.joints.size())),
      directions_(kRows * count_, static_cast<Eigen::Index>(3 * scene.bodies.size())),
      locks_(kLocks * count_, directions_.cols()),
      inverse_masses_(directions_.cols()),
      velocities_(directions_.cols()),
      errors_(locks_.rows()),
      lock_impulses_(Eigen::VectorXd::Zero(locks_.rows())),
      impulses_(scene.joints.size()),
      coordinates_(scene.joints.size()) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const PlanarBody& body = scene.bodies[i];
    inverse_masses_.segment<3>(static_cast<Eigen::Index>(3 * i)) << body.inverseMass(),
        body.inverseMass(), body.inverseInertia();
  }
}

bool PlanarJoints::areJoined(const PlanarScene& scene, std::size_t a, std::size_t b) const {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [&](const PlanarJoint& joint) {
    return (joint.a == a && joint.b == b) || (joint.a == b && joint.b == a);
  });
}

double PlanarJoints::computeCoordinate(const PlanarScene& scene, const PlanarJoint& joint) {
  return computeCoordinates(joint, scene.bodies[joint.a], bodyB(scene, joint))[2];
}

void PlanarJoints::computeDirections(const PlanarScene& scene) {
  directions_.setZero();
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const PlanarJoint& joint = scene.joints[j];
    const PlanarBody &a = scene.bodies[joint.a], &b = bodyB(scene, joint);
    const auto row = kRows * static_cast<Eigen::Index>(j);
    if (joint.is_slider) {
      const Vec2 along = turned(joint.axis, b.angle);
      setPointRow(joint, a, b, turnQuarter(along), true, directions_.row(row));
      setTurnRow(joint, directions_.row(row + 1));
      setPointRow(joint, a, b, along, true, directions_.row(row + 2));
    } else {
      setPointRow(joint, a, b, Vec2::UnitX(), false, directions_.row(row));
      setPointRow(joint, a, b, Vec2::UnitY(), false, directions_.row(row + 1));
      setTurnRow(joint, directions_.row(row + 2));
    }
    locks_.middleRows<kLocks>(kLocks * static_cast<Eigen::Index>(j)) =
        directions_.middleRows<kLocks>(row);
  }
  lock_masses_.compute(locks_ * inverse_masses_.asDiagonal() * locks_.transpose());
}

void PlanarJoints::look(const PlanarScene& scene, double h) {
  computeDirections(scene);
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    coordinates_[j] = computeCoordinate(scene, scene.joints[j]);
    const auto& motor = scene.joints[j].motor;
    const double most = motor ? h * motor->force : 0.0;
    impulses_[j].motor = std::clamp(impulses_[j].motor, -most, most);
  }
}

void PlanarJoints::push(PlanarScene& scene, const Eigen::VectorXd& impulses) const {
  addVelocities(inverse_masses_.cwiseProduct(locks_.transpose() * impulses), scene);
}

void PlanarJoints::push(PlanarScene& scene, std::size_t joint, double impulse) const {
  const auto row = kRows * static_cast<Eigen::Index>(joint) + kLocks;
  addVelocities(impulse * inverse_masses_.cwiseProduct(directions_.row(row).transpose()), scene);
}

void PlanarJoints::warmStart(PlanarScene& scene) {
  push(scene, lock_impulses_);
  for (std::size_t j = 0; j < impulses_.size(); ++j)
    push(scene, j, impulses_[j].limit + impulses_[j].motor);
}

void PlanarJoints::solveLocks(PlanarScene& scene, double h) {
  for (int round = 0; round < kMostRounds; ++round) {
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
      const PlanarJoint& joint = scene.joints[j];
      const auto off = computeCoordinates(joint, movedOn(scene.bodies[joint.a], h),
                                          movedOn(bodyB(scene, joint), h));
      const auto row = kLocks * static_cast<Eigen::Index>(j);
      errors_[row] = off[0];
      errors_[row + 1] = off[1];
    }
    if (errors_.cwiseAbs().maxCoeff() < kClosed) return;
    const Eigen::VectorXd impulses = lock_masses_.solve(-1.0 / h * errors_);
    lock_impulses_ += impulses;
    push(scene, impulses);
  }
}

double PlanarJoints::computeRate(const PlanarScene& scene, std::size_t j, double h) const {
  const PlanarJoint& joint = scene.joints[j];
  const PlanarBody a = movedOn(scene.bodies[joint.a], h), b = movedOn(bodyB(scene, joint), h);
  return (computeCoordinates(joint, a, b)[2] - coordinates_[j]) / h;
}

double PlanarJoints::sweep(PlanarScene& scene, double h) {
  double largest = 0.0;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const PlanarJoint& joint = scene.joints[j];
    if (!joint.limit && !joint.motor) continue;
    const auto row = directions_.row(kRows * static_cast<Eigen::Index>(j) + kLocks);
    const double mass = 1.0 / row.dot(inverse_masses_.transpose().cwiseProduct(row));
    const auto relax = [&](double wanted, double low, double high, double& impulse) {
      const double next =
          std::clamp(impulse + mass * (wanted - computeRate(scene, j, h)), low, high);
      const double change = next - impulse;
      impulse = next;
      push(scene, j, change);
      largest = std::max(largest, std::abs(change) / mass);
    };
    if (joint.motor) {
      const double most = h * joint.motor->force;
      relax(joint.motor->speed, -most, most, impulses_[j].motor);
    }
    if (!joint.limit) continue;
    // A step may reach a limit, and go no further. Only one of the two is near.
    const double to_low = joint.limit->low - coordinates_[j];
    const double to_high = joint.limit->high - coordinates_[j];
    if (std::abs(to_low) < std::abs(to_high))
      relax(std::min(to_low, 0.0) / h, 0.0, HUGE_VAL, impulses_[j].limit);
    else
      relax(std::max(to_high, 0.0) / h, -HUGE_VAL, 0.0, impulses_[j].limit);
  }
  return largest;
}

void PlanarJoints::project(PlanarScene& scene) {
  computeDirections(scene);
  readVelocities(scene, velocities_);
  push(scene, lock_masses_.solve(-(locks_ * velocities_)));
}

}  // namespace tandem::demos::bench
