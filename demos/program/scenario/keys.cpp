#include "scenario/keys.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <vector>

#include "tandem/coordination/scheme.h"

#include "scenario/body_keys.h"
#include "scenario/key_kinds.h"
#include "scenario/site_keys.h"
#include "scenario/table_keys.h"

namespace tandem::demos {
namespace {

using S = Scenario;
using Keys = std::vector<ScenarioKey>;

const std::vector<std::string> kContactModels = {"island", "native_rigid", "native_soft",
                                                 "spring_6dof", "point_to_point"};

ScenarioKey own(ScenarioKey key) {
  key.is_own = true;
  return key;
}

ScenarioKey axisKey() {
  ScenarioKey key =
      vectorKey({"experiment.axis", "direction of the scene's x in the world"}, &S::axis);
  key.allowed = "norm 1 within 1e-3; is normalised";
  key.read = [](S& s, const Place& place, const toml::node& node) {
    const Vec3 axis = readVector(place, node);
    if (!(std::abs(axis.norm() - 1.0) < 1e-3)) refuse(place, node, "a unit vector");
    s.axis = axis.normalized();
  };
  return key;
}

std::uint64_t readSeed(const Place& place, const toml::node& node) {
  const auto value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
  if (!value || *value < 0) refuse(place, node, "a whole number, 0 or more");
  return static_cast<std::uint64_t>(*value);
}

void readBoxes(std::vector<NeighbourBox>& boxes, const Place& place, const toml::node& node) {
  const char* allowed =
      "a list of at most 200 [x, y, z, size, mass], size above 0, mass 0 (static) or more";
  const toml::array* rows = node.as_array();
  if (!rows || rows->size() > 200) refuse(place, node, allowed);
  boxes.clear();
  for (const toml::node& row : *rows) {
    const toml::array* v = row.as_array();
    if (!v || v->size() != 5) refuse(place, node, allowed);
    NeighbourBox box;
    for (int i = 0; i < 3; ++i)
      box.position[i] =
          readNumber(place, (*v)[static_cast<std::size_t>(i)], {-1e3, 1e3, false, allowed});
    box.size = readNumber(place, (*v)[3], {0.0, 1e3, true, allowed});
    box.mass = readNumber(place, (*v)[4], {0.0, 1e6, false, allowed});
    boxes.push_back(box);
  }
}

ScenarioKey boxesKey() {
  ScenarioKey key = makeKey(
      {"world.boxes", "more cubes: list of `[x, y, z, size, mass]`; mass 0: static; no guide",
       "m, kg", "", "none"},
      "at most 200");
  key.read = [](S& s, const Place& place, const toml::node& node) {
    readBoxes(s.boxes, place, node);
  };
  key.show = [](const S& s) {
    nlohmann::json rows = nlohmann::json::array();
    for (const NeighbourBox& b : s.boxes)
      rows.push_back({b.position.x(), b.position.y(), b.position.z(), b.size, b.mass});
    return rows;
  };
  return key;
}

bool isAuto(const toml::node& node) { return node.value<std::string>() == "auto"; }

/// A gain of coordination, or "auto".
ScenarioKey gainKey(const char* field, bool AutoGains::*is_auto) {
  ScenarioKey key = siteKey(field);
  key.allowed += "; or [`auto`](stability.md#gains-that-are-safe)";
  key.read = [read = key.read, is_auto](S& s, const Place& place, const toml::node& node) {
    if (node.is_string() && !isAuto(node)) refuse(place, node, "a finite number, or \"auto\"");
    s.automatic.*is_auto = isAuto(node);
    if (!isAuto(node)) read(s, place, node);
  };
  return key;
}

/// `coordination = "auto"`: a file has this in place of the table, so it has no value to show.
ScenarioKey autoKey() {
  ScenarioKey key =
      makeKey({"coordination", "in place of its table: both gains are `auto`", "", "", "none"},
              describeChoices({"auto"}));
  key.read = [](S& s, const Place& place, const toml::node& node) {
    if (!isAuto(node)) refuse(place, node, "\"auto\", or a table with keys of its own");
    s.automatic = {true, true};
  };
  key.show = [](const S&) { return nlohmann::json(); };
  return key;
}

std::vector<std::string> schemeNames() {
  std::vector<std::string> names;
  for (const Scheme* scheme : allSchemes()) names.emplace_back(scheme->name());
  return names;
}

Keys makeExperimentKeys() {
  return {
      own(textKey({"title", "heading in the report", "", "", "empty"}, &S::title)),
      own(textKey({"text", "what to try, in the window", "", "", "empty"}, &S::text)),
      choiceKey({"experiment.kind",
                 "the scene; `user_contact` has no cube, `world` has the bodies of the file"},
                {"cooperative_manipulation", "user_contact", "playground", "world"}, &S::kind),
      choiceKey({"experiment.scheme", "how a remote user is shown"}, schemeNames(), &S::scheme),
      own(numberKey({"experiment.duration", "simulated time", "s", "at least one haptic period"},
                    {0.0, 3600.0, true, "seconds above 0, at most 3600"}, &S::duration)),
      axisKey(),
      flagKey({"experiment.guide", "slot: devices, proxies and cube move along x and do not turn",
               "", "`playground`, `world`: false"},
              &S::guide),
  };
}

Keys makeCouplingKeys() {
  return {
      enumKey(
          {"contact.model",
           "who carries contact and couplers: the island, or [Bullet itself](native.md)", "",
           "native: no `impulse`, guide along x, y or z of the world"},
          kContactModels, [](auto& s) -> auto& { return s.site.contact_model; }),
      siteKey("contact.stiffness"),
      siteKey("contact.damping"),
      enumKey(
          {"coordination.mode",
           "whether each copy of an object is tied to every other one, or to the "
           "[mean of all](users.md)"},
          {"sum", "average"}, [](auto& s) -> auto& { return s.site.coordination_mode; }),
      siteFlagKey("coordination.follows_users", "membership.follows",
                  " ([users](users.md#who-takes-part))"),
      autoKey(),
      gainKey("coordination.stiffness", &AutoGains::stiffness),
      gainKey("coordination.damping", &AutoGains::damping),
      numberKey({"coordination.angular_stiffness", "turns cube copies towards each other",
                 "N m/rad", "both or neither", "K_t J/m"},
                kNotNegative, &S::angular_stiffness),
      numberKey({"coordination.angular_damping", "calms that turn", "N m s/rad", "both or neither",
                 "B_t J/m"},
                kNotNegative, &S::angular_damping),
  };
}

Keys makeBodyKeys() {
  const auto device = [](auto member) {
    return [member](auto& s) -> auto& { return s.device.*member; };
  };
  return {
      numberKey({"object.mass", "m, of the whole cube; each of N copies carries m/N", "kg"},
                kPositive, &S::object_mass),
      numberKey({"object.damping", "b, of each copy", "N s/m"}, kNotNegative, &S::object_damping),
      numberKey({"object.size", "edge of the cube", "m"}, kPositive, &S::object_size),
      siteKey("proxy.mass"),
      siteKey("proxy.damping"),
      siteKey("proxy.radius", ", and of the local haptic interface points"),
      siteKey("grip.stiffness"),
      siteKey("grip.max_force"),
      siteKey("grip.lift_time"),
      own(numberKey({"device.mass", "of the simulated device", "kg"}, kPositive,
                    device(&DeviceScenario::mass))),
      own(numberKey({"device.damping", "b_dev", "N s/m"}, kNotNegative,
                    device(&DeviceScenario::damping))),
      own(numberKey(
          {"device.encoder_resolution", "step in which positions are read; 0: exact", "m"},
          kNotNegative, device(&DeviceScenario::encoder_resolution))),
      own(numberKey({"device.max_force", "motors saturate here; 0: no limit", "N"}, kNotNegative,
                    device(&DeviceScenario::max_force))),
  };
}

std::vector<std::vector<double>> readDelays(const Place& place, const toml::node& node) {
  const FieldRange range{0.0, kMost, false,
                         "a row for each site as sender, with a number for each as receiver"};
  const toml::array* rows = node.as_array();
  if (!rows) refuse(place, node, range.allowed);
  std::vector<std::vector<double>> delays;
  for (const toml::node& row : *rows) {
    const toml::array* values = row.as_array();
    if (!values || values->size() != rows->size()) refuse(place, node, range.allowed);
    std::vector<double>& numbers = delays.emplace_back();
    for (const toml::node& value : *values) numbers.push_back(readNumber(place, value, range));
  }
  return delays;
}

ScenarioKey delaysKey() {
  ScenarioKey key =
      own(valueKey({"network.delays", "one way, in place of `network.delay`: `[from][to]`", "s",
                    "no `delay` of a site", "none"},
                   "a row for each site", &readDelays, &S::delays));
  key.show = [](const S& s) {
    return s.delays.empty() ? nlohmann::json() : nlohmann::json(s.delays);
  };
  return key;
}

Keys makeNetworkKeys() {
  return {
      own(numberKey(
          {"network.delay", "one way", "s", "at most `experiment.duration`"}, kNotNegative,
          [](auto& s) -> auto& { return s.network.delay; })),
      delaysKey(),
      siteKey("network.rate", "packet_rate", kPositive, "at most `rates.haptic`"),
      siteKey("network.budget", "packet_budget", kNotNegative),
      own(numberKey(
          {"network.jitter", "delay is even in delay +- jitter; may reorder", "s"}, kNotNegative,
          [](auto& s) -> auto& { return s.network.jitter; })),
      own(numberKey(
          {"network.loss", "probability that a packet never arrives"}, kProbability,
          [](auto& s) -> auto& { return s.network.loss; })),
      own(numberKey(
          {"network.duplicate", "probability that it arrives twice"}, kProbability,
          [](auto& s) -> auto& { return s.network.duplicate; })),
      own(numberKey(
          {"network.reorder", "probability that it jumps the queue, without delay"}, kProbability,
          [](auto& s) -> auto& { return s.network.reorder; })),
      own(valueKey(
          {"network.seed", "equal seeds, equal fates"}, "whole number >= 0", &readSeed,
          [](auto& s) -> auto& { return s.network.seed; })),
      siteFlagKey("network.link_loss", "link_loss.enabled"),
      siteFlagKey("guard.passivity", "passivity.enabled",
                  " ([architecture](architecture.md), section 9)"),
      siteKey("guard.tank", "passivity.tank", kPositive),
      siteKey("guard.power", "passivity.power", kNotNegative),
      siteKey("guard.peer_speed", "max_peer_speed", kPositive),
      siteKey("guard.max_slew", "max_slew", kPositive),
      siteKey("rates.haptic", "haptic_rate", {10.0, 1e5, false, "10 to 100000 Hz"}),
      own(numberKey({"rates.host", "Bullet worlds; need not divide the haptic rate", "Hz"},
                    {1.0, 1e5, false, "1 to 100000 Hz"}, &S::host_rate)),
      own(numberKey({"rates.inner", "steps of the island where motion is not linear", "Hz"},
                    {10.0, 1e6, false, "10 to 1000000 Hz"}, &S::inner_rate)),
      own(enumKey(
          {"bridge.injection", "how forces reach Bullet's bodies", "",
           "`impulse` needs `rates.host` = `rates.haptic`"},
          {"handoff", "impulse"}, [](auto& s) -> auto& { return s.site.injection; })),
  };
}

std::vector<std::string> readNames(const Place& place, const toml::node& node) {
  const toml::array* array = node.as_array();
  if (!array) refuse(place, node, "a list of names of bodies");
  std::vector<std::string> names;
  for (const toml::node& name : *array) names.push_back(readString(place, name));
  return names;
}

Keys makeWorldKeys() {
  return {
      numberKey({"world.gravity", "along -z", "m/s^2"}, kNotNegative, &S::gravity),
      flagKey({"world.floor", "a floor under the cube (2 m x 2 m); no guide"}, &S::floor),
      numberKey({"world.friction", "of all bodies that say nothing else"}, kNotNegative,
                &S::friction),
      boxesKey(),
      tablesKey({"body", "bodies of a `world`: tables `[[body]]`, below", "", "", "none"},
                bodyKeys(), kMostBodies, &S::bodies),
      tablesKey({"joint", "joints of a `world`: tables `[[joint]]`, below", "", "", "none"},
                jointKeys(), kMostBodies, &S::joints),
      own(textKey(
          {"world.file",
           "a `.urdf`, `.xml` (MJCF) or `.bullet` file with more bodies and joints; path from "
           "the scenario",
           "", "`world` only", "none"},
          &S::world_file)),
      valueKey({"world.share", "its bodies that both users move", "", "", "none"},
               "a list of names", &readNames, &S::shared),
  };
}

Keys makeCameraKeys() {
  using C = CameraScenario;
  const auto camera = [](auto member) {
    return [member](auto& s) -> auto& { return s.camera.*member; };
  };
  Keys keys = {
      vectorKey({"camera.target", "a picture's middle", "m"}, camera(&C::target)),
      numberKey({"camera.distance", "of the eye; 0: chosen, with target and direction", "m"},
                kNotNegative, camera(&C::distance)),
      numberKey({"camera.azimuth", "of the eye about z, from x", "rad"},
                {-7.0, 7.0, false, "-7 to 7"}, camera(&C::azimuth)),
      numberKey({"camera.elevation", "of the eye", "rad"}, {-1.5, 1.5, false, "-1.5 to 1.5"},
                camera(&C::elevation)),
  };
  for (ScenarioKey& key : keys) key.is_own = true;
  return keys;
}

Keys makeKeys() {
  Keys all;
  for (const Keys& part : {makeExperimentKeys(), makeCouplingKeys(), makeBodyKeys(),
                           makeNetworkKeys(), makeWorldKeys(), makeCameraKeys(), makeSiteKeys()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

const std::vector<ScenarioKey>& scenarioKeys() {
  static const std::vector<ScenarioKey> keys = makeKeys();
  return keys;
}

std::string nameOf(ContactModel model) { return kContactModels[static_cast<std::size_t>(model)]; }

}  // namespace tandem::demos
