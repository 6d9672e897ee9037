#include "world/site_summary.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace tandem::demos {

SiteSummary summariseSite(const Site& site, const Recording& recording) {
  SiteSummary summary;
  const auto ticks = static_cast<double>(recording.ticks().size());
  bool touching = false;
  for (const TickRecord& tick : recording.ticks()) {
    if (tick.contact != touching) ++summary.contact_transitions;
    touching = tick.contact;
    const double force = tick.f_W.norm();
    summary.force_max = std::max(summary.force_max, force);
    summary.force_mean += force / ticks;
  }
  summary.counters = site.counters();
  summary.passivity = site.passivity();
  return summary;
}

nlohmann::json describeSite(const SiteSummary& summary) {
  return {{"coherency", {{"received_mean", summary.received_mean}}},
          {"contact_transitions", summary.contact_transitions},
          {"force", {{"max", summary.force_max}, {"mean", summary.force_mean}}},
          {"device_end", summary.device_end},
          {"guards",
           {{"clamped", summary.counters.force_clamped},
            {"slewed", summary.counters.force_slewed},
            {"energy_limited", summary.counters.energy_limited},
            {"energy_in", summary.passivity.own()},
            {"energy_lowest", summary.passivity.lowest()}}}};
}

}  // namespace tandem::demos
