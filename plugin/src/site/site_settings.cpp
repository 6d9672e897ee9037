#include "tandem/plugin/site_settings.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "bullet_bridge/src/native/native_coupling.h"

namespace tandem {
namespace {

void require(bool good, const char* name, double value, const char* allowed) {
  if (good) return;
  std::ostringstream message;
  message << name << " = " << value << ": must be " << allowed;
  throw std::invalid_argument(message.str());
}

void requirePositive(const char* name, double value) {
  require(value > 0.0 && std::isfinite(value), name, value, "a finite number above 0");
}

void requireNotNegative(const char* name, double value) {
  require(value >= 0.0 && std::isfinite(value), name, value, "a finite number, 0 or more");
}

void requireGains(const std::string& name, const CouplerGains& gains) {
  requireNotNegative((name + ".stiffness").c_str(), gains.stiffness);
  requireNotNegative((name + ".damping").c_str(), gains.damping);
}

}  // namespace

void checkSiteSettings(const SiteSettings& s) {
  require(s.peers >= 1 && s.peers <= 64, "peers", s.peers, "1 to 64");
  requirePositive("haptic_rate", s.haptic_rate);
  requirePositive("packet_rate", s.packet_rate);
  require(s.packet_rate <= s.haptic_rate, "packet_rate", s.packet_rate, "at most the haptic rate");
  requireNotNegative("host_step", s.host_step);
  requireGains("contact", s.contact);
  requireGains("coordination", s.coordination);
  if (s.angular_coordination) requireGains("angular_coordination", *s.angular_coordination);
  requirePositive("proxy.mass", s.proxy.mass);
  requireNotNegative("proxy.damping", s.proxy.damping);
  requirePositive("proxy.radius", s.proxy.radius);
  requirePositive("hip_radius", s.hip_radius);
  requirePositive("inner_step", s.inner_step);
  require(s.max_neighbours >= 0 && s.max_neighbours <= 256, "max_neighbours", s.max_neighbours,
          "0 to 256");
  requireNotNegative("host_stall", s.host_stall);
  require(s.max_slew > 0.0, "max_slew", s.max_slew, "above 0; inf: no limit");
  requirePositive("fault_slew", s.fault_slew);
  checkPassivitySettings(s.passivity);
  checkLinkLossSettings(s.link_loss);
  if (s.guide)
    require(std::abs(s.guide->norm() - 1.0) < 1e-9, "norm of guide", s.guide->norm(), "1");
  if (s.contact_model == ContactModel::kIsland) return;
  if (s.injection == Injection::kImpulse)
    throw std::invalid_argument(
        "injection = impulse: must be handoff with a native contact_model, which has no island "
        "whose forces could be injected");
  if (s.guide && !NativeGuide::canFollow(*s.guide))
    throw std::invalid_argument(
        "guide: must lie along x, y or z of the world with a native contact_model, as Bullet's "
        "linear factors do");
}

}  // namespace tandem
