#include "peer/changed_scenario.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "peer/peer_configuration.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr std::uint32_t kMostChanges = 999'999'999;

/// The keys that a change may set, as table and name.
constexpr std::array<std::array<const char*, 2>, 5> kKeys = {{{"experiment", "scheme"},
                                                              {"contact", "stiffness"},
                                                              {"contact", "damping"},
                                                              {"coordination", "stiffness"},
                                                              {"coordination", "damping"}}};

bool mayChange(const std::string& key) {
  return key.rfind("site", 0) == 0 || std::ranges::any_of(kKeys, [&](const auto& words) {
           return key == fmt::format("{}.{}", words[0], words[1]);
         });
}

/// The values as overrides, such as "contact.damping=5.0".
std::vector<std::string> listValues(const Scenario& scenario) {
  const nlohmann::json all = describeScenario(scenario);
  std::vector<std::string> values;
  for (const auto& [table, name] : kKeys) {
    const nlohmann::json& value = all.at(table).at(name);
    values.push_back(fmt::format("{}.{}={}", table, name,
                                 value.is_string() ? value.get<std::string>() : value.dump()));
  }
  return values;
}

[[noreturn]] void refuse(const std::string& told) {
  throw UsageError(fmt::format("{} = {}: must be a number and a value of each, {}", kChangeKey,
                               told, "scheme and gains; install the same release on all sides"));
}

/// The number before the first space.
std::uint32_t readNumber(const std::string& told) {
  std::uint32_t number = 0;
  const char* const end = told.data() + told.size();
  const auto [rest, error] = std::from_chars(told.data(), end, number);
  if (error != std::errc() || number == 0 || number > kMostChanges || rest == end || *rest != ' ')
    refuse(told);
  return number;
}

/// The values after the number: each key once, in their order.
std::vector<std::string> readValues(const std::string& told) {
  std::istringstream words(told.substr(told.find(' ') + 1));
  std::vector<std::string> values;
  for (const auto& [table, name] : kKeys) {
    std::string word;
    const std::string key = fmt::format("{}.{}=", table, name);
    if (!(words >> word) || word.rfind(key, 0) != 0) refuse(told);
    values.push_back(word);
  }
  std::string more;
  if (words >> more) refuse(told);
  return values;
}

}  // namespace

ChangedScenario proposeChange(const ChangedScenario& own, const Scenario& wanted) {
  if (own.changes >= kMostChanges)
    throw UsageError("there are too many changes in this session; start all sites again");
  ChangedScenario next{changeScenario(own.scenario, listValues(wanted)), own.changes + 1};
  const auto difference =
      findFirstDifference(makePeerConfiguration(next.scenario), makePeerConfiguration(wanted));
  if (difference)
    throw UsageError(fmt::format(
        "{} = {}: a session with a friend changes scheme and gains only; start all sites again",
        difference->key, difference->there));
  return next;
}

std::uint32_t hashWatchedScenario(const Scenario& scenario) {
  Configuration items = makePeerConfiguration(scenario);
  std::erase_if(items, [](const ConfigurationItem& item) { return mayChange(item.key); });
  return hashConfiguration(items);
}

std::optional<ConfigurationItem> describeChange(const ChangedScenario& own) {
  if (own.changes == 0) return std::nullopt;
  return ConfigurationItem{
      kChangeKey, fmt::format("{} {}", own.changes, fmt::join(listValues(own.scenario), " "))};
}

std::optional<ChangedScenario> followChange(const ChangedScenario& own,
                                            const ConfigurationDifference& difference) {
  if (difference.key != kChangeKey || difference.there.empty()) return std::nullopt;
  const std::uint32_t number = readNumber(difference.there);
  if (number < own.changes) return std::nullopt;
  if (number == own.changes && difference.there >= difference.here) return std::nullopt;
  return ChangedScenario{changeScenario(own.scenario, readValues(difference.there)), number};
}

}  // namespace tandem::demos
