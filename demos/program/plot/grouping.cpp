#include "plot/grouping.h"

#include <algorithm>
#include <map>
#include <set>

#include "plot/labels.h"
#include "plot/reference.h"

namespace tandem::demos::plot {
namespace {

using nlohmann::json;
using Settings = std::map<std::string, json>;  // JSON pointer -> value

const char* const kScheme = "/experiment/scheme";
const char* const kDamping = "/device/damping";

bool isTitle(const std::string& pointer) {
  const std::string key = pointer.substr(pointer.rfind('/') + 1);
  return key == "name" || key == "title" || key == "description";
}

Settings settingsOf(const Run& run) {
  Settings settings;
  const json flat = run.scenario.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (isTitle(pointer)) continue;
    settings[pointer] = value.is_number() ? json(value.get<double>()) : value;  // 200 equals 200.0
  }
  settings["/scalar"] = run.scalar;
  return settings;
}

Settings settingsWithout(const Run& run, std::initializer_list<const char*> pointers) {
  Settings settings = settingsOf(run);
  for (const char* pointer : pointers) settings.erase(pointer);
  return settings;
}

void addRun(SchemeGroup& group, const Run& run) {
  if (group.find(run.scheme) == nullptr) group.runs.push_back(&run);
}

// In the order in which their first runs were given.
std::vector<SchemeGroup> groupBySettings(const std::vector<Run>& runs) {
  std::vector<SchemeGroup> groups;
  std::map<Settings, std::size_t> index;
  for (const Run& run : runs) {
    if (run.live) continue;
    const auto [at, is_new] = index.emplace(settingsWithout(run, {kScheme}), groups.size());
    if (is_new) groups.emplace_back();
    addRun(groups[at->second], run);
  }
  for (SchemeGroup& group : groups)
    std::sort(group.runs.begin(), group.runs.end(), [](const Run* a, const Run* b) {
      return schemeRank(a->scheme) < schemeRank(b->scheme);
    });
  return groups;
}

double dampingOf(const SchemeGroup& group) { return group.first().setting(kDamping); }

std::vector<Sweep> findSweeps(const std::vector<SchemeGroup>& groups) {
  std::map<Settings, Sweep> by_settings;
  for (const SchemeGroup& group : groups)
    by_settings[settingsWithout(group.first(), {kScheme, kDamping})].points.push_back(group);
  std::vector<Sweep> sweeps;
  for (auto& [settings, sweep] : by_settings) {
    if (sweep.points.size() < 2) continue;
    std::sort(
        sweep.points.begin(), sweep.points.end(),
        [](const SchemeGroup& a, const SchemeGroup& b) { return dampingOf(a) < dampingOf(b); });
    sweeps.push_back(std::move(sweep));
  }
  std::stable_sort(sweeps.begin(), sweeps.end(),
                   [](const Sweep& a, const Sweep& b) { return a.kind() < b.kind(); });
  return sweeps;
}

// The one point of a sweep that is shown in detail. Pointers into one vector: lower is given first.
const Run* detailOf(const Sweep& sweep) {
  const Run* earliest = &sweep.points.front().first();
  for (const SchemeGroup& point : sweep.points) {
    if (referenceOf(point.first()) != nullptr) return &point.first();
    for (const Run* run : point.runs) earliest = std::min(earliest, run);
  }
  for (const SchemeGroup& point : sweep.points)
    if (std::find(point.runs.begin(), point.runs.end(), earliest) != point.runs.end())
      return &point.first();
  return earliest;
}

bool isCoveredBySweep(const SchemeGroup& group, const std::vector<Sweep>& sweeps) {
  for (const Sweep& sweep : sweeps)
    for (const SchemeGroup& point : sweep.points)
      if (&point.first() == &group.first()) return detailOf(sweep) != &group.first();
  return false;
}

// What tells siblings apart, written with units: "contact stiffness 4000 N/m, network delay 0.1 s".
std::vector<std::string> differencesOf(const std::vector<Settings>& siblings) {
  std::set<std::string> pointers;
  for (const Settings& settings : siblings)
    for (const auto& [pointer, value] : settings) pointers.insert(pointer);

  std::vector<std::string> texts(siblings.size());
  for (const std::string& pointer : pointers) {
    const auto valueIn = [&](const Settings& settings) {
      const auto found = settings.find(pointer);
      return found == settings.end() ? json() : found->second;
    };
    const bool is_shared = std::all_of(siblings.begin(), siblings.end(), [&](const Settings& s) {
      return valueIn(s) == valueIn(siblings.front());
    });
    if (is_shared) continue;
    for (std::size_t i = 0; i < siblings.size(); ++i)
      texts[i] += (texts[i].empty() ? "" : ", ") + settingText(pointer, valueIn(siblings[i]));
  }
  return texts;
}

void nameDifferences(std::vector<SchemeGroup>& groups) {
  std::vector<Settings> siblings;
  for (const SchemeGroup& group : groups)
    siblings.push_back(settingsWithout(group.first(), {kScheme}));
  const std::vector<std::string> texts = differencesOf(siblings);
  for (std::size_t i = 0; i < groups.size(); ++i) groups[i].difference = texts[i];
}

void nameDifferences(std::vector<Sweep>& sweeps, RunKind kind) {
  std::vector<Sweep*> same_kind;
  std::vector<Settings> siblings;
  for (Sweep& sweep : sweeps)
    if (sweep.kind() == kind) {
      same_kind.push_back(&sweep);
      siblings.push_back(settingsWithout(sweep.points.front().first(), {kScheme, kDamping}));
    }
  const std::vector<std::string> texts = differencesOf(siblings);
  for (std::size_t i = 0; i < same_kind.size(); ++i) same_kind[i]->difference = texts[i];
}

}  // namespace

const Run* SchemeGroup::find(std::string_view scheme) const {
  for (const Run* run : runs)
    if (run->scheme == scheme) return run;
  return nullptr;
}

std::string describeWithoutScheme(const Run& run) {
  return json(settingsWithout(run, {kScheme})).dump();
}

bool haveEqualSettings(const Run& a, const Run& b) { return settingsOf(a) == settingsOf(b); }

Grouping groupRuns(const std::vector<Run>& runs) {
  const std::vector<SchemeGroup> groups = groupBySettings(runs);
  Grouping grouping;
  grouping.sweeps = findSweeps(groups);
  for (const SchemeGroup& group : groups) {
    if (isCoveredBySweep(group, grouping.sweeps)) continue;
    const RunKind kind = group.first().kind;
    (kind == RunKind::kCooperation   ? grouping.cooperation
     : kind == RunKind::kUserContact ? grouping.contact
                                     : grouping.playground)
        .push_back(group);
  }
  for (auto* list : {&grouping.cooperation, &grouping.contact, &grouping.playground})
    nameDifferences(*list);
  for (const RunKind kind : {RunKind::kCooperation, RunKind::kUserContact, RunKind::kPlayground})
    nameDifferences(grouping.sweeps, kind);
  return grouping;
}

}  // namespace tandem::demos::plot
