#include "scenario/scenario.h"

#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/coordination/scheme.h"

#include "scenario/toml_input.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

// One reader per type of value; each error lists the allowed values.

double readNumber(const Place& place, const toml::node& node, double min, double max,
                  bool open_below, const std::string& allowed) {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value) || *value > max ||
      (open_below ? *value <= min : *value < min))
    refuse(place, node, allowed);
  return *value;
}

Vec3 readVector(const Place& place, const toml::node& node) {
  const toml::array* array = node.as_array();
  if (!array || array->size() != 3) refuse(place, node, "three numbers, [x, y, z]");
  Vec3 vector;
  for (std::size_t i = 0; i < 3; ++i)
    vector[static_cast<Eigen::Index>(i)] =
        readNumber(place, (*array)[i], -1e6, 1e6, false, "finite numbers of at most 1e6");
  return vector;
}

std::string readChoice(const Place& place, const toml::node& node,
                       const std::vector<std::string>& choices) {
  const auto value = node.value<std::string>();
  for (const std::string& choice : choices)
    if (value && *value == choice) return choice;
  refuse(place, node, "one of " + fmt::format("{}", fmt::join(choices, ", ")));
}

/// A key: reader and printer of its value.
struct Key {
  std::function<void(Scenario&, const Place&, const toml::node&)> read;
  std::function<nlohmann::json(const Scenario&)> show;
};

using Member = std::function<double&(Scenario&)>;

Key numberKey(Member member, double min, double max, bool open_below, const std::string& allowed) {
  return {[=](Scenario& s, const Place& place, const toml::node& node) {
            member(s) = readNumber(place, node, min, max, open_below, allowed);
          },
          [=](const Scenario& s) -> nlohmann::json { return member(const_cast<Scenario&>(s)); }};
}

Key positive(Member m) { return numberKey(m, 0.0, 1e9, true, "a finite number above 0"); }
Key notNegative(Member m) { return numberKey(m, 0.0, 1e9, false, "a finite number, 0 or more"); }
Key probability(Member m) { return numberKey(m, 0.0, 1.0, false, "a probability, 0 to 1"); }

Key vectorKey(std::function<Vec3&(Scenario&)> member) {
  return {[=](Scenario& s, const Place& place, const toml::node& node) {
            member(s) = readVector(place, node);
          },
          [=](const Scenario& s) -> nlohmann::json {
            const Vec3& v = member(const_cast<Scenario&>(s));
            return {v.x(), v.y(), v.z()};
          }};
}

Key choiceKey(std::function<std::string&(Scenario&)> member, std::vector<std::string> choices) {
  return {[=](Scenario& s, const Place& place, const toml::node& node) {
            member(s) = readChoice(place, node, choices);
          },
          [=](const Scenario& s) -> nlohmann::json { return member(const_cast<Scenario&>(s)); }};
}

Key textKey(std::function<std::string&(Scenario&)> member) {
  return {[=](Scenario& s, const Place& place, const toml::node& node) {
            const auto value = node.value<std::string>();
            if (!node.is_string() || !value) refuse(place, node, "a text in quotes");
            member(s) = *value;
          },
          [=](const Scenario& s) -> nlohmann::json { return member(const_cast<Scenario&>(s)); }};
}

Key flagKey(std::function<bool&(Scenario&)> member) {
  return {[=](Scenario& s, const Place& place, const toml::node& node) {
            if (!node.is_boolean()) refuse(place, node, "true or false");
            member(s) = *node.value<bool>();
          },
          [=](const Scenario& s) -> nlohmann::json { return member(const_cast<Scenario&>(s)); }};
}

Key axisKey() {
  Key key = vectorKey([](Scenario& s) -> Vec3& { return s.axis; });
  key.read = [](Scenario& s, const Place& place, const toml::node& node) {
    const Vec3 axis = readVector(place, node);
    if (!(std::abs(axis.norm() - 1.0) < 1e-3)) refuse(place, node, "a unit vector");
    s.axis = axis.normalized();
  };
  return key;
}

Key seedKey() {
  return {[](Scenario& s, const Place& place, const toml::node& node) {
            const auto value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
            if (!value || *value < 0) refuse(place, node, "a whole number, 0 or more");
            s.network.seed = static_cast<std::uint64_t>(*value);
          },
          [](const Scenario& s) -> nlohmann::json { return s.network.seed; }};
}

