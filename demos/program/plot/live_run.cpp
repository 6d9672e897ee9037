#include "plot/live_run.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "plot/signals.h"
#include "scenario/own_keys.h"
#include "terminal/usage_error.h"

namespace tandem::demos::plot {
namespace {

using nlohmann::json;

double numberAt(const json& j, const char* pointer) {
  const json::json_pointer at(pointer);
  return j.contains(at) && j.at(at).is_number() ? j.at(at).get<double>() : kMissing;
}

/// What both sites must have been asked alike.
json sharedSettings(const json& site) {
  json shared = json::object();
  const json flat = site.value("scenario", json::object()).flatten();
  for (const auto& [pointer, value] : flat.items()) {
    std::string key = pointer.substr(pointer.empty() ? 0 : 1);
    std::replace(key.begin(), key.end(), '/', '.');
    if (!isOwnKey(key)) shared[key] = value;
  }
  return shared;
}

json describeSeparation(const Signal& separation) {
  if (separation.empty()) return json::object();
  const double sum = std::accumulate(separation.begin(), separation.end(), 0.0);
  return {{"mean_abs", sum / static_cast<double>(separation.size())},
          {"max_abs", *std::max_element(separation.begin(), separation.end())}};
}

}  // namespace

bool isLiveFolder(const std::filesystem::path& dir) {
  return std::filesystem::exists(dir / "site1.json") &&
         !std::filesystem::exists(dir / "summary.json");
}

Run loadLiveRun(const std::filesystem::path& dir) {
  const std::filesystem::path file1 = dir / "site1.json", file2 = dir / "site2.json";
  json both = parseObject(readText(file1), file1.string());
  const json other = parseObject(readText(file2), file2.string());
  if (sharedSettings(both) != sharedSettings(other))
    throw UsageError(
        fmt::format("{}: another scenario than in {}; give a folder that both sites "
                    "of one run wrote to",
                    file2.string(), file1.string()));
  both["site2"] = other.value("site2", json::object());
  both["coherency"] = describeSeparation(
      separationOf({readTable(dir / "site1.csv"), readTable(dir / "site2.csv")}));
  const LiveOutcome live{numberAt(both, "/network/round_trip"),
                         (numberAt(both, "/loop/late") + numberAt(other, "/loop/late")) /
                             (numberAt(both, "/loop/ticks") + numberAt(other, "/loop/ticks"))};
  Run run = makeRun(std::move(both), dir, dir.string());
  run.live = live;
  return run;
}

}  // namespace tandem::demos::plot
