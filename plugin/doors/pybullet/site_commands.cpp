#include <cmath>

#include "commands.h"
#include "refusal.h"

namespace tandem::pybullet {
namespace {

void readGains(Words& words, const char* key, TandemGains& gains) {
  double values[2]{};
  if (words.numbersIfThere(key, values, 2)) gains = {values[0], values[1]};
}

}  // namespace

void Commands::device(Words& words, Reply&) {
  const std::string kind = words.text("kind");
  double start[3]{};
  words.numbersIfThere("start", start, 3);
  TandemDevice* device = nullptr;
  if (kind == "moved") {
    TandemDeviceLimits limits{};
    limits.max_force = words.number("max_force", HUGE_VAL);
    limits.max_slew = words.number("max_slew", HUGE_VAL);
    words.finish();
    check(tandem_device_create_moved(start, limits, &device));
  } else if (kind == "simulated") {
    const double mass = words.number("mass", 0.1);
    const double damping = words.number("damping", 0.5);
    double guide[3]{};
    const bool has_guide = words.numbersIfThere("guide", guide, 3);
    words.finish();
    check(
        tandem_device_create_simulated(mass, damping, start, has_guide ? guide : nullptr, &device));
  } else {
    throw Refusal(kBadCommand, "kind=" + kind + ": there are moved and simulated");
  }
  session_.takeDevice(DeviceHandle(device), kind == "moved");
}

void Commands::site(Words& words, Reply&) {
  TandemSiteSettings settings = tandem_default_site_settings();
  const int self = words.integer("self", 1);
  if (self < 1) throw Refusal(kBadCommand, "self: 1 or more");
  settings.self = static_cast<std::uint32_t>(self);
  settings.peers = words.integer("peers", settings.peers);
  settings.haptic_rate = words.number("haptic_rate", settings.haptic_rate);
  settings.packet_rate = words.number("packet_rate", settings.packet_rate);
  settings.thins_when_idle = words.flag("thins_when_idle", settings.thins_when_idle != 0);
  readGains(words, "contact", settings.contact);
  readGains(words, "coordination", settings.coordination);
  settings.proxy_mass = words.number("proxy_mass", settings.proxy_mass);
  settings.proxy_damping = words.number("proxy_damping", settings.proxy_damping);
  settings.proxy_radius = words.number("proxy_radius", settings.proxy_radius);
  settings.hip_radius = words.number("hip_radius", settings.hip_radius);
  const std::string scheme = words.text("scheme", settings.scheme);
  settings.scheme = scheme.c_str();
  settings.has_guide = words.numbersIfThere("guide", settings.guide, 3) ? 1 : 0;
  settings.inner_step = words.number("inner_step", settings.inner_step);
  settings.max_neighbours = words.integer("max_neighbours", settings.max_neighbours);
  settings.link_loss = words.flag("link_loss", settings.link_loss != 0);
  settings.passivity = words.flag("passivity", settings.passivity != 0);
  settings.max_slew = words.number("max_slew", settings.max_slew);
  settings.fault_slew = words.number("fault_slew", settings.fault_slew);
  words.finish();
  session_.openSite(settings);
}

}  // namespace tandem::pybullet
