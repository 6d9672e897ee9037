#include "analyse/loop_of_scenario.h"

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

/// Refuses the first value in which a site differs from the first one.
void checkAlike(const Scenario& s) {
  const auto refuse = [](std::size_t i, const char* key, double value, double first) {
    throw UsageError(
        fmt::format("site{}.{} = {}: site 1 has {}; an analysis is of users who are alike", i + 1,
                    key, value, first));
  };
  const DeviceScenario first = s.sites[0].makeDevice(s.device);
  const CouplerGains contact = s.sites[0].makeContact(s.site.contact);
  const double delay = computeDelay(s, 0, 1);
  for (std::size_t i = 0; i < s.sites.size(); ++i) {
    const DeviceScenario device = s.sites[i].makeDevice(s.device);
    const CouplerGains own = s.sites[i].makeContact(s.site.contact);
    if (device.mass != first.mass) refuse(i, "device_mass", device.mass, first.mass);
    if (device.damping != first.damping) refuse(i, "device_damping", device.damping, first.damping);
    if (own.stiffness != contact.stiffness)
      refuse(i, "contact_stiffness", own.stiffness, contact.stiffness);
    if (own.damping != contact.damping) refuse(i, "contact_damping", own.damping, contact.damping);
    for (std::size_t k = 0; k < s.sites.size(); ++k)
      if (k != i && computeDelay(s, i, k) != delay)
        throw UsageError(
            fmt::format("the delay from site {} to site {} is {} s, from 1 to 2 {} s; an analysis "
                        "is of users who are alike",
                        i + 1, k + 1, computeDelay(s, i, k), delay));
  }
}

StandInKind findStandIn(const std::string& scheme) {
  if (scheme == "virtual_coupling") return StandInKind::kNone;
  return scheme == "kinematic_proxy" ? StandInKind::kHeld : StandInKind::kDynamic;
}

}  // namespace

LoopSettings makeLoop(const Scenario& s) {
  checkKind(s);
  checkAlike(s);
  const DeviceScenario device = s.sites[0].makeDevice(s.device);
  LoopSettings loop;
  loop.stand_in = findStandIn(s.scheme);
  loop.users = static_cast<int>(s.sites.size());
  loop.mode = s.site.coordination_mode;
  loop.has_object = s.hasObject();
  loop.object_mass = s.object_mass;
  loop.object_damping = s.object_damping;
  loop.contact = s.sites[0].makeContact(s.site.contact);
  loop.coordination = s.site.coordination;
  loop.proxy_mass = s.site.proxy.mass;
  loop.proxy_damping = s.site.proxy.damping;
  loop.device_mass = device.mass;
  loop.device_damping = device.damping;
  loop.haptic_rate = s.site.haptic_rate;
  loop.packet_rate = s.site.packet_rate;
  loop.delay = computeDelay(s, 0, 1);
  return loop;
}

}  // namespace tandem::demos
