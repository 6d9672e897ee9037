// Scenario files and --set: any text gives a checked scenario or a UsageError of one line.
//
// Input: the file's text; after each zero byte, one override.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "demos/program/scenario/scenario.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

bool isPositive(double value) { return std::isfinite(value) && value > 0.0; }

bool isOneLine(const std::string& text) {
  return !text.empty() && text.find_first_of("\n\r") == std::string::npos;
}

/// Requires the properties that the rest of the program assumes.
void requireChecked(const Scenario& s) {
  for (const double value :
       {s.duration, s.object_mass, s.object_size, s.site.proxy.mass, s.site.proxy.radius,
        s.device.mass, s.site.packet_rate, s.site.haptic_rate, s.host_rate, s.inner_rate})
    require(isPositive(value));
  require(std::abs(s.axis.norm() - 1.0) < 1e-12);
  require(s.network.delay >= 0.0 && s.network.delay <= s.duration);
  for (const SiteScenario& site : s.sites) require(site.hand.force.allFinite());
}

void parse(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    const Scenario scenario = parseScenario(text, "fuzz.toml", overrides);
    requireChecked(scenario);
    require(!describeScenario(scenario).dump().empty());
  } catch (const UsageError& error) {
    require(isOneLine(error.what()));
  }
}

}  // namespace
}  // namespace tandem::demos

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> parts(1);
  for (const std::uint8_t byte : std::basic_string_view<std::uint8_t>(data, size)) {
    if (byte == 0) {
      parts.emplace_back();
    } else {
      parts.back() += static_cast<char>(byte);
    }
  }
  tandem::demos::parse(parts.front(), {parts.begin() + 1, parts.end()});
  return 0;
}
