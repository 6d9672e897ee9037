#include "analyse/loop_of_scenario.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "scenario/site_delays.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

void checkKind(const Scenario& s) {
  if (s.kind != "cooperative_manipulation" && s.kind != "user_contact")
    throw UsageError(fmt::format(
        "experiment.kind = {}: has contact in three dimensions; an analysis is of users along one "
        "line, with one object (cooperative_manipulation) or without (user_contact)",
        s.kind));
  if (s.site.contact_model != ContactModel::kIsland || s.site.injection != Injection::kHandoff)
    throw UsageError(
        "contact.model, bridge.injection: must be island and handoff; the others run at the host's "
        "rate and are not analysed");
}

/// Factors of the largest of all values, which goes into `most`.
template <typename Get>
std::vector<double> compareSites(const Scenario& s, double& most, Get get) {
  std::vector<double> values;
  for (const SiteScenario& site : s.sites) values.push_back(get(site));
  most = std::ranges::max(values);
  for (double& value : values) value = value == most ? 1.0 : value / most;
  return values;
}

double findLongestDelay(const Scenario& s) {
  double longest = 0.0;
  for (std::size_t i = 0; i < s.sites.size(); ++i)
    for (std::size_t k = 0; k < s.sites.size(); ++k)
      if (k != i) longest = std::max(longest, computeDelay(s, i, k));
  return longest;
}

bool isAsAll(const LoopUser& user) {
  return user.device_mass == 1.0 && user.device_damping == 1.0 && user.contact_stiffness == 1.0 &&
         user.contact_damping == 1.0 &&
         std::ranges::all_of(user.delays, [](double part) { return part == 1.0; });
}

/// Largest values of devices, contacts and delays, and how each user differs from them.
void takeUsers(const Scenario& s, LoopSettings& loop) {
  const auto contact = [&](const SiteScenario& site) { return site.makeContact(s.site.contact); };
  const auto device = [&](const SiteScenario& site) { return site.makeDevice(s.device); };
  const auto masses =
      compareSites(s, loop.device_mass, [&](const auto& site) { return device(site).mass; });
  const auto dampings =
      compareSites(s, loop.device_damping, [&](const auto& site) { return device(site).damping; });
  const auto contacts = compareSites(s, loop.contact.stiffness,
                                     [&](const auto& site) { return contact(site).stiffness; });
  const auto contact_dampings = compareSites(
      s, loop.contact.damping, [&](const auto& site) { return contact(site).damping; });
  loop.delay = findLongestDelay(s);
  for (std::size_t i = 0; i < s.sites.size(); ++i) {
    LoopUser& user = loop.each.emplace_back();
    user.device_mass = masses[i];
    user.device_damping = dampings[i];
    user.contact_stiffness = contacts[i];
    user.contact_damping = contact_dampings[i];
    for (std::size_t k = 0; k < s.sites.size(); ++k)
      user.delays.push_back(k == i || loop.delay == 0.0 ? 1.0 : computeDelay(s, i, k) / loop.delay);
  }
  if (std::ranges::all_of(loop.each, &isAsAll)) loop.each.clear();
}

StandInKind findStandIn(const std::string& scheme) {
  for (const StandInKind kind : {StandInKind::kNone, StandInKind::kHeld})
    if (scheme == schemeOf(kind)) return kind;
  return StandInKind::kDynamic;
}

}  // namespace

const char* schemeOf(StandInKind kind) noexcept {
  switch (kind) {
    case StandInKind::kNone:
      return "virtual_coupling";
    case StandInKind::kHeld:
      return "kinematic_proxy";
    case StandInKind::kDynamic:
      break;
  }
  return "remote_dynamic_proxy";
}

LoopSettings makeLoop(const Scenario& s) {
  checkKind(s);
  LoopSettings loop;
  loop.stand_in = findStandIn(s.scheme);
  loop.users = static_cast<int>(s.sites.size());
  loop.mode = s.site.coordination_mode;
  loop.has_object = s.hasObject();
  loop.object_mass = s.object_mass;
  loop.object_damping = s.object_damping;
  takeUsers(s, loop);
  loop.coordination = s.site.coordination;
  loop.proxy_mass = s.site.proxy.mass;
  loop.proxy_damping = s.site.proxy.damping;
  loop.haptic_rate = s.site.haptic_rate;
  loop.packet_rate = s.site.packet_rate;
  return loop;
}

}  // namespace tandem::demos
