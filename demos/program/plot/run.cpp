#include "plot/run.h"

#include <algorithm>

#include <fmt/format.h>

#include "plot/labels.h"
#include "plot/live_run.h"
#include "terminal/usage_error.h"

namespace tandem::demos::plot {
namespace {

using nlohmann::json;

// summary.json with messages that name file and key.
class Summary {
 public:
  Summary(json root, std::string source) : source_(std::move(source)), root_(std::move(root)) {}

  const json* find(const std::string& pointer) const {
    const json::json_pointer at(pointer);
    return root_.contains(at) && !root_.at(at).is_null() ? &root_.at(at) : nullptr;
  }

  // NaN when the key is absent or null: a measure that this kind of run does not have.
  double number(const std::string& pointer) const {
    const json* value = find(pointer);
    if (value == nullptr) return kMissing;
    if (!value->is_number()) refuse(pointer, "must be a number");
    return value->get<double>();
  }

  double requiredNumber(const std::string& pointer) const {
    if (find(pointer) == nullptr) refuse(pointer, "is missing");
    return number(pointer);
  }

  std::string text(const std::string& pointer, const std::string& fallback) const {
    const json* value = find(pointer);
    if (value == nullptr) return fallback;
    if (!value->is_string()) refuse(pointer, "must be a text");
    return value->get<std::string>();
  }

  std::string requiredText(const std::string& pointer) const {
    if (find(pointer) == nullptr) refuse(pointer, "is missing");
    return text(pointer, "");
  }

  [[noreturn]] void refuse(const std::string& pointer, const std::string& problem) const {
    std::string key = pointer.substr(1);
    std::replace(key.begin(), key.end(), '/', '.');
    throw UsageError(fmt::format("{}: key \"{}\" {}", source_, key, problem));
  }

 private:
  std::string source_;
  json root_;
};

RunKind kindOf(const std::string& text) {
  if (text == "cooperative_manipulation") return RunKind::kCooperation;
  if (text == "user_contact") return RunKind::kUserContact;
  return RunKind::kPlayground;
}

SiteOutcome readSiteOutcome(const Summary& summary, const std::string& site) {
  SiteOutcome outcome;
  outcome.received_mean = summary.number(site + "/coherency/received_mean");
  outcome.contact_transitions = summary.requiredNumber(site + "/contact_transitions");
  outcome.force_max = summary.number(site + "/force/max");
  outcome.force_mean = summary.number(site + "/force/mean");
  outcome.device_end = summary.number(site + "/device_end");
  return outcome;
}

SceneBody readBody(const Summary& summary, const std::string& at) {
  SceneBody body;
  body.site = summary.requiredNumber(at + "/site") < 1.5 ? 1 : 2;
  body.role = summary.requiredText(at + "/role");
  body.name = summary.text(at + "/name", body.role);
  body.is_static = summary.text(at + "/motion", "dynamic") == "static";
  const std::string shape = summary.requiredText(at + "/shape");
  if (shape == "box") {
    body.is_box = true;
    for (int axis = 0; axis < 3; ++axis)
      body.half_extents[axis] = summary.requiredNumber(fmt::format("{}/half_extents/{}", at, axis));
  } else if (shape == "sphere") {
    body.radius = summary.requiredNumber(at + "/radius");
  } else {
    summary.refuse(at + "/shape", fmt::format("is \"{}\"; allowed are box and sphere", shape));
  }
  return body;
}

std::vector<SceneBody> readBodies(const Summary& summary) {
  const json* list = summary.find("/scene/bodies");
  if (list == nullptr) return {};
  if (!list->is_array()) summary.refuse("/scene/bodies", "must be a list");
  std::vector<SceneBody> bodies;
  for (std::size_t i = 0; i < list->size(); ++i)
    bodies.push_back(readBody(summary, fmt::format("/scene/bodies/{}", i)));
  return bodies;
}

std::string folderName(const std::filesystem::path& dir) {
  const std::filesystem::path plain = dir.lexically_normal();
  if (plain.has_filename() && plain != ".") return plain.filename().string();
  if (plain.has_parent_path()) return plain.parent_path().filename().string();
  return std::filesystem::absolute(dir).lexically_normal().parent_path().filename().string();
}

}  // namespace

bool Run::hasObject() const {
  return bodies.empty() || std::any_of(bodies.begin(), bodies.end(),
                                       [](const SceneBody& body) { return body.role == "object"; });
}

double Run::setting(const std::string& pointer) const {
  const json::json_pointer at(pointer);
  if (!scenario.contains(at) || !scenario.at(at).is_number()) return kMissing;
  return scenario.at(at).get<double>();
}

std::string Run::settingText(const std::string& pointer) const {
  const json::json_pointer at(pointer);
  if (!scenario.contains(at) || !scenario.at(at).is_string()) return "";
  return scenario.at(at).get<std::string>();
}

json parseObject(const std::string& text, const std::string& source) {
  json object = json::parse(text, nullptr, false);
  if (!object.is_object()) throw UsageError(fmt::format("{}: not a JSON object", source));
  return object;
}

Run parseRun(const std::string& summary_text, const std::filesystem::path& dir,
             const std::string& source) {
  return makeRun(parseObject(summary_text, source), dir, source);
}

Run makeRun(json root, const std::filesystem::path& dir, const std::string& source) {
  const Summary summary(std::move(root), source);
  Run run;
  run.dir = dir;
  run.kind = kindOf(summary.requiredText("/scenario/experiment/kind"));
  run.scheme = summary.requiredText("/scenario/experiment/scheme");
  if (!isKnownScheme(run.scheme))
    summary.refuse("/scenario/experiment/scheme",
                   fmt::format("is \"{}\"; allowed are virtual_coupling, kinematic_proxy and "
                               "remote_dynamic_proxy",
                               run.scheme));
  run.scenario = *summary.find("/scenario");
  run.name = folderName(dir);
  run.title = summary.text("/title", summary.text("/scenario/name", ""));
  if (run.title.empty()) run.title = run.name;
  run.scalar = summary.text("/scalar", "");
  run.mean_coherency = run.kind == RunKind::kCooperation
                           ? summary.requiredNumber("/coherency/mean_abs")
                           : summary.number("/coherency/mean_abs");
  run.max_coherency = summary.number("/coherency/max_abs");
  run.site = {readSiteOutcome(summary, "/site1"), readSiteOutcome(summary, "/site2")};
  run.real_time_factor = summary.number("/real_time_factor");
  run.state_hash = summary.text("/state_hash", "");
  run.bodies = readBodies(summary);
  return run;
}

Run loadRun(const std::filesystem::path& dir) {
  if (isLiveFolder(dir)) return loadLiveRun(dir);
  const std::filesystem::path file = dir / "summary.json";
  return parseRun(readText(file), dir, file.string());
}

std::array<Table, 2> loadSites(const Run& run) {
  return {readTable(run.dir / "site1.csv"), readTable(run.dir / "site2.csv")};
}

}  // namespace tandem::demos::plot
