#pragma once

#include <optional>
#include <vector>

#include "tandem/coordination/link.h"

#include "live/peer_link.h"

namespace tandem {

/// Lets all sites begin at one moment. Time is passed in; one thread.
///
/// The site with the lowest number chooses a moment ahead, once all its peers are live. The states
/// that its user holds until then count down to it. The others subtract half the round trip from
/// the first that reaches them.
class StartExchange {
 public:
  /// A peer as its connection shows it now.
  struct Peer {
    TimeBridge& bridge;
    bool is_live = false;     ///< states go both ways
    double round_trip = 0.0;  ///< [s]; 0: not known yet
    double wait = 0.0;        ///< that playout adds [s]
  };

  /// `chooses`: no peer has a lower number. Held states go out `rate` times a second.
  StartExchange(PeerId self, bool chooses, const PointState& held, double rate) noexcept
      : self_(self), chooses_(chooses), held_(held), period_(1.0 / rate) {}

  /// Takes the start from what has come in, or chooses it, and tells the peers.
  void advance(double now, const std::vector<Peer>& peers) noexcept;

  /// The clock at site time 0, once it is known [s].
  [[nodiscard]] std::optional<double> start() const noexcept { return start_; }

 private:
  void learn(const std::vector<Peer>& peers) noexcept;
  void choose(double now, const std::vector<Peer>& peers) noexcept;

  PeerId self_;
  bool chooses_;
  PointState held_;
  double period_;
  std::optional<double> next_send_, live_since_;
  std::optional<double> start_;
};

}  // namespace tandem
