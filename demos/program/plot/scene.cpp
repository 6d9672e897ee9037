#include "plot/scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::demos::plot {
namespace {

// Reads the rows of scene.csv: a new time begins a new frame.
class SceneReader {
 public:
  SceneReader(const Table& table, std::size_t bodies)
      : table_(table), t_(table.column("t")), body_(table.column("body")) {
    const char* const names[] = {"x", "y", "z", "qw", "qx", "qy", "qz"};
    for (const char* name : names) values_.push_back(&table.column(name));
    motion_.poses.resize(bodies);
    is_seen_.resize(bodies, false);
  }

  SceneMotion read() && {
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      if (motion_.times.empty() || t_[row] > motion_.times.back()) beginFrame(t_[row]);
      motion_.poses[bodyOf(row)].back() = poseOf(row);
    }
    for (std::size_t body = 0; body < is_seen_.size(); ++body)
      if (!is_seen_[body])
        throw UsageError(fmt::format("{}: column \"body\": body {} of summary.json never appears",
                                     table_.source(), body));
    return std::move(motion_);
  }

 private:
  // A body without a row in a frame stays where it was.
  void beginFrame(double t) {
    motion_.times.push_back(t);
    for (std::vector<Pose>& poses : motion_.poses)
      poses.push_back(poses.empty() ? Pose{} : poses.back());
  }

  std::size_t bodyOf(std::size_t row) {
    const double index = body_[row];
    if (!(index >= 0.0 && index < static_cast<double>(is_seen_.size())))
      throw UsageError(fmt::format("{}: line {}, column \"body\": {} is not a body of summary.json",
                                   table_.source(), row + 2, index));
    const auto body = static_cast<std::size_t>(index);
    is_seen_[body] = true;
    return body;
  }

  Pose poseOf(std::size_t row) const {
    const auto at = [&](std::size_t column) { return (*values_[column])[row]; };
    Pose pose;
    pose.p = Vec3(at(0), at(1), at(2));
    const Quat q(at(3), at(4), at(5), at(6));
    if (!pose.p.allFinite() || !(q.norm() > 0.5 && q.norm() < 2.0))
      throw UsageError(fmt::format(
          "{}: line {}, columns \"x\" to \"qz\": not a finite position and unit quaternion",
          table_.source(), row + 2));
    pose.q = q.normalized();
    return pose;
  }

  const Table& table_;
  const std::vector<double>& t_;
  const std::vector<double>& body_;
  std::vector<const std::vector<double>*> values_;
  std::vector<bool> is_seen_;
  SceneMotion motion_;
};

}  // namespace

SceneMotion readScene(const Table& table, std::size_t bodies) {
  return SceneReader(table, bodies).read();
}

SceneMotion loadScene(const Run& run) {
  return readScene(readTable(run.dir / "scene.csv"), run.bodies.size());
}

bool doesRotate(const std::vector<Pose>& poses) {
  constexpr double kAngle = 0.02;  // [rad]
  return std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
    return pose.q.angularDistance(poses.front().q) > kAngle;
  });
}

Vec3 boxCorner(const SceneBody& body, const Pose& pose, int index) {
  const Vec3 sign(index & 1 ? 1 : -1, index & 2 ? 1 : -1, index & 4 ? 1 : -1);
  return pose.p + pose.q * body.half_extents.cwiseProduct(sign);
}

Bounds boundsOf(const SceneBody& body, const Pose& pose) {
  Bounds bounds;
  if (body.is_box) {
    for (int corner = 0; corner < 8; ++corner) bounds.include(boxCorner(body, pose, corner));
  } else {
    bounds.include(pose.p - Vec3::Constant(body.radius));
    bounds.include(pose.p + Vec3::Constant(body.radius));
  }
  return bounds;
}

Bounds movingBounds(const Run& run, const SceneMotion& motion, std::size_t begin, std::size_t end) {
  Bounds bounds;
  for (std::size_t b = 0; b < run.bodies.size(); ++b)
    for (std::size_t f = begin; f < end; ++f)
      if (!run.bodies[b].is_static) bounds.include(boundsOf(run.bodies[b], motion.poses[b][f]));
  return bounds;
}

Bounds interestingBounds(const Run& run, const SceneMotion& motion) {
  const Bounds moving = movingBounds(run, motion, 0, motion.frames());
  const double reach = moving.size().maxCoeff();
  Bounds bounds = moving;
  for (std::size_t b = 0; b < run.bodies.size(); ++b) {
    if (!run.bodies[b].is_static) continue;
    const Bounds body = boundsOf(run.bodies[b], motion.poses[b].front());
    const bool is_large = body.size().maxCoeff() > 2.0 * reach;
    const bool is_far = (body.centre() - moving.centre()).norm() > 1.5 * reach;
    if (!is_large && !is_far) bounds.include(body);
  }
  return bounds;
}

bool isSpatial(const Run& run, const SceneMotion& motion) {
  for (std::size_t b = 0; b < run.bodies.size(); ++b) {
    const std::string& role = run.bodies[b].role;
    if (role == "neighbour" || role == "obstacle") return true;
    if (run.bodies[b].is_box && doesRotate(motion.poses[b])) return true;
  }
  return run.kind == RunKind::kPlayground;
}

}  // namespace tandem::demos::plot