Key waypointsKey(std::size_t site) {
  return {[site](Scenario& s, const Place& place, const toml::node& node) {
            const std::string allowed = "a list of [t, x, y, z] with growing t";
            const toml::array* rows = node.as_array();
            if (!rows || rows->empty()) refuse(place, node, allowed);
            auto& waypoints = s.hands[site].waypoints;
            waypoints.clear();
            for (const toml::node& row : *rows) {
              const toml::array* values = row.as_array();
              if (!values || values->size() != 4) refuse(place, node, allowed);
              std::array<double, 4> point{};
              for (std::size_t i = 0; i < 4; ++i)
                point[i] = readNumber(place, (*values)[i], -1e6, 1e6, false, allowed);
              if (!waypoints.empty() && !(point[0] > waypoints.back()[0]))
                refuse(place, node, allowed);
              waypoints.push_back(point);
            }
          },
          [site](const Scenario& s) -> nlohmann::json { return s.hands[site].waypoints; }};
}

Key boxesKey() {
  return {
      [](Scenario& s, const Place& place, const toml::node& node) {
        const std::string allowed =
            "a list of at most 200 [x, y, z, size, mass], size above 0, mass 0 (static) or more";
        const toml::array* rows = node.as_array();
        if (!rows || rows->size() > 200) refuse(place, node, allowed);
        s.boxes.clear();
        for (const toml::node& row : *rows) {
          const toml::array* v = row.as_array();
          if (!v || v->size() != 5) refuse(place, node, allowed);
          NeighbourBox box;
          for (int i = 0; i < 3; ++i)
            box.position[i] =
                readNumber(place, (*v)[static_cast<std::size_t>(i)], -1e3, 1e3, false, allowed);
          box.size = readNumber(place, (*v)[3], 0.0, 1e3, true, allowed);
          box.mass = readNumber(place, (*v)[4], 0.0, 1e6, false, allowed);
          s.boxes.push_back(box);
        }
      },
      [](const Scenario& s) {
        nlohmann::json rows = nlohmann::json::array();
        for (const NeighbourBox& b : s.boxes)
          rows.push_back({b.position.x(), b.position.y(), b.position.z(), b.size, b.mass});
        return rows;
      }};
}

std::vector<std::string> schemeNames() {
  std::vector<std::string> names;
  for (const Scheme* scheme : allSchemes()) names.emplace_back(scheme->name());
  return names;
}

