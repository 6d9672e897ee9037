#include "bench/speed/speed_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos::bench {
namespace {

constexpr int kNameWidth = 42;
const SpeedWay kWays[] = {SpeedWay::kBare60, SpeedWay::kBare240, SpeedWay::kWhole,
                          SpeedWay::kIsland};

/// Formats with three digits at any size.
std::string number(double value) {
  if (std::abs(value) >= 100.0) return fmt::format("{:.0f}", value);
  return std::abs(value) >= 10.0 ? fmt::format("{:.1f}", value) : fmt::format("{:.2f}", value);
}

std::string cell(const SpeedResult* result) {
  if (!result) return {};
  std::string text =
      fmt::format("{} | {}", number(result->us_per_second), number(result->us_per_step));
  if (result->us_per_tick > 0.0) text += " | " + number(result->us_per_tick);
  return text;
}

nlohmann::json caseJson(const SpeedCase& c) {
  nlohmann::json results = nlohmann::json::array();
  for (const SpeedResult& result : c.results) {
    nlohmann::json j = {{"way", nameOf(result.way)},
                        {"us_per_second", result.us_per_second},
                        {"us_per_step", result.us_per_step},
                        {"step_over_bare_us", result.step_over_bare}};
    if (result.times_cheaper > 0.0) j["times_cheaper"] = result.times_cheaper;
    if (result.us_per_tick > 0.0) j["us_per_tick"] = result.us_per_tick;
    results.push_back(std::move(j));
  }
  const char* const touches[] = {"nothing", "cube", "cube_on_floor", "row"};
  return {{"name", c.name},
          {"bodies", c.scene.bodies},
          {"awake", c.scene.awake},
          {"objects", c.scene.objects},
          {"users", c.scene.users},
          {"touch", touches[static_cast<int>(c.scene.touch)]},
          {"results", std::move(results)}};
}

}  // namespace

std::string makeSpeedTable(const SpeedReport& report) {
  std::string text =
      "Each cell: run time per simulated second | per host step | per haptic tick outside of it "
      "[us]; medians,\nall ways of a row in turn.\n\n";
  text += fmt::format("{:<{}}", "", kNameWidth);
  for (const SpeedWay way : kWays) text += fmt::format("{:>24}", nameOf(way));
  text += '\n';
  for (const SpeedCase& c : report.cases) {
    text += fmt::format("{:<{}}", c.name, kNameWidth);
    for (const SpeedWay way : kWays) text += fmt::format("{:>24}", cell(c.find(way)));
    text += '\n';
  }
  text += '\n';
  for (const SpeedCheck& check : report.checks)
    text += fmt::format("{:<4}  {:<78}{:>9} {:<2} (at {} {})\n", check.isMet() ? "pass" : "FAIL",
                        check.name, number(check.value), check.unit,
                        check.at_least ? "least" : "most", number(check.limit));
  return text;
}

nlohmann::json makeSpeedJson(const SpeedReport& report, bool quick) {
  nlohmann::json cases = nlohmann::json::array(), ticks = cases, checks = cases;
  for (const SpeedCase& c : report.cases) cases.push_back(caseJson(c));
  for (const IslandTick& tick : report.island_ticks)
    ticks.push_back({{"name", tick.name}, {"us", tick.us}});
  for (const SpeedCheck& check : report.checks)
    checks.push_back({{"name", check.name},
                      {"value", check.value},
                      {"limit", check.limit},
                      {"unit", check.unit},
                      {"bound", check.at_least ? "at_least" : "at_most"},
                      {"passes", check.isMet()}});
  return {{"format", "tandem-bench-speed"},
          {"version", 1},
          {"quick", quick},
          {"cases", std::move(cases)},
          {"island_ticks", std::move(ticks)},
          {"checks", std::move(checks)}};
}

}  // namespace tandem::demos::bench
