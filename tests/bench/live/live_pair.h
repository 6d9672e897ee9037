#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/recording.h"

#include "demos/program/scenario/scenario.h"
#include "host_thread.h"

namespace tandem::bench {

struct LivePairSettings {
  int priority = 80;  ///< SCHED_FIFO priority of both haptic threads; 0: none
  int boxes = 1000;   ///< active boxes in site 1's world
  bool records = false;
};

/// Results of one run of two live sites. All of them are site 1's.
struct LivePairReport {
  LoopReport loop;
  HostReport host;
  std::vector<std::string> notes;
  std::uint32_t status = 0;                   ///< TickStatus bits of both sites
  std::uint64_t packets_taken = 0, lost = 0;  ///< states taken; states lost at a full queue
  /// Recordings of sites 1 and 2, if requested.
  std::unique_ptr<Recording> recordings[2];
};

/// Runs a scenario in real time. Two sites have a haptic thread and a host thread each; one thread
/// is the simulated network between them.
[[nodiscard]] LivePairReport runLivePair(const demos::Scenario& scenario,
                                         const LivePairSettings& settings);

}  // namespace tandem::bench
