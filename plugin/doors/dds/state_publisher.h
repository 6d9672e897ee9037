#pragma once

#include <memory>

#include "dds/site_states.h"

namespace tandem {

/// Publishes states of sites in clear, for recorders and visualisers of a trusted segment: topics
/// tandem/hands and tandem/objects of states.idl, best effort, the newest sample of each instance.
/// Everybody on the domain can read them.
///
/// One thread. publish() takes locks of Cyclone, allocates, and may wait for the network interface:
/// neither a haptic thread nor one that steps a world should call it.
class StatePublisher {
 public:
  /// `domain` is 0 to kHighestDdsDomain. Throws std::invalid_argument for another. Throws
  /// tandem::Error if Cyclone cannot open it, such as without a network.
  explicit StatePublisher(int domain);
  /// Readers see all instances disposed of.
  ~StatePublisher();
  StatePublisher(const StatePublisher&) = delete;
  StatePublisher& operator=(const StatePublisher&) = delete;

  /// What cannot be published is lost.
  void publish(const SiteStates& states) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
