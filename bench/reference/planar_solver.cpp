#include "bench/reference/planar_solver.h"

#include <algorithm>
#include <cmath>

namespace tandem::demos::bench {
namespace {

/// Contacts are searched up to this gap [m]; no body moves as far in a step.
constexpr double kReach = 1e-3;
constexpr int kMostSweeps = 200;
/// Sweeps end when none changes a velocity by more [m/s]. Over a second that is less than 1e-9 m.
constexpr double kSettled = 1e-10;

/// Half the longest diameter; 0 for an infinite shape.
double boundingRadius(const PlanarBody& body) {
  if (body.shape == PlanarShape::kBox) return body.half.norm();
  return body.shape == PlanarShape::kCircle ? body.radius : 0.0;
}

bool areFarApart(const PlanarBody& a, const PlanarBody& b) {
  if (a.shape == PlanarShape::kHalfPlane || b.shape == PlanarShape::kHalfPlane) return false;
  return (a.p - b.p).norm() > boundingRadius(a) + boundingRadius(b) + kReach;
}

}  // namespace

PlanarSolver::PlanarSolver(PlanarScene scene)
    : scene_(std::move(scene)),
      joints_(scene_),
      tool_forces_(scene_.tools.size()),
      body_forces_(scene_.bodies.size()),
      body_torques_(scene_.bodies.size()),
      tool_v_(scene_.tools.size()),
      body_v_(scene_.bodies.size()),
      body_w_(scene_.bodies.size()) {}

void PlanarSolver::step(double h) {
  computeForces();
  kick(0.5 * h);
  findRows();
  if (!joints_.empty()) joints_.look(scene_, h);
  solveVelocities(h);
  for (PlanarTool& tool : scene_.tools) tool.p += h * tool.v;
  for (PlanarBody& body : scene_.bodies) {
    body.p += h * body.v;
    body.angle += h * body.w;
  }
  // The second half kick uses the forces at its own end, so that damping is symmetric in time. Two
  // rounds reduce the velocity's error to (h B / m)^2.
  for (std::size_t i = 0; i < tool_v_.size(); ++i) tool_v_[i] = scene_.tools[i].v;
  for (std::size_t b = 0; b < body_v_.size(); ++b) {
    body_v_[b] = scene_.bodies[b].v;
    body_w_[b] = scene_.bodies[b].w;
  }
  for (int round = 0; round < 2; ++round) {
    computeForces();
    for (std::size_t i = 0; i < tool_v_.size(); ++i) scene_.tools[i].v = tool_v_[i];
    for (std::size_t b = 0; b < body_v_.size(); ++b) {
      scene_.bodies[b].v = body_v_[b];
      scene_.bodies[b].w = body_w_[b];
    }
    kick(0.5 * h);
    if (!joints_.empty()) joints_.project(scene_);
  }
}

void PlanarSolver::computeForces() {
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    body_forces_[b] = scene_.bodies[b].mass * scene_.gravity;
    body_torques_[b] = 0.0;
  }
  for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
    const PlanarTool& tool = scene_.tools[i];
    Vec2& force = tool_forces_[i];
    force = tool.force;
    if (tool.is_held)
      force += scene_.coupler_stiffness * (tool.target_p - tool.p) +
               scene_.coupler_damping * (tool.target_v - tool.v);
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const PlanarBody& body = scene_.bodies[b];
      const PlanarTouch touch = computePlanarTouch(body, tool.p, tool.radius);
      if (touch.overlap <= 0.0) continue;
      const double closing = -touch.normal.dot(tool.v - body.velocityAt(touch.point));
      const Vec2 push = std::max(0.0, scene_.contact_stiffness * touch.overlap +
                                          scene_.contact_damping * closing) *
                        touch.normal;
      force += push;
      body_forces_[b] -= push;
      body_torques_[b] -= cross(touch.point - body.p, push);
    }
  }
}

void PlanarSolver::kick(double h) {
  for (std::size_t i = 0; i < scene_.tools.size(); ++i)
    scene_.tools[i].v += h / scene_.tools[i].mass * tool_forces_[i];
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    PlanarBody& body = scene_.bodies[b];
    body.v += h * body.inverseMass() * body_forces_[b];
    body.w += h * body.inverseInertia() * body_torques_[b];
  }
}

