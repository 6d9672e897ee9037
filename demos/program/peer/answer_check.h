#pragma once

#include <optional>
#include <string>

#include "tandem/plugin/live_peers.h"

#include "terminal/usage_error.h"

namespace tandem::demos {

/// Another site has another configuration, or does not follow a change.
class DisagreementError : public UsageError {
 public:
  /// `what` goes on after the site's name.
  DisagreementError(PeerId with, const std::string& what);

  PeerId site;
};

/// Says which value another site has else, if that is no change, and the remedy. Goes on after the
/// site's name.
[[nodiscard]] std::optional<std::string> describeDifference(const PeerStatus& status);

/// Judges what another site answers while this one waits for it.
class AnswerCheck {
 public:
  /// `patience` until it is there [s]. `peers` must outlive this.
  AnswerCheck(const LivePeers& peers, PeerId other, double patience)
      : peers_(peers), other_(other), patience_(patience) {}

  /// After `waited` [s]. Throws DisagreementError if that site has another configuration, or does
  /// not agree to a change within 5 s. Throws tandem::Error if it is not there after the patience,
  /// or counts down for longer.
  void check(double waited);
  /// Throws tandem::Error if that site left before the start, and so will not be there.
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