std::map<std::string, Key> makeKeys() {
  using S = Scenario;
  std::map<std::string, Key> keys = {
      {"title", textKey([](S& s) -> std::string& { return s.title; })},
      {"experiment.kind", choiceKey([](S& s) -> std::string& { return s.kind; },
                                    {"cooperative_manipulation", "user_contact", "playground"})},
      {"experiment.scheme",
       choiceKey([](S& s) -> std::string& { return s.scheme; }, schemeNames())},
      {"experiment.duration", numberKey([](S& s) -> double& { return s.duration; }, 0.0, 3600.0,
                                        true, "seconds above 0, at most 3600")},
      {"experiment.axis", axisKey()},
      {"experiment.guide", flagKey([](S& s) -> bool& { return s.guide; })},
      {"contact.model",
       choiceKey([](S& s) -> std::string& { return s.contact_model; },
                 {"island", "native_rigid", "native_soft", "spring_6dof", "point_to_point"})},
      {"contact.stiffness", notNegative([](S& s) -> double& { return s.contact.stiffness; })},
      {"contact.damping", notNegative([](S& s) -> double& { return s.contact.damping; })},
      {"coordination.stiffness",
       notNegative([](S& s) -> double& { return s.coordination.stiffness; })},
      {"coordination.damping", notNegative([](S& s) -> double& { return s.coordination.damping; })},
      {"coordination.angular_stiffness",
       notNegative([](S& s) -> double& { return s.angular_stiffness; })},
      {"coordination.angular_damping",
       notNegative([](S& s) -> double& { return s.angular_damping; })},
      {"object.mass", positive([](S& s) -> double& { return s.object_mass; })},
      {"object.damping", notNegative([](S& s) -> double& { return s.object_damping; })},
      {"object.size", positive([](S& s) -> double& { return s.object_size; })},
      {"proxy.mass", positive([](S& s) -> double& { return s.proxy_mass; })},
      {"proxy.damping", notNegative([](S& s) -> double& { return s.proxy_damping; })},
      {"proxy.radius", positive([](S& s) -> double& { return s.proxy_radius; })},
      {"device.mass", positive([](S& s) -> double& { return s.device_mass; })},
      {"device.damping", notNegative([](S& s) -> double& { return s.device_damping; })},
      {"device.encoder_resolution",
       notNegative([](S& s) -> double& { return s.encoder_resolution; })},
      {"device.max_force", notNegative([](S& s) -> double& { return s.device_max_force; })},
      {"network.delay", notNegative([](S& s) -> double& { return s.network.delay; })},
      {"network.rate", positive([](S& s) -> double& { return s.packet_rate; })},
      {"network.jitter", notNegative([](S& s) -> double& { return s.network.jitter; })},
      {"network.loss", probability([](S& s) -> double& { return s.network.loss; })},
      {"network.duplicate", probability([](S& s) -> double& { return s.network.duplicate; })},
      {"network.reorder", probability([](S& s) -> double& { return s.network.reorder; })},
      {"network.seed", seedKey()},
      {"network.link_loss", flagKey([](S& s) -> bool& { return s.link_loss; })},
      {"guard.passivity", flagKey([](S& s) -> bool& { return s.passivity; })},
      {"guard.tank", positive([](S& s) -> double& { return s.tank; })},
      {"guard.max_slew", positive([](S& s) -> double& { return s.max_slew; })},
      {"rates.haptic", numberKey([](S& s) -> double& { return s.haptic_rate; }, 10.0, 1e5, false,
                                 "10 to 100000 Hz")},
      {"rates.host",
       numberKey([](S& s) -> double& { return s.host_rate; }, 1.0, 1e5, false, "1 to 100000 Hz")},
      {"rates.inner", numberKey([](S& s) -> double& { return s.inner_rate; }, 10.0, 1e6, false,
                                "10 to 1000000 Hz")},
      {"bridge.injection",
       choiceKey([](S& s) -> std::string& { return s.injection; }, {"handoff", "impulse"})},
      {"world.gravity", notNegative([](S& s) -> double& { return s.gravity; })},
      {"world.floor", flagKey([](S& s) -> bool& { return s.floor; })},
      {"world.friction", notNegative([](S& s) -> double& { return s.friction; })},
      {"world.boxes", boxesKey()},
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string site = i == 0 ? "site1." : "site2.";
    keys[site + "hand"] = choiceKey([i](S& s) -> std::string& { return s.hands[i].kind; },
                                    {"constant", "sine", "minimum_jerk", "csv"});
    keys[site + "hand_force"] = vectorKey([i](S& s) -> Vec3& { return s.hands[i].force; });
    keys[site + "hand_frequency"] = positive([i](S& s) -> double& { return s.hands[i].frequency; });
    keys[site + "hand_stiffness"] =
        notNegative([i](S& s) -> double& { return s.hands[i].stiffness; });
    keys[site + "hand_damping"] = notNegative([i](S& s) -> double& { return s.hands[i].damping; });
    keys[site + "hand_waypoints"] = waypointsKey(i);
    keys[site + "hand_file"] = textKey([i](S& s) -> std::string& { return s.hands[i].file; });
    keys[site + "start_offset"] = vectorKey([i](S& s) -> Vec3& { return s.hands[i].start_offset; });
  }
  return keys;
}

const std::map<std::string, Key>& allKeys() {
  static const std::map<std::string, Key> keys = makeKeys();
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
    std::vector<std::string> tables = {"title"};
    for (const auto& [name, unused] : allKeys())
      if (const auto dot = name.find('.'); dot != std::string::npos)
        if (const std::string t = name.substr(0, dot) + ".*"; tables.back() != t)
          tables.push_back(t);
    throw UsageError(fmt::format("{}: {} = {}: there is no such key; allowed: {}", place.file,
                                 place.key, show(node),
                                 fmt::join(near.empty() ? tables : near, ", ")));
  }
  key->second.read(scenario, place, node);
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

