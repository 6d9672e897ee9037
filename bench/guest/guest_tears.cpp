#include "bench/guest/guest_tears.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_world.h"

namespace tandem::demos::bench {
namespace {

constexpr double kUnbounded = 1e15;    // a bound that is none
constexpr double kNoStiffness = 1e-9;  // part of the stiffest way in which nothing can move

/// True if the row's error is corrected with any force: it is locked, or a limit that is exceeded.
bool isCorrected(const JointLine& line) {
  const double low = static_cast<double>(line.low), high = static_cast<double>(line.high);
  if (low < -kUnbounded && high > kUnbounded) return true;
  if (high > kUnbounded) return low >= 0.0 && line.error > 0;
  return low < -kUnbounded && high <= 0.0 && line.error < 0;
}

/// M^-1 J^T of a row, by which a body's velocity answers.
struct Answer {
  Vec3 v_W, w_W;
};

Answer answerOf(const btRigidBody& body, const btScalar* way, const btScalar* turn) {
  const btVector3 linear(way[0], way[1], way[2]), angular(turn[0], turn[1], turn[2]);
  return {fromBullet(linear * body.getInvMass() * body.getLinearFactor()),
          fromBullet(body.getInvInertiaTensorWorld() * angular * body.getAngularFactor())};
}

/// J M^-1 J^T of the rows for one of the joint's bodies.
Eigen::MatrixXd compliance(const std::vector<JointLine>& rows, const btRigidBody& body, bool is_a) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd matrix(count, count);
  const auto vector = [](const btScalar* x) { return fromBullet(btVector3(x[0], x[1], x[2])); };
  for (Eigen::Index j = 0; j < count; ++j) {
    const JointLine& cause = rows[static_cast<std::size_t>(j)];
    const Answer answer =
        answerOf(body, is_a ? cause.way_a : cause.way_b, is_a ? cause.turn_a : cause.turn_b);
    for (Eigen::Index i = 0; i < count; ++i) {
      const JointLine& row = rows[static_cast<std::size_t>(i)];
      matrix(i, j) = vector(is_a ? row.way_a : row.way_b).dot(answer.v_W) +
                     vector(is_a ? row.turn_a : row.turn_b).dot(answer.w_W);
    }
  }
  return 0.5 * (matrix + matrix.transpose());
}

/// Mass that the host sees, by Bullet's; 1 for what is no body of the case.
double shareOf(const GuestWorld& world, const btRigidBody& rigid) {
  for (const auto& body : world.bodies())
    if (body->rigid == &rigid)
      return std::max(1.0, body->mass * static_cast<double>(rigid.getInvMass()));
  return 1.0;
}

}  // namespace

double computeTear(btTypedConstraint& joint, const TearRates& rates, double share_a,
                   double share_b) {
  if (!joint.isEnabled()) return 0.0;
  std::vector<JointLine> rows = readRows(joint, rates);
  std::erase_if(rows, [](const JointLine& line) { return !isCorrected(line); });
  if (rows.empty()) return 0.0;
  const Eigen::MatrixXd of_a = compliance(rows, joint.getRigidBodyA(), true);
  const Eigen::MatrixXd of_b = compliance(rows, joint.getRigidBodyB(), false);
  Eigen::VectorXd speeds(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    speeds[static_cast<Eigen::Index>(i)] = static_cast<double>(rows[i].error);
  if (!speeds.allFinite() || !of_a.allFinite() || !of_b.allFinite()) return 0.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ways(of_a + of_b);
  const double least = kNoStiffness * ways.eigenvalues().maxCoeff();
  if (!(least > 0.0)) return 0.0;
  Eigen::VectorXd impulses = Eigen::VectorXd::Zero(speeds.size());
  for (Eigen::Index i = 0; i < speeds.size(); ++i)
    if (ways.eigenvalues()[i] > least)
      impulses += ways.eigenvectors().col(i) *
                  (ways.eigenvectors().col(i).dot(speeds) / ways.eigenvalues()[i]);
  return 0.5 * impulses.dot((share_a * of_a + share_b * of_b) * impulses);
}

double tearsOf(GuestWorld& world) {
  if (!world.hasWorld() || world.joints().empty()) return 0.0;
  const btContactSolverInfo& info = world.world().getSolverInfo();
  const TearRates rates{1.0 / world.plan().step(), static_cast<double>(info.m_erp),
                        info.m_numIterations};
  double sum = 0.0;
  for (const auto& joint : world.joints())
    sum += computeTear(*joint, rates, shareOf(world, joint->getRigidBodyA()),
                       shareOf(world, joint->getRigidBodyB()));
  return sum;
}

}  // namespace tandem::demos::bench
