#include "replay/run_replay.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::view {

RunReplay::RunReplay(RecordedRun run, std::optional<int> user)
    : run_(std::move(run)), user_(chooseUser(user)), own_(run_, user_), scene_look_(own_.world()) {
  for (int site = 0; site < static_cast<int>(run_.sites.size()); ++site)
    if (site != user_ && run_.has(site))
      others_.push_back(std::make_unique<SiteReplay>(run_, site));
}

int RunReplay::chooseUser(std::optional<int> wanted) const {
  int first = 0;
  while (!run_.has(first)) ++first;
  const int user = wanted.value_or(first);
  if (run_.has(user)) return user;
  const std::string folder = run_.summary.parent_path().string();
  const auto count = std::ranges::count_if(run_.sites, [](const auto& site) { return !!site; });
  if (count > 1)
    throw demos::UsageError(
        fmt::format("--site {}: {} has sites 1 to {}", user + 1, folder, count));
  throw demos::UsageError(fmt::format("--site {}: {} has site {} only; give --site {}", user + 1,
                                      folder, first + 1, first + 1));
}

const std::vector<double>& RunReplay::frames() const {
  return run_.sites[static_cast<std::size_t>(user_)]->scene.times;
}

std::vector<Vec3> RunReplay::findWays() {
  std::vector<Vec3> ways_W;
  for (const double time : frames()) {
    own_.moveTo(time);
    ways_W.push_back(own_.hip_W());
    for (const demos::SceneBody& body : own_.world().bodies())
      if (body.role == "object" || body.role == "proxy")
        ways_W.push_back(own_.world().pose(body).p_W);
  }
  return ways_W;
}

SessionLook RunReplay::look(double time) {
  own_.moveTo(time);
  SessionLook look;
  look.time = time;
  look.list = scene_look_.look();
  for (const auto& other : others_) {
    other->moveTo(time);
    look.apart = std::max(look.apart, addGhosts(look.list, other->world()));
  }
  look.hip_W = own_.hip_W();
  look.force_W = own_.force_W();
  const std::vector<demos::SceneBody>& bodies = own_.world().bodies();
  const auto object = std::ranges::find(bodies, "object", &demos::SceneBody::role);
  if (object != bodies.end()) look.object_W = own_.world().pose(*object).p_W;
  return look;
}

}  // namespace tandem::view
