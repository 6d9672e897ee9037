#include "window/status_file.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenario/keys.h"

namespace tandem::view {
namespace {

constexpr double kPeriod = 0.1;  // [s]

nlohmann::json toJson(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

StatusFile::StatusFile(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "w")) {
  if (!file_)
    throw Error(fmt::format("--status {}: {}; name a file in a folder that exists", file.string(),
                            std::strerror(errno)));
}

void StatusFile::note(const demos::Scenario& scenario, const Pace& pace, const SessionLook& look,
                      double time, std::uint64_t frames) {
  if (time < next_) return;
  next_ = time + kPeriod;
  nlohmann::json line = {{"time", look.time},
                         {"world", scenario.file.stem().string()},
                         {"scheme", scenario.scheme},
                         {"contact", demos::nameOf(scenario.site.contact_model)},
                         {"paused", pace.is_paused},
                         {"speed", pace.speed},
                         {"delay", scenario.network.delay},
                         {"force", look.force_W.norm()},
                         {"hip", toJson(look.hip_W)},
                         {"object", toJson(look.object_W)},
                         {"apart", look.apart},
                         {"status", look.status},
                         {"waiting", look.is_waiting},
                         {"link", nameOf(look.link)},
                         {"ticks", look.loop.ticks},
                         {"skipped", look.loop.skipped},
                         {"frames", frames}};
  if (look.followed) line["followed"] = *look.followed + 1;
  for (const UserLook& one : look.users)
    line["users"].push_back({{"site", one.user + 1},
                             {"hand", toJson(one.hand_W)},
                             {"age", one.age},
                             {"live", one.is_live}});
  std::fputs((line.dump() + '\n').c_str(), file_.get());
  std::fflush(file_.get());
}

}  // namespace tandem::view
