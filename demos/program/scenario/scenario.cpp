#include "scenario/scenario.h"

#include <functional>
#include <map>

#include <fmt/format.h>

#include "tandem/plugin/toml_text.h"

#include "scenario/body_checks.h"
#include "scenario/described_scenario.h"
#include "scenario/keys.h"
#include "scenario/site_checks.h"
#include "scenario/table_keys.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// Ordered by name.
const std::map<std::string, const ScenarioKey*>& allKeys() {
  static const auto keys = [] {
    std::map<std::string, const ScenarioKey*> by_name;
    for (const ScenarioKey& key : scenarioKeys()) by_name[key.name] = &key;
    return by_name;
  }();
  return keys;
}

void applyKey(Scenario& scenario, const Place& place, const toml::node& node) {
  const auto key = allKeys().find(place.key);
  if (key == allKeys().end()) {
    // Keys of the same table are the likely ones.
    const std::string table = place.key.substr(0, place.key.find('.') + 1);
    std::vector<std::string> near;
    for (const auto& [name, unused] : allKeys())
      if (!table.empty() && name.rfind(table, 0) == 0) near.push_back(name);
    std::vector<std::string> tables;
    for (const auto& [name, unused] : allKeys()) {
      const auto dot = name.find('.');
      const std::string top = dot == std::string::npos ? name : name.substr(0, dot) + ".*";
      if (tables.empty() || tables.back() != top) tables.push_back(top);
    }
    refuseKey(place, node, near.empty() ? tables : near);
  }
  key->second->read(scenario, place, node);
}

/// True for the name of a table, such as "network".
bool holdsKeys(const std::string& table) {
  const auto first = allKeys().lower_bound(table + ".");
  return first != allKeys().end() && first->first.rfind(table + ".", 0) == 0;
}

/// Refuses unexpected tables too: an empty unknown one, and one in place of a value. Keys in an
/// unknown table are refused by their full names.
void applyTable(Scenario& scenario, const std::string& file, const std::string& prefix,
                const toml::table& table) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const toml::table* inner = node.as_table();
    if (inner && (holdsKeys(name) || !(inner->empty() || allKeys().contains(name)))) {
      applyTable(scenario, file, name + ".", *inner);
    } else {
      applyKey(scenario, {file, name}, node);
    }
  }
}

