#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tandem/coordination/passivity_observer.h"
#include "tandem/plugin/recording.h"
#include "tandem/plugin/site.h"

namespace tandem::demos {

/// Results of a run at one site.
struct SiteSummary {
  double received_mean = 0.0;  ///< mean |own object copy - other's as received| [m]
  int contact_transitions = 0;
  double force_max = 0.0, force_mean = 0.0;  ///< norm [N]
  double device_end = 0.0;                   ///< displacement along the axis [m]
  SiteCounters counters;
  PassivityObserver passivity;
};

/// All values from the site and its recording, except `received_mean` and `device_end`.
[[nodiscard]] SiteSummary summariseSite(const Site& site, const Recording& recording);

/// The keys of `site1` and so on in summary.json.
[[nodiscard]] nlohmann::json describeSite(const SiteSummary& summary);

}  // namespace tandem::demos
