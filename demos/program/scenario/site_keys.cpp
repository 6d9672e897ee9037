#include "scenario/site_keys.h"

#include <fmt/format.h>

#include "scenario/key_kinds.h"
#include "scenario/key_rows.h"
#include "scenario/table_keys.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

using Site = SiteScenario;
using Keys = std::vector<KeyOf<Site>>;

std::vector<std::array<double, 4>> readWaypoints(const Place& place, const toml::node& node) {
  const FieldRange range{-1e6, 1e6, false, "a list of [t, x, y, z] with growing t"};
  const auto waypoints = readRows<4>(place, node, range);
  if (waypoints.empty()) refuse(place, node, range.allowed);
  for (std::size_t i = 1; i < waypoints.size(); ++i)
    if (!(waypoints[i][0] > waypoints[i - 1][0])) refuse(place, node, range.allowed);
  return waypoints;
}

std::vector<std::array<double, 2>> readGrips(const Place& place, const toml::node& node) {
  const FieldRange range{0.0, 3600.0, false, "a list of [from, to] with growing times"};
  const auto grips = readRows<2>(place, node, range);
  double last = 0.0;
  for (const auto& [from, to] : grips) {
    if (!(from >= last && to > from)) refuse(place, node, range.allowed);
    last = to;
  }
  return grips;
}

Keys makeHandKeys() {
  const auto hand = [](auto member) {
    return [member](auto& site) -> auto& { return site.hand.*member; };
  };
  using Hand = HandScenario;
  return {
      choiceKey<Site>({"hand", "the kind of hand"}, {"constant", "sine", "minimum_jerk", "csv"},
                      hand(&Hand::kind)),
      vectorKey<Site>({"hand_force", "the constant force, or the amplitude of the sine", "N"},
                      hand(&Hand::force)),
      numberKey<Site>({"hand_frequency", "of the sine", "Hz"}, kPositive, hand(&Hand::frequency)),
      valueKey<Site>({"hand_waypoints",
                      "of `minimum_jerk`: list of `[t, x, y, z]`, displacements from the start",
                      "s, m", "", "none"},
                     "growing t", &readWaypoints, hand(&Hand::waypoints)),
      numberKey<Site>({"hand_stiffness", "with which that hand holds the device", "N/m"},
                      kNotNegative, hand(&Hand::stiffness)),
      numberKey<Site>({"hand_damping", "of that hold", "N s/m"}, kNotNegative,
                      hand(&Hand::damping)),
      textKey<Site>(
          {"hand_file",
           "of `csv`: `t,force_x,force_y,force_z`, forces of at most 1e6; path from the scenario",
           "s, N", "", "none"},
          hand(&Hand::file)),
      vectorKey<Site>({"start_offset",
                       "of the device, from its place \"just in contact\"; in a `world`: from the "
                       "origin",
                       "m", "off the axis: no guide"},
                      hand(&Hand::start_offset)),
      valueKey<Site>(
          {"grips", "times in which the hand holds the cube that it touches: list of `[from, to]`",
           "s", "no guide, island, handoff", "none"},
          "growing times", &readGrips, hand(&Hand::grips)),
  };
}

/// A number that a site may have of its own.
template <typename Member>
KeyOf<Site> optionalKey(const KeyText& text, const FieldRange& range, Member member) {
  const auto read = [range](const Place& place, const toml::node& node) {
    return std::optional<double>(readNumber(place, node, range));
  };
  return valueKey<Site>(text, describeRange(range), read, member);
}

Keys makeDeviceKeys() {
  const auto usual = [](const std::string& key) { return "`" + key + "`"; };
  return {
      optionalKey({"device_mass", "of this user's device", "kg", "", usual("device.mass")},
                  kPositive, &Site::device_mass),
      optionalKey({"device_damping", "its b_dev", "N s/m", "", usual("device.damping")},
                  kNotNegative, &Site::device_damping),
      optionalKey({"device_encoder_resolution", "its step of positions", "m", "",
                   usual("device.encoder_resolution")},
                  kNotNegative, &Site::device_encoder_resolution),
      optionalKey({"device_max_force", "its limit; 0: none", "N", "", usual("device.max_force")},
                  kNotNegative, &Site::device_max_force),
      optionalKey({"contact_stiffness", "K_vc at this site", "N/m", "", usual("contact.stiffness")},
                  kNotNegative, &Site::contact_stiffness),
      optionalKey({"contact_damping", "B_vc at this site", "N s/m", "", usual("contact.damping")},
                  kNotNegative, &Site::contact_damping),
      optionalKey(
          {"delay", "added to `network.delay` on each way from and to this site", "s", "", "0"},
          kNotNegative, &Site::delay),
      optionalKey({"comes", "the user is connected from then on; until then alone", "s",
                   "needs `coordination.follows_users`; for `tandem run`", "the start"},
                  kNotNegative, &Site::comes),
      optionalKey({"goes", "the user says farewell then, and goes on alone", "s",
                   "after `comes`; needs the same", "never"},
                  kPositive, &Site::goes),
  };
}

/// A key of one site by its number, from 1.
ScenarioKey numberedKey(const KeyOf<Site>& of_site, std::size_t number) {
  ScenarioKey key;
  key.name = fmt::format("site{}.{}", number, of_site.name);
  key.is_own = of_site.is_own;
  key.read = [&of_site, number](Scenario& s, const Place& place, const toml::node& node) {
    if (number > s.sites.size()) refuseSite(place, node, s.sites.size());
    of_site.read(s.sites[number - 1], place, node);
  };
  key.show = [&of_site, number](const Scenario& s) {
    const bool is_shown = s.sites.size() == kFewestSites && number <= kFewestSites;
    return is_shown ? of_site.show(s.sites[number - 1]) : nlohmann::json();
  };
  return key;
}

ScenarioKey listKey() {
  ScenarioKey key = tablesKey(
      {"site", "2 to 16 sites: tables `[[site]]`, below, in place of `[site1]` and `[site2]`", "",
       "2 at least", "two"},
      siteKeys(), kMostSites, &Scenario::sites);
  key.is_own = true;
  key.show = [](const Scenario& s) {
    return s.sites.size() == kFewestSites ? nlohmann::json() : showTables(siteKeys(), s.sites);
  };
  return key;
}

}  // namespace

const std::vector<KeyOf<SiteScenario>>& siteKeys() {
  static const Keys keys = [] {
    Keys all = makeHandKeys();
    for (KeyOf<Site>& key : makeDeviceKeys()) all.push_back(std::move(key));
    for (KeyOf<Site>& key : all) key.is_own = !key.name.starts_with("contact_");
    return all;
  }();
  return keys;
}

void refuseSite(const Place& place, const toml::node& node, std::size_t count) {
  throw UsageError(
      fmt::format("{} = {}: there are {} sites; give the file a table [[site]] for each",
                  describePlace(place, node), show(node), count));
}

std::vector<ScenarioKey> makeSiteKeys() {
  std::vector<ScenarioKey> keys = {listKey()};
  for (std::size_t number = 1; number <= kMostSites; ++number)
    for (const KeyOf<Site>& key : siteKeys()) keys.push_back(numberedKey(key, number));
  return keys;
}

}  // namespace tandem::demos