/// Table with the value of an override. A value that is not valid TOML is a text without quotes.
toml::table parseValue(const std::string& key, const std::string& value) {
  const std::string plain = "value = " + value;
  try {
    requireShallowToml(plain, "--set " + key);
    if (toml::table parsed = toml::parse(plain); parsed.size() == 1) return parsed;
  } catch (const toml::parse_error&) {
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  try {
    if (toml::table parsed = toml::parse("value = '''" + value + "'''"); parsed.size() == 1)
      return parsed;
  } catch (const toml::parse_error&) {
  }
  throw UsageError("--set " + key + ": the value is neither TOML nor plain UTF-8 text");
}

void applyOverride(Scenario& scenario, const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw UsageError("--set " + text + ": must be key=value, for instance contact.stiffness=2000");
  const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
  toml::table parsed = parseValue(key, value);
  applyKey(scenario, {"--set", key}, *parsed.get("value"));
}

/// Checks for settings that Bullet's own means do not support.
void checkNative(const Scenario& s, const std::function<void(const std::string&)>& refuse_pair) {
  const std::string model = "contact.model = \"" + nameOf(s.site.contact_model) + "\": ";
  if (s.site.injection == Injection::kImpulse)
    refuse_pair(model +
                "there is no island whose forces could be injected; leave bridge.injection at "
                "\"handoff\"");
  if (s.guide && s.axis.cwiseAbs().maxCoeff() != s.axis.cwiseAbs().sum())
    refuse_pair(model +
                "Bullet's linear factors guide along x, y or z only; choose such an "
                "experiment.axis, or experiment.guide = false");
  if (s.scheme == "kinematic_proxy" && !s.hasObject())
    refuse_pair(model +
                "in Bullet two kinematic spheres do not touch; choose another experiment.scheme "
                "than \"kinematic_proxy\", or a scene with an object");
}

/// Checks that involve several keys.
void checkTogether(const Scenario& s, const std::string& file) {
  const auto refuse_pair = [&](const std::string& text) { throw UsageError(file + ": " + text); };
  if (s.site.packet_rate > s.site.haptic_rate)
    refuse_pair(fmt::format("network.rate = {}: must not be above rates.haptic = {}",
                            s.site.packet_rate, s.site.haptic_rate));
  if (s.duration * s.site.haptic_rate < 1.0)
    refuse_pair(fmt::format("experiment.duration = {}: must be at least one haptic period, {} s",
                            s.duration, 1.0 / s.site.haptic_rate));
  if (s.duration * s.site.haptic_rate > 1e7)
    refuse_pair(
        fmt::format("experiment.duration = {}: times rates.haptic = {} must be at most 1e7 ticks",
                    s.duration, s.site.haptic_rate));
  if (s.site.injection == Injection::kImpulse && s.host_rate != s.site.haptic_rate)
    refuse_pair(fmt::format(
        "rates.host = {}: must equal rates.haptic = {} with bridge.injection = \"impulse\"; "
        "or use \"handoff\"",
        s.host_rate, s.site.haptic_rate));
  if (s.site.contact_model != ContactModel::kIsland) checkNative(s, refuse_pair);
  if ((s.angular_stiffness < 0.0) != (s.angular_damping < 0.0))
    refuse_pair(
        "coordination.angular_stiffness and coordination.angular_damping: give both or neither");
  if (s.guide && (s.kind == "playground" || s.isWorld()))
    refuse_pair(fmt::format("experiment.guide = true: a {} is free; set it to false", s.kind));
  if (s.guide && (s.floor || !s.boxes.empty()))
    refuse_pair(
        "world.floor, world.boxes: an enclosure's slot holds nothing else; set experiment.guide = "
        "false");
  checkSites(s, refuse_pair);
  checkBodies(s, refuse_pair);
}

/// A file has either [[site]], or [site1] and [site2].
void checkOneKindOfSites(const toml::table& table, const std::string& file) {
  if (!table.contains("site")) return;
  for (const auto& [key, node] : table)
    if (holdsKeys(std::string(key.str())) && key.str().starts_with("site"))
      throw UsageError(fmt::format("{}: a file has either [[site]] or [site1] and [site2]",
                                   describePlace({file, std::string(key.str())}, node)));
}

Scenario makeScenario(const toml::table& table, const std::string& name,
                      const std::vector<std::string>& overrides) {
  Scenario scenario;
  checkOneKindOfSites(table, name);
  applyTable(scenario, name, "", table);
  for (const std::string& override_text : overrides) applyOverride(scenario, override_text);
  checkTogether(scenario, name);
  return scenario;
}

}  // namespace

Scenario parseScenario(const std::string& text, const std::string& name,
                       const std::vector<std::string>& overrides) {
  return makeScenario(parseToml(text, name), name, overrides);
}

Scenario readScenario(const nlohmann::json& described, const std::string& name) {
  return makeScenario(makeToml(described, describeScenario({}), name), name, {});
}

Scenario changeScenario(const Scenario& scenario, const std::vector<std::string>& overrides) {
  Scenario changed = scenario;
  for (const std::string& override_text : overrides) applyOverride(changed, override_text);
  checkTogether(changed, scenario.file.filename().string());
  return changed;
}

nlohmann::json describeScenario(const Scenario& scenario) {
  nlohmann::json all;
  for (const auto& [name, key] : allKeys()) {
    const auto dot = name.find('.');
    nlohmann::json value = key->show(scenario);
    if (value.is_null()) continue;
    nlohmann::json& place =
        dot == std::string::npos ? all[name] : all[name.substr(0, dot)][name.substr(dot + 1)];
    place = std::move(value);
  }
  return all;
}

bool isOwnKey(std::string_view name) {
  const auto key = allKeys().find(std::string(name));
  return key != allKeys().end() && key->second->is_own;
}

}  // namespace tandem::demos
