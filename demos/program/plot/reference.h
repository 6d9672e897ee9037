#pragma once

#include "plot/run.h"

namespace tandem::demos::plot {

/// What a run with the paper's settings must give; NaN where the paper's equations leave it open
/// (intermittent contact is chaotic: only the size of count and force means something).
struct ReferenceOutcome {
  std::string_view scheme;
  RunKind kind;
  double contact_stiffness;    // [N/m]
  double network_delay;        // [s]
  double mean_coherency;       // [m]
  double max_coherency;        // [m]
  double received_mean1;       // [m]
  double received_mean2;       // [m]
  double force_mean;           // on user 1 [N]
  double force_max;            // on user 1 [N]
  double contact_transitions;  // of user 1
  double device_end;           // of user 1 [m]
};

/// The outcome that Li & Constantinescu's equations give for this run, or null when its settings
/// are not those of their Experiment I or II.
[[nodiscard]] const ReferenceOutcome* referenceOf(const Run& run);

}  // namespace tandem::demos::plot