void PlanarSolver::findRows() {
  std::swap(rows_, old_rows_);
  rows_.clear();
  for (std::size_t a = 0; a < scene_.bodies.size(); ++a)
    for (std::size_t b = a + 1; b < scene_.bodies.size(); ++b) {
      const PlanarBody& first = scene_.bodies[a];
      const PlanarBody& second = scene_.bodies[b];
      if ((first.mass == 0.0 && second.mass == 0.0) || areFarApart(first, second)) continue;
      if (joints_.areJoined(scene_, a, b)) continue;
      addRows(a, b, computeManifold(first, second, kReach));
    }
  for (Row& row : rows_) warmStart(row);
}

void PlanarSolver::addRows(std::size_t a, std::size_t b, const PlanarManifold& manifold) {
  const PlanarBody& first = scene_.bodies[a];
  const PlanarBody& second = scene_.bodies[b];
  const double inverse_mass = first.inverseMass() + second.inverseMass();
  const Vec2 tangent = turnQuarter(manifold.normal);
  for (int k = 0; k < manifold.count; ++k) {
    const PlanarPoint& point = manifold.points[static_cast<std::size_t>(k)];
    Row row{
        a,   b,  point.feature, manifold.normal, point.p - first.p, point.p - second.p, point.gap,
        0.0, 0.0};
    const auto effective = [&](const Vec2& direction) {
      const double ra = cross(row.arm_a, direction), rb = cross(row.arm_b, direction);
      return 1.0 /
             (inverse_mass + first.inverseInertia() * ra * ra + second.inverseInertia() * rb * rb);
    };
    row.normal_mass = effective(manifold.normal);
    row.tangent_mass = effective(tangent);
    rows_.push_back(row);
  }
}

void PlanarSolver::warmStart(Row& row) const {
  for (const Row& old : old_rows_)
    if (old.a == row.a && old.b == row.b && old.feature == row.feature) {
      row.normal_impulse = old.normal_impulse;
      row.tangent_impulse = old.tangent_impulse;
      return;
    }
}

void PlanarSolver::applyImpulse(const Row& row, const Vec2& impulse) {
  PlanarBody& a = scene_.bodies[row.a];
  PlanarBody& b = scene_.bodies[row.b];
  a.v -= a.inverseMass() * impulse;
  a.w -= a.inverseInertia() * cross(row.arm_a, impulse);
  b.v += b.inverseMass() * impulse;
  b.w += b.inverseInertia() * cross(row.arm_b, impulse);
}

double PlanarSolver::sweep(double h) {
  double largest = 0.0;
  const auto speedAt = [&](const Row& row, const Vec2& direction) {
    const PlanarBody& a = scene_.bodies[row.a];
    const PlanarBody& b = scene_.bodies[row.b];
    return direction.dot(b.v + b.w * turnQuarter(row.arm_b) - a.v - a.w * turnQuarter(row.arm_a));
  };
  for (Row& row : rows_) {
    // The gap may close in this step; overlap must only not grow.
    const double allowed = std::max(row.gap, 0.0) / h;
    const double wanted =
        row.normal_impulse - row.normal_mass * (speedAt(row, row.normal) + allowed);
    const double normal = std::max(0.0, wanted);
    const double change = normal - row.normal_impulse;
    row.normal_impulse = normal;
    applyImpulse(row, change * row.normal);

    const Vec2 tangent = turnQuarter(row.normal);
    const double most = scene_.friction * row.normal_impulse;
    const double stuck = row.tangent_impulse - row.tangent_mass * speedAt(row, tangent);
    const double rubbed = std::clamp(stuck, -most, most);
    const double rub_change = rubbed - row.tangent_impulse;
    row.tangent_impulse = rubbed;
    applyImpulse(row, rub_change * tangent);
    largest = std::max(
        {largest, std::abs(change) / row.normal_mass, std::abs(rub_change) / row.tangent_mass});
  }
  return largest;
}

void PlanarSolver::solveVelocities(double h) {
  for (const Row& row : rows_)
    applyImpulse(row,
                 row.normal_impulse * row.normal + row.tangent_impulse * turnQuarter(row.normal));
  if (joints_.empty()) {
    for (int i = 0; i < kMostSweeps; ++i)
      if (sweep(h) < kSettled) return;
    return;
  }
  joints_.warmStart(scene_);
  joints_.solveLocks(scene_, h);
  for (int i = 0; i < kMostSweeps; ++i) {
    const double change = std::max(sweep(h), joints_.sweep(scene_, h));
    joints_.solveLocks(scene_, h);
    if (change < kSettled) return;
  }
}

double PlanarSolver::normalImpulse(std::size_t a, std::size_t b) const {
  double sum = 0.0;
  for (const Row& row : rows_)
    if ((row.a == a && row.b == b) || (row.a == b && row.b == a)) sum += row.normal_impulse;
  return sum;
}

}  // namespace tandem::demos::bench
