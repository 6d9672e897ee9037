#include <stdexcept>

#include "tandem/coordination/scheme.h"

#include "c/site.h"
#include "c/values.h"

namespace tandem::c_door {
namespace {

/// Marks settings made by tandem_default_site_settings().
constexpr int kCookie = 0x54735345;

[[nodiscard]] TandemGains writeGains(const CouplerGains& gains) noexcept {
  return {gains.stiffness, gains.damping};
}
[[nodiscard]] CouplerGains readGains(const TandemGains& gains) noexcept {
  return {gains.stiffness, gains.damping};
}

[[nodiscard]] TickSource readTickSource(int source) {
  switch (source) {
    case TANDEM_TICK_HOST_STEP:
      return TickSource::kHostStep;
    case TANDEM_TICK_CALLER:
      return TickSource::kCaller;
    default:
      refuseValue("tick_source", source, "TANDEM_TICK_HOST_STEP or TANDEM_TICK_CALLER");
  }
}

}  // namespace

SiteSettings fromC(const TandemSiteSettings& c) {
  if (c.internal != kCookie)
    throw std::invalid_argument(
        "the site settings are not from tandem_default_site_settings(); begin with those");
  if (c.self == 0) refuseValue("self", 0, "1 or more, another one at each site");
  SiteSettings settings;
  settings.self = PeerId{c.self};
  settings.peers = c.peers;
  settings.haptic_rate = c.haptic_rate;
  settings.packet_rate = c.packet_rate;
  settings.thins_when_idle = c.thins_when_idle != 0;
  settings.host_step = c.host_step;
  settings.contact = readGains(c.contact);
  settings.coordination = readGains(c.coordination);
  settings.proxy = {c.proxy_mass, c.proxy_damping, c.proxy_radius};
  settings.hip_radius = c.hip_radius;
  settings.scheme = &findScheme(&checkPointer(c.scheme, "scheme"));
  settings.tick_source = readTickSource(readNumber(c.tick_source));
  if (c.has_guide) settings.guide = readUnitVec3("guide", c.guide);
  settings.inner_step = c.inner_step;
  settings.max_neighbours = c.max_neighbours;
  settings.link_loss.enabled = c.link_loss != 0;
  settings.passivity.enabled = c.passivity != 0;
  settings.max_slew = c.max_slew;
  settings.fault_slew = c.fault_slew;
  checkSiteSettings(settings);
  return settings;
}

}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" TandemSiteSettings tandem_default_site_settings(void) {
  const SiteSettings defaults;
  TandemSiteSettings c{};
  c.internal = kCookie;
  c.self = static_cast<std::uint32_t>(defaults.self);
  c.peers = defaults.peers;
  c.haptic_rate = defaults.haptic_rate;
  c.packet_rate = defaults.packet_rate;
  c.thins_when_idle = defaults.thins_when_idle;
  c.host_step = defaults.host_step;
  c.contact = writeGains(defaults.contact);
  c.coordination = writeGains(defaults.coordination);
  c.proxy_mass = defaults.proxy.mass;
  c.proxy_damping = defaults.proxy.damping;
  c.proxy_radius = defaults.proxy.radius;
  c.hip_radius = defaults.hip_radius;
  c.scheme = "remote_dynamic_proxy";
  c.tick_source = TANDEM_TICK_HOST_STEP;
  c.guide[0] = 1.0;
  c.inner_step = defaults.inner_step;
  c.max_neighbours = defaults.max_neighbours;
  c.link_loss = defaults.link_loss.enabled;
  c.passivity = defaults.passivity.enabled;
  c.max_slew = defaults.max_slew;
  c.fault_slew = defaults.fault_slew;
  return c;
}
