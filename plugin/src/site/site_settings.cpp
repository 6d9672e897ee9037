#include "tandem/plugin/site_settings.h"

#include <cmath>
#include <stdexcept>

#include "tandem/coordination/site_set.h"

#include "bullet_bridge/src/native/native_coupling.h"
#include "coordination/src/bad_value.h"

namespace tandem {
namespace {

void require(bool good, const char* name, double value, const char* allowed) {
  if (!good) throwBadValue(name, value, allowed);
}

/// Bullet's own means cannot do these.
void checkNative(const SiteSettings& s) {
  if (s.injection == Injection::kImpulse)
    throw std::invalid_argument(
        "injection = impulse: must be handoff with a native contact_model, which has no island "
        "whose forces could be injected");
  if (s.guide && !NativeGuide::canFollow(*s.guide))
    throw std::invalid_argument(
        "guide: must lie along x, y or z of the world with a native contact_model, as Bullet's "
        "linear factors do");
}

/// Only the island can change masses and fade peers while it runs.
void checkMembership(const SiteSettings& s) {
  if (s.contact_model != ContactModel::kIsland || s.injection != Injection::kHandoff ||
      !s.link_loss.enabled)
    throw std::invalid_argument(
        "membership.follows = 1: needs contact_model = island, injection = handoff and "
        "link_loss.enabled = 1; or set it to 0, and `peers` to the number of sites");
  require(SiteSet::all().has(s.self), "self, with membership.follows", static_cast<double>(s.self),
          "1 to 64");
}

}  // namespace

void checkSiteSettings(const SiteSettings& s) {
  checkPassivitySettings(s.passivity);
  checkLinkLossSettings(s.link_loss);
  for (const SiteField& field : siteFields())
    require(field.range.contains(field.get(s)), field.name, field.get(s), field.range.allowed);
  require(s.packet_rate <= s.haptic_rate, "packet_rate", s.packet_rate, "at most the haptic rate");
  if (const auto& angular = s.angular_coordination) {
    const FieldRange range;
    require(range.contains(angular->stiffness), "angular_coordination.stiffness",
            angular->stiffness, range.allowed);
    require(range.contains(angular->damping), "angular_coordination.damping", angular->damping,
            range.allowed);
  }
  if (s.guide)
    require(std::abs(s.guide->norm() - 1.0) < 1e-9, "norm of guide", s.guide->norm(), "1");
  if (s.contact_model != ContactModel::kIsland) checkNative(s);
  if (s.membership.follows) checkMembership(s);
}

}  // namespace tandem
