#include "analyse/growth_warning.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "tandem/coordination/stability_advice.h"

#include "analyse/analysis.h"
#include "analyse/loop_of_scenario.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

std::optional<ModeGrowth> findGrowth(const Scenario& scenario) {
  try {
    return computeWorstGrowth(makeLoop(scenario));
  } catch (const UsageError&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<std::string> warnOfGrowth(const Scenario& scenario) {
  const auto worst = findGrowth(scenario);
  if (!worst || worst->growth.rate < 0.0) return std::nullopt;
  return fmt::format(
      "with lasting contact and empty hands, motion {} doubles in {:.2g} s, at {:.1f} Hz; tandem "
      "analyse tells which gain to turn",
      explain(worst->mode), std::log(2.0) / worst->growth.rate, worst->growth.frequency);
}

}  // namespace tandem::demos
