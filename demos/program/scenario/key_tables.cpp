#include <fmt/format.h>

#include "scenario/body_keys.h"
#include "scenario/keys.h"
#include "scenario/site_keys.h"

namespace tandem::demos {
namespace {

constexpr const char* kHead =
    "| key | meaning | unit | default | allowed |\n|---|---|---|---|---|\n";

std::string show(const nlohmann::json& value) {
  if (value.is_string()) return '`' + value.get<std::string>() + '`';
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (!value.is_array()) return value.dump();
  std::string all;
  for (const nlohmann::json& one : value) all += (all.empty() ? "" : ", ") + show(one);
  return "`[" + all + "]`";
}

template <typename Owner>
std::string makeRow(const KeyOf<Owner>& key) {
  const std::string value = key.otherwise.empty() ? show(key.show(Owner{})) : key.otherwise;
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  return fmt::format("| `{}` | {} |{} | {} | {} |\n", key.name, key.meaning, unit, value,
                     key.allowed);
}

template <typename Owner>
std::string makeTable(const std::vector<KeyOf<Owner>>& keys) {
  std::string table = kHead;
  for (const KeyOf<Owner>& key : keys) table += makeRow(key);
  return table;
}

}  // namespace

std::array<std::string, 4> describeKeys() {
  std::array<std::string, 4> tables = {kHead, makeTable(bodyKeys()), makeTable(jointKeys()),
                                       makeTable(siteKeys())};
  const auto is_of_one_site = [](const std::string& name) {
    return name.starts_with("site") && name != "site";
  };
  for (const ScenarioKey& key : scenarioKeys())
    if (!is_of_one_site(key.name)) tables[0] += makeRow(key);
  return tables;
}

}  // namespace tandem::demos
