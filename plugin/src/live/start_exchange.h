#pragma once

#include <optional>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/plugin/live_peers.h"

#include "live/peer_link.h"

namespace tandem {

/// Lets all sites begin at one moment. Time is passed in; one thread.
///
/// The site with the lowest number chooses a moment ahead, once all its peers are live. The states
/// that its user holds until then count down to it. The others subtract half the round trip from
/// the first that reaches them. They follow the countdown of their lowest peer only, and of nobody
/// if they are the lowest themselves. A site joins any peer that runs already.
class StartExchange {
 public:
  /// A peer as its connection shows it now.
  struct Peer {
    PeerId id{};
    TimeBridge& bridge;
    bool is_live = false;     ///< states go both ways
    double round_trip = 0.0;  ///< [s]; 0: not known yet
    double wait = 0.0;        ///< that playout adds [s]
  };

  /// Held states go out `rate` times a second. A countdown of more than `longest` [s] is refused.
  StartExchange(PeerId self, const PointState& held, double rate,
                double longest = kLongestCountdown) noexcept
      : self_(self), held_(held), period_(1.0 / rate), longest_(longest) {}

  /// Takes the start from what has come in, or chooses it, and tells the peers.
  void advance(double now, const std::vector<Peer>& peers) noexcept;

  /// The clock at site time 0, once it is known [s].
  [[nodiscard]] std::optional<double> start() const noexcept { return start_; }
  /// The latest countdown that was refused for its length.
  [[nodiscard]] const std::optional<RefusedCountdown>& refused() const noexcept { return refused_; }

 private:
  [[nodiscard]] PeerId findLowest(const std::vector<Peer>& peers) const noexcept;
  void learn(const std::vector<Peer>& peers, PeerId lowest) noexcept;
  void choose(double now, const std::vector<Peer>& peers) noexcept;

  PeerId self_;
  PointState held_;
  double period_, longest_;
  std::optional<double> next_send_, live_since_;
  std::optional<double> start_;
  std::optional<RefusedCountdown> refused_;
};

}  // namespace tandem
