#include "scenario/key_kinds.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tandem::demos {

double readNumber(const Place& place, const toml::node& node, const FieldRange& range) {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value) || !range.contains(*value))
    refuse(place, node, range.allowed);
  return *value;
}

Vec3 readVector(const Place& place, const toml::node& node) {
  const toml::array* array = node.as_array();
  if (!array || array->size() != 3) refuse(place, node, "three numbers, [x, y, z]");
  const FieldRange range{-1e6, 1e6, false, "finite numbers of at most 1e6"};
  Vec3 vector;
  for (std::size_t i = 0; i < 3; ++i)
    vector[static_cast<Eigen::Index>(i)] = readNumber(place, (*array)[i], range);
  return vector;
}

bool readFlag(const Place& place, const toml::node& node) {
  if (!node.is_boolean()) refuse(place, node, "true or false");
  return *node.value<bool>();
}

std::string readString(const Place& place, const toml::node& node) {
  const auto value = node.value<std::string>();
  if (!node.is_string() || !value) refuse(place, node, "a text in quotes");
  return *value;
}

std::size_t readChoice(const Place& place, const toml::node& node,
                       const std::vector<std::string>& choices) {
  const auto value = node.value<std::string>();
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (value && *value == choices[i]) return i;
  refuse(place, node, fmt::format("one of {}", fmt::join(choices, ", ")));
}

std::string joinNote(const std::string& allowed, const std::string& note) {
  return allowed + (note.empty() || allowed.empty() ? "" : "; ") + note;
}

std::string describeRange(const FieldRange& range) {
  const char* above = range.excludes_least ? "> " : "";
  if (range.most >= kMost)
    return fmt::format("{}{}", range.excludes_least ? "> " : ">= ", range.least);
  return fmt::format("{}{} to {}", above, range.least, range.most);
}

std::string describeChoices(const std::vector<std::string>& choices) {
  return fmt::format("`{}`", fmt::join(choices, "`, `"));
}

ScenarioKey siteKey(const char* field, const std::string& more) {
  const SiteField& found = findSiteField(field);
  FieldRange range = found.range;
  range.most = std::min(range.most, kMost);
  ScenarioKey key = siteKey(field, field, range);
  key.meaning += more;
  return key;
}

ScenarioKey siteKey(const char* name, const char* field, const FieldRange& range,
                    const std::string& note) {
  const SiteField& found = findSiteField(field);
  ScenarioKey key = makeKey({name, found.meaning, found.unit, note}, describeRange(range));
  key.is_own = !found.is_shared;
  key.read = [&found, range](Scenario& s, const Place& place, const toml::node& node) {
    found.set(s.site, readNumber(place, node, range));
  };
  key.show = [&found](const Scenario& s) -> nlohmann::json { return found.get(s.site); };
  return key;
}

ScenarioKey siteFlagKey(const char* name, const char* field, const std::string& more) {
  const SiteField& found = findSiteField(field);
  ScenarioKey key = makeKey({name, found.meaning + more, found.unit}, "true, false");
  key.is_own = !found.is_shared;
  key.read = [&found](Scenario& s, const Place& place, const toml::node& node) {
    found.set(s.site, readFlag(place, node) ? 1.0 : 0.0);
  };
  key.show = [&found](const Scenario& s) -> nlohmann::json { return found.get(s.site) != 0.0; };
  return key;
}

}  // namespace tandem::demos
