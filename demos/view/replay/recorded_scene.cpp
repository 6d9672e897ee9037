#include "replay/recorded_scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "replay/number_table.h"
#include "replay/run_file.h"

namespace tandem::view {
namespace {

enum Column : std::size_t { kTime, kSite, kBody, kX, kY, kZ, kQw, kQx, kQy, kQz };

RecordedPose readPose(const NumberTable& row) {
  RecordedPose pose;
  pose.p_S = Vec3(row[kX], row[kY], row[kZ]);
  pose.q_SB = Quat(row[kQw], row[kQx], row[kQy], row[kQz]);
  // Seven digits are written.
  if (!(std::abs(pose.q_SB.norm() - 1.0) < 1e-5)) row.refuse("qw, qx, qy, qz: no unit quaternion");
  pose.q_SB.normalize();
  return pose;
}

/// Refuses a row of another body than the one whose turn it is.
void checkBody(const NumberTable& row, std::size_t place, const RecordedBody& body) {
  if (row[kBody] != static_cast<double>(place))
    row.refuse(fmt::format("body = {}: it is the turn of body {}", row[kBody], place));
  if (row[kSite] != body.site + 1)
    row.refuse(fmt::format("site = {}: body {} is of site {}", row[kSite], place, body.site + 1));
}

}  // namespace

std::vector<RecordedScene> readRecordedScenes(const std::filesystem::path& file,
                                              const std::vector<RecordedBody>& bodies,
                                              std::size_t sites) {
  std::vector<RecordedScene> scenes(sites);
  for (const RecordedBody& body : bodies)
    scenes[static_cast<std::size_t>(body.site)].names.push_back(body.name);
  NumberTable row(file, {"t", "site", "body", "x", "y", "z", "qw", "qx", "qy", "qz"});
  std::size_t place = 0;
  std::vector<double> times;
  while (row.next()) {
    checkBody(row, place, bodies[place]);
    const double time = row[kTime];
    if (place > 0 && time != times.back()) row.refuse("a frame has two times");
    if (place == 0 && !times.empty() && !(time > times.back())) row.refuse("time does not grow");
    if (place == 0) times.push_back(time);
    scenes[static_cast<std::size_t>(bodies[place].site)].poses.push_back(readPose(row));
    place = (place + 1) % bodies.size();
  }
  if (times.empty() || place != 0)
    row.refuse(fmt::format("the file ends before body {} of a frame", place));
  for (RecordedScene& scene : scenes) scene.times = times;
  return scenes;
}

RecordedPose computePose(const RecordedScene& scene, std::size_t body, double time) {
  const auto at = [&](std::ptrdiff_t frame) {
    return scene.poses[static_cast<std::size_t>(frame) * scene.names.size() + body];
  };
  const auto after = std::ranges::upper_bound(scene.times, time);
  const std::ptrdiff_t next = after - scene.times.begin();
  if (next == 0) return at(0);
  if (after == scene.times.end()) return at(next - 1);
  const double begin = *std::prev(after);
  const double share = (time - begin) / (*after - begin);
  const RecordedPose from = at(next - 1), to = at(next);
  return {from.p_S + share * (to.p_S - from.p_S), from.q_SB.slerp(share, to.q_SB)};
}

}  // namespace tandem::view
