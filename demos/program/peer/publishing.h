#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "tandem/plugin/site.h"

#include "peer/dds/dds_bus.h"

namespace tandem::demos {

/// The publisher of `--publish`. Says on stderr, in one line, that it shows `what`, and to whom.
/// Throws as readDdsDomain() and makeDdsPublisher() do.
[[nodiscard]] PublishStates makePublisher(const std::string& word, const std::string& what);

/// Shows a live site to a laboratory 60 times a second. A thread of its own publishes, so neither
/// the haptic thread nor that of the world waits for the bus. It leaves out what it is late for.
class SitePublisher {
 public:
  SitePublisher(PublishStates publish, PeerId site);

  /// After each host step, which ends at `time` [s], in its thread. If a picture is due, reads the
  /// site between two ticks.
  void noteStep(double time, Site& site);

 private:
  void read(Site& site);
  void run(const std::stop_token& stop);

  PublishStates publish_;
  SiteStates latest_;  ///< of the world's thread
  double next_ = 0.0;  ///< time of the next picture [s]

  std::mutex mutex_;  // of the two below
  std::condition_variable_any is_new_;
  SiteStates newest_;
  bool has_newest_ = false;
  std::jthread thread_;  ///< ends before the rest
};

}  // namespace tandem::demos
