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
  int priority = 80;  ///< of both haptic threads, SCHED_FIFO; 0: none
  int boxes = 1000;   ///< active ones in site 1's world
  bool records = false;
};

/// What one run of two live sites came to. All of it is site 1's.
struct LivePairReport {
  LoopReport loop;
  HostReport host;
  std::vector<std::string> notes;
  std::uint32_t status = 0;                   ///< TickStatus bits of both sites
  std::uint64_t packets_taken = 0, lost = 0;  ///< states; those that found no room in a queue
  /// Of site 1 and 2, if asked for.
  std::unique_ptr<Recording> recordings[2];
};

/// Runs a scenario against the clock: two sites, each with a haptic thread and a host's thread, and
/// one thread that is the network between them, a simulated one.
[[nodiscard]] LivePairReport runLivePair(const demos::Scenario& scenario,
                                         const LivePairSettings& settings);

}  // namespace tandem::bench
