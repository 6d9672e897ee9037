#include "bench/accuracy/accuracy_report.h"

#include <algorithm>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos::bench {
namespace {

/// Errors below this are rounding and count as equal [m].
constexpr double kRounding = 1e-12;
constexpr int kNameWidth = 24;
constexpr int kCellWidth = 27;

std::vector<int> hostRatesOf(const SceneAccuracy& scene) {
  std::set<int> rates;
  for (const AccuracyRun& run : scene.runs) rates.insert(run.host_rate);
  return {rates.begin(), rates.end()};
}

std::vector<std::string> methodsOf(const SceneAccuracy& scene) {
  std::vector<std::string> methods;
  for (const AccuracyRun& run : scene.runs)
    if (std::find(methods.begin(), methods.end(), run.method) == methods.end())
      methods.push_back(run.method);
  return methods;
}

const AccuracyRun* findRun(const SceneAccuracy& scene, const std::string& method, int host_rate) {
  for (const AccuracyRun& run : scene.runs)
    if (run.method == method && run.host_rate == host_rate) return &run;
  return nullptr;
}

double leastError(const SceneAccuracy& scene, int host_rate) {
  double least = std::numeric_limits<double>::infinity();
  for (const AccuracyRun& run : scene.runs)
    if (run.host_rate == host_rate && run.isGood()) least = std::min(least, run.errors.position());
  return std::max(least, kRounding);
}

/// Formats a value in mm: "0.186" for 186 um, "2.1e-06" for 2.1 nm.
std::string number(double value) {
  if (value != 0.0 && value < 1e-3) return fmt::format("{:.1e}", value);
  return fmt::format("{:.3g}", value);
}

std::string cell(const AccuracyRun& run, double least) {
  if (!run.reason.empty()) return "n/a";
  if (run.diverged) return "diverges";
  const char* mark = run.errors.position() <= least ? "*" : "";
  return fmt::format("{}{} {} {:.0f}", mark, number(1e3 * run.errors.position()),
                     number(run.errors.force), run.us_per_second);
}

/// The most exact of Bullet's own ways at the haptic rate.
const AccuracyRun* findBestOfBullet(const SceneAccuracy& scene) {
  const AccuracyRun* best = nullptr;
  for (const AccuracyRun& run : scene.runs)
    if (run.is_bullet_alone && run.isGood() && run.host_rate == kTargetRate &&
        (!best || run.errors.position() < best->errors.position()))
      best = &run;
  return best;
}

/// Hand-off at each rate beside that way: factors of run time and errors.
std::string comparison(const SceneAccuracy& scene) {
  const AccuracyRun* bullet = findBestOfBullet(scene);
  if (!bullet) return "";
  std::string text;
  for (const int rate : hostRatesOf(scene)) {
    const AccuracyRun* run = findRun(scene, "plugin handoff", rate);
    if (!run || !run->isGood()) continue;
    const auto part = [](double ours, double theirs) {
      return number(ours / std::max(theirs, kRounding));
    };
    text += fmt::format(
        "  plugin handoff at {} Hz beside {} at {} Hz: run time x {}, position x {}", rate,
        bullet->method, kTargetRate, part(run->us_per_second, bullet->us_per_second),
        part(run->errors.position(), bullet->errors.position()));
    if (bullet->errors.force > 0.0)
      text += fmt::format(", force x {}", part(run->errors.force, bullet->errors.force));
    text += '\n';
  }
  return text;
}

/// Reasons why methods cannot run this scene, each once.
std::string notes(const SceneAccuracy& scene) {
  std::string text;
  for (const std::string& method : methodsOf(scene)) {
    std::set<std::string> reasons;
    for (const AccuracyRun& run : scene.runs)
      if (run.method == method && !run.reason.empty() && reasons.insert(run.reason).second)
        text += fmt::format("  n/a {}, {} Hz: {}\n", method, run.host_rate, run.reason);
  }
  return text;
}

nlohmann::json errorsJson(const RunErrors& errors) {
  return {{"tool", errors.tool}, {"body", errors.body}, {"force", errors.force}};
}

nlohmann::json runJson(const AccuracyRun& run) {
  nlohmann::json j = {{"method", run.method}, {"host_rate", run.host_rate}};
  if (!run.reason.empty()) {
    j["status"] = "not_applicable";
    j["reason"] = run.reason;
  } else if (run.diverged) {
    j["status"] = "diverged";
  } else {
    j["status"] = "good";
    j["errors"] = errorsJson(run.errors);
    j["us_per_second"] = run.us_per_second;
  }
  return j;
}

}  // namespace

std::string makeAccuracyTable(const std::vector<SceneAccuracy>& scenes) {
  std::string text =
      "Each cell: largest position error [mm], largest force error [N], run time per simulated "
      "second [us];\ncolumns are the host's step rates; * is the least error of its column.\n";
  for (const SceneAccuracy& scene : scenes) {
    text += fmt::format("\n{} ({})\n", scene.title, scene.scene);
    text += fmt::format("{:<{}}", "", kNameWidth);
    for (const int rate : hostRatesOf(scene))
      text += fmt::format("{:>{}}", fmt::format("{} Hz", rate), kCellWidth);
    text += '\n';
    for (const std::string& method : methodsOf(scene)) {
      text += fmt::format("{:<{}}", method, kNameWidth);
      for (const int rate : hostRatesOf(scene)) {
        const AccuracyRun* run = findRun(scene, method, rate);
        text += fmt::format("{:>{}}", run ? cell(*run, leastError(scene, rate)) : "", kCellWidth);
      }
      text += '\n';
    }
    text += fmt::format("  reference: {}; itself good to {} mm, {} N\n", scene.reference,
                        number(1e3 * scene.reference_errors.position()),
                        number(scene.reference_errors.force));
    text += comparison(scene);
    text += notes(scene);
  }
  return text;
}

nlohmann::json makeAccuracyJson(const std::vector<SceneAccuracy>& scenes, bool quick) {
  nlohmann::json all = nlohmann::json::array();
  for (const SceneAccuracy& scene : scenes) {
    nlohmann::json runs = nlohmann::json::array();
    for (const AccuracyRun& run : scene.runs) runs.push_back(runJson(run));
    all.push_back({{"scene", scene.scene},
                   {"title", scene.title},
                   {"reference", scene.reference},
                   {"reference_errors", errorsJson(scene.reference_errors)},
                   {"runs", std::move(runs)}});
  }
  return {{"format", "tandem-bench-accuracy"},
          {"version", 1},
          {"quick", quick},
          {"scenes", std::move(all)}};
}

}  // namespace tandem::demos::bench
