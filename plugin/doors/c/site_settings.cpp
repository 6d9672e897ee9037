#include <stdexcept>

#include "tandem/coordination/scheme.h"

#include "c/site.h"
#include "c/site_words.h"
#include "c/values.h"

namespace tandem::c_door {
namespace {

/// Marks settings made by tandem_default_site_settings().
constexpr int kCookie = 0x54735345;

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

[[nodiscard]] CoordinationMode readCoordinationMode(int mode) {
  switch (mode) {
    case TANDEM_COORDINATION_SUM:
      return CoordinationMode::kSum;
    case TANDEM_COORDINATION_AVERAGE:
      return CoordinationMode::kAverage;
    default:
      refuseValue("coordination_mode", mode,
                  "TANDEM_COORDINATION_SUM or TANDEM_COORDINATION_AVERAGE");
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
  for (const SiteWord& word : kSiteWords) findSiteField(word.field).set(settings, word.get(c));
  settings.scheme = &findScheme(&checkPointer(c.scheme, "scheme"));
  settings.coordination_mode = readCoordinationMode(readNumber(c.coordination_mode));
  settings.tick_source = readTickSource(readNumber(c.tick_source));
  if (c.has_guide) settings.guide = readUnitVec3("guide", c.guide);
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
  for (const SiteWord& word : kSiteWords) word.set(c, findSiteField(word.field).get(defaults));
  c.scheme = "remote_dynamic_proxy";
  c.coordination_mode = TANDEM_COORDINATION_SUM;
  c.tick_source = TANDEM_TICK_HOST_STEP;
  c.guide[0] = 1.0;
  return c;
}
