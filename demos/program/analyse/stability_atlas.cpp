#include "analyse/stability_atlas.h"

#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analyse/loop_of_scenario.h"
#include "plot/drawing.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "stability.json";

/// Steps of curves over the delay, for each point along x: packets make fine ripples.
constexpr std::size_t kStepsPerPoint = 4;

/// Contact of a kinematic proxy goes over the network itself.
LoopGain findDelayedStiffness(StandInKind kind) {
  return kind == StandInKind::kHeld ? LoopGain::kContactStiffness
                                    : LoopGain::kCoordinationStiffness;
}

std::string nameCsv(const GrowthMap& map) {
  return fmt::format("map-{}.csv", schemeOf(map.loop.stand_in));
}

nlohmann::json describeAxis(const GrowthMap& map, const MapAxis& axis) {
  return {{"key", name(axis.gain)},
          {"unit", unit(axis.gain)},
          {"points", axis.values.size()},
          {"is_logarithmic", axis.is_logarithmic},
          {"value", valueOf(map.loop, axis.gain)}};
}

nlohmann::json describeMap(const GrowthMap& map) {
  return {{"scheme", schemeOf(map.loop.stand_in)},
          {"file", nameCsv(map)},
          {"x", describeAxis(map, map.x)},
          {"y", describeAxis(map, map.y)}};
}

nlohmann::json describeCurves(const CurveSet& set) {
  nlohmann::json described = {{"x", set.x}, {"curves", nlohmann::json::array()}};
  for (const Curve& curve : set.curves) {
    nlohmann::json values = nlohmann::json::array();
    for (const auto& value : curve.values)
      values.push_back(value ? nlohmann::json(*value) : nlohmann::json());
    described["curves"].push_back({{"name", curve.name}, {"values", std::move(values)}});
  }
  return described;
}

/// Files of any atlas. A folder without its mark is somebody else's, unless it is empty.
std::vector<std::string> listAllFiles() {
  std::vector<std::string> files;
  for (const StandInKind kind : {StandInKind::kNone, StandInKind::kHeld, StandInKind::kDynamic})
    files.push_back(fmt::format("map-{}.csv", schemeOf(kind)));
  for (const char* figure : {"map", "damping", "users", "limits", "fine", "touch"})
    for (const char* suffix : {"svg", "png"}) files.push_back(fmt::format("{}.{}", figure, suffix));
  return files;
}

const std::string& checkFolder(const std::string& folder) {
  std::error_code ignored;
  if (fs::exists(fs::path(folder) / kMark, ignored)) return folder;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (!entry.path().filename().string().starts_with(".tandem-"))
      throw UsageError(fmt::format(
          "--out {}: holds other things; choose a new folder, or one of an earlier analysis",
          folder));
  return folder;
}

}  // namespace

StabilityAtlas makeMapAtlas(const std::string& title, const LoopSettings& loop,
                            const std::pair<LoopGain, LoopGain>& gains, const MapSize& size,
                            const AtlasProgress& show) {
  StabilityAtlas atlas{title, loop, {makeMap(loop, gains.first, gains.second, size)}, {}};
  Jobs jobs;
  addMapJobs(atlas.maps.front(), jobs);
  runOnAllCores(jobs, show);
  return atlas;
}

StabilityAtlas makeWholeAtlas(const std::string& title, const LoopSettings& loop,
                              const MapSize& size, const AtlasProgress& show) {
  StabilityAtlas atlas{title, loop, {}, {}};
  Jobs jobs;
  for (const StandInKind kind : listStandIns(loop)) {
    LoopSettings there = loop;
    there.stand_in = kind;
    atlas.maps.push_back(makeMap(there, LoopGain::kDelay, findDelayedStiffness(kind), size));
  }
  for (GrowthMap& map : atlas.maps) addMapJobs(map, jobs);
  const auto add = [&](const char* name, auto addJobs) {
    CurveSet set{listDelays(kStepsPerPoint * size.x), {}};
    addJobs(loop, set, jobs);  // its values keep their place when it moves
    if (!set.curves.empty()) atlas.curves.push_back({name, std::move(set)});
  };
  add("damping", addDampingJobs);
  add("users", addUserJobs);
  add("coordination_limits", addCoordinationLimitJobs);
  add("contact_limits", addContactLimitJobs);
  add("fine", addFineJobs);
  add("touch", addTouchJobs);
  runOnAllCores(jobs, show);
  return atlas;
}

std::string writeJson(const StabilityAtlas& atlas) {
  nlohmann::json json = {{"format", "tandem-stability"},
                         {"title", atlas.title},
                         {"scheme", schemeOf(atlas.loop.stand_in)},
                         {"users", atlas.loop.users},
                         {"has_object", atlas.loop.has_object},
                         {"maps", nlohmann::json::array()},
                         {"curves", nlohmann::json::object()}};
  for (const LoopGain gain : allLoopGains()) json["gains"][name(gain)] = valueOf(atlas.loop, gain);
  for (const GrowthMap& map : atlas.maps) json["maps"].push_back(describeMap(map));
  for (const AtlasCurves& one : atlas.curves) json["curves"][one.name] = describeCurves(one.set);
  return json.dump(1) + "\n";
}

AtlasFolder::AtlasFolder(const std::string& folder)
    : path_(checkFolder(folder)), files_(path_, "--out " + folder) {
  requireDrawing();
}

fs::path AtlasFolder::write(const StabilityAtlas& atlas) const {
  for (const GrowthMap& map : atlas.maps) writeText(files_ / nameCsv(map), writeCsv(map));
  writeText(files_ / kMark, writeJson(atlas));
  drawAnalysis(files_ / kMark);
  files_.publish(kMark, listAllFiles());
  return path_ / kMark;
}

}  // namespace tandem::demos