void applyOverride(Scenario& scenario, const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw UsageError("--set " + text + ": must be key=value, for instance contact.stiffness=2000");
  const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
  // A value that is not valid TOML is a text without its quotes.
  toml::table parsed;
  try {
    parsed = toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
    parsed.clear();
  }
  if (parsed.size() != 1) {
    try {
      parsed = toml::parse("value = '''" + value + "'''");
    } catch (const toml::parse_error&) {
      throw UsageError("--set " + key + ": the value is neither TOML nor plain UTF-8 text");
    }
  }
  applyKey(scenario, {"--set", key}, *parsed.get("value"));
}

/// Checks for settings that Bullet's own means do not support.
void checkNative(const Scenario& s, const std::function<void(const std::string&)>& refuse_pair) {
  const std::string model = "contact.model = \"" + s.contact_model + "\": ";
  if (s.injection == "impulse")
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
  if (s.network.delay > s.duration)
    refuse_pair(fmt::format("network.delay = {}: must not be longer than experiment.duration = {}",
                            s.network.delay, s.duration));
  if (s.packet_rate > s.haptic_rate)
    refuse_pair(fmt::format("network.rate = {}: must not be above rates.haptic = {}", s.packet_rate,
                            s.haptic_rate));
  if (s.duration * s.haptic_rate < 1.0)
    refuse_pair(fmt::format("experiment.duration = {}: must be at least one haptic period, {} s",
                            s.duration, 1.0 / s.haptic_rate));
  if (s.duration * s.haptic_rate > 1e7)
    refuse_pair(
        fmt::format("experiment.duration = {}: times rates.haptic = {} must be at most 1e7 ticks",
                    s.duration, s.haptic_rate));
  if (s.injection == "impulse" && s.host_rate != s.haptic_rate)
    refuse_pair(fmt::format(
        "rates.host = {}: must equal rates.haptic = {} with bridge.injection = \"impulse\"; "
        "or use \"handoff\"",
        s.host_rate, s.haptic_rate));
  if (s.contact_model != "island") checkNative(s, refuse_pair);
  if ((s.angular_stiffness < 0.0) != (s.angular_damping < 0.0))
    refuse_pair(
        "coordination.angular_stiffness and coordination.angular_damping: give both or neither");
  for (std::size_t i = 0; i < 2; ++i) {
    const HandScenario& hand = s.hands[i];
    const std::string site = i == 0 ? "site1" : "site2";
    if (hand.kind == "minimum_jerk" && hand.waypoints.empty())
      refuse_pair(site + ".hand = \"minimum_jerk\": needs " + site + ".hand_waypoints");
    if (hand.kind == "csv" && hand.file.empty())
      refuse_pair(site + ".hand = \"csv\": needs " + site + ".hand_file");
    if (s.guide && s.kind != "playground" && hand.start_offset.tail<2>() != Eigen::Vector2d::Zero())
      refuse_pair(site + ".start_offset: off the axis needs experiment.guide = false");
  }
  if (s.guide && s.kind == "playground")
    refuse_pair("experiment.guide = true: a playground is free; set it to false");
  if (s.guide && (s.floor || !s.boxes.empty()))
    refuse_pair(
        "world.floor, world.boxes: an enclosure's slot holds nothing else; set experiment.guide = "
        "false");
}

}  // namespace

Scenario parseScenario(const std::string& text, const std::string& name,
                       const std::vector<std::string>& overrides) {
  Scenario scenario;
  applyTable(scenario, name, "", parseToml(text, name));
  for (const std::string& override_text : overrides) applyOverride(scenario, override_text);
  checkTogether(scenario, name);
  return scenario;
}

Scenario loadScenario(const std::filesystem::path& file,
                      const std::vector<std::string>& overrides) {
  Scenario scenario = parseScenario(readText(file, "scenario"), file.string(), overrides);
  scenario.file = file;
  return scenario;
}

nlohmann::json describeScenario(const Scenario& scenario) {
  nlohmann::json all;
  for (const auto& [name, key] : allKeys()) {
    const auto dot = name.find('.');
    nlohmann::json& place =
        dot == std::string::npos ? all[name] : all[name.substr(0, dot)][name.substr(dot + 1)];
    place = key.show(scenario);
  }
  return all;
}

}  // namespace tandem::demos
