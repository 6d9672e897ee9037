#include "peer/peer_configuration.h"

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenario/site_keys.h"
#include "scenario/table_keys.h"

namespace tandem::demos {
namespace {

/// Values have at most 255 bytes. Longer ones are compared by a hash.
std::string shorten(std::string value) {
  if (value.size() <= 200) return value;
  return fmt::format("{}... hash {:08x}", value.substr(0, 100), hashConfiguration({{"", value}}));
}

void flatten(const nlohmann::json& node, const std::string& prefix,
             std::vector<ConfigurationItem>& items) {
  for (const auto& [name, value] : node.items()) {
    const std::string key = prefix + name;
    if (isOwnKey(key)) continue;
    if (value.is_object()) {
      flatten(value, key + ".", items);
    } else {
      items.push_back({key, shorten(value.is_string() ? value.get<std::string>() : value.dump())});
    }
  }
}

/// The scenario, with its sites by their numbers whether a list or two tables has them.
nlohmann::json describeByNumber(const Scenario& scenario) {
  nlohmann::json all = describeScenario(scenario);
  for (std::size_t i = 0; i < scenario.sites.size(); ++i)
    all[fmt::format("site{}", i + 1)] = showTable(siteKeys(), scenario.sites[i]);
  all.erase("site");
  return all;
}

}  // namespace

Configuration makePeerConfiguration(const Scenario& scenario) {
  std::vector<ConfigurationItem> items = {{"units", "SI"},
                                          {"site.count", std::to_string(scenario.sites.size())}};
  flatten(describeByNumber(scenario), "", items);
  return makeConfiguration(std::move(items));
}

}  // namespace tandem::demos
