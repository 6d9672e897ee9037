#pragma once

#include <optional>

#include "tandem/plugin/live_peers.h"

namespace tandem::demos {

/// Judges what the other site answers while this one waits for it.
class AnswerCheck {
 public:
  /// `patience` until it is there [s]. `peers` must outlive this.
  AnswerCheck(const LivePeers& peers, PeerId other, double patience)
      : peers_(peers), other_(other), patience_(patience) {}

  /// After `waited` [s]. Throws UsageError if the other site has another configuration, or does not
  /// agree to a change within 5 s. Throws tandem::Error if it is not there after the patience, or
  /// counts down for longer.
  void check(double waited);
  /// Throws tandem::Error if the other site left before the start, and so will not be there.
  void checkCountdown() const;

 private:
  [[nodiscard]] PeerStatus readStatus() const;
  void checkConfiguration(const PeerStatus& status, double waited);

  const LivePeers& peers_;
  PeerId other_;
  double patience_;
  std::optional<double> disagrees_since_;  ///< about a change [s]
};

}  // namespace tandem::demos
