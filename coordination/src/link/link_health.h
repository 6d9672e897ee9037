#pragma once

#include <cstdint>
#include <optional>

#include "tandem/coordination/coupling_settings.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Damping against the world that brings a proxy to rest while its gains fade [N s/m]. A share s of
/// K and B acts with 1 - s of this damping. The damping ratio then never falls below its value at
/// full gains:
///
///   b = max(B, 2 sqrt(K m), m / decay)
[[nodiscard]] double computeRestDamping(const CouplerGains& gains, double mass,
                                        double decay) noexcept;

/// Counts of the events of a link.
struct LinkCounters {
  std::uint64_t faded = 0;     ///< the gains began to fall
  std::uint64_t lost = 0;      ///< the gains reached zero
  std::uint64_t rejoined = 0;  ///< a state arrived after a loss, or the first after waiting
};

/// Computes the share of the gains to a remote peer from the arrival times of its states. It fades
/// gains, never forces: a spring that loses its stiffness also loses its energy.
///
///   age < stale_after   live     share 1
///   < fade_after        stale    share 1, velocities times exp(-(age - stale_after) / hold_decay)
///   <= lost_after       fading   share falls linearly to 0
///   beyond              lost     share 0, velocities 0
///
/// All ages scale by max(1, 3 P / stale_after), where P is the sender's packet period. P is
/// kIdlePacketPeriod while the sender reports itself idle. If states return while fading, the share
/// rises from its present value by 1 / ramp_in per second; after a loss it rises from 0. It rises
/// only while states arrive. The proxy has its own share: it must not return into an occupied
/// place.
///
/// Plain value without a clock; real-time safe.
class LinkHealth {
 public:
  /// `packet_period` [s], > 0, is that of a sender that is not idle. Expects checked settings.
  LinkHealth(const LinkLossSettings& settings, double packet_period) noexcept;

  /// Notes a state of the peer, applied at `time` [s]; times must not go back. True if the peer was
  /// lost or waiting until now.
  bool hear(double time, bool is_idle) noexcept;

  /// Forgets what was heard: the peer is awaited as at a start without it. Counts stay. With link
  /// loss enabled.
  void await() noexcept;

  /// True if the peer is live and nothing changes by `time`: update() has nothing to do.
  [[nodiscard]] bool staysLive(double time) const noexcept {
    return state_ == LinkState::kLive && !(heard_ && time - *heard_ >= stale_after_);
  }

  /// Updates the shares to `time` [s], which must not go back. `place_is_free`: the proxy overlaps
  /// nothing; only used while isProxyOut().
  void update(double time, bool place_is_free) noexcept;

  [[nodiscard]] LinkState state() const noexcept { return state_; }
  /// Share of the gains between copies of shared objects, 0 to 1.
  [[nodiscard]] double objectShare() const noexcept { return object_share_; }
  /// Share of the proxy's gains, 0 to 1.
  [[nodiscard]] double proxyShare() const noexcept { return proxy_share_; }
  /// True while the proxy must touch nothing: lost, waiting, or returning to an occupied place.
  [[nodiscard]] bool isProxyOut() const noexcept { return is_out_; }
  /// Share of the gains lost to silence, 0 to 1; ramping in does not count.
  [[nodiscard]] double silence() const noexcept { return 1.0 - fade_; }
  /// Factor for the velocity of the last state, 0 to 1.
  [[nodiscard]] double velocityShare() const noexcept { return velocity_share_; }
  [[nodiscard]] const LinkCounters& counters() const noexcept { return counters_; }

  /// Time since the last state of the peer [s]; 0 before the first.
  [[nodiscard]] double computeAge(double time) const noexcept;
  /// True if a state applied at `time` ends a silence in which targets stood still.
  [[nodiscard]] bool isOverdue(double time) const noexcept;

 private:
  /// A share that rises from `from` at time `since` [s] to 1.
  struct Ramp {
    double from = 1.0, since = 0.0;
  };

  void scaleAges(double packet_period) noexcept;
  void look(double time) noexcept;
  [[nodiscard]] double valueOf(const Ramp& ramp, double time) const noexcept;

  LinkLossSettings settings_;
  double packet_period_;
  double scale_ = 1.0;        ///< factor for all ages
  double stale_after_ = 0.0;  ///< settings_.stale_after times the scale [s]
  std::optional<double> heard_;
  Ramp object_ramp_, proxy_ramp_;
  LinkState state_ = LinkState::kLive;
  bool is_out_ = false;
  double fade_ = 1.0, object_share_ = 1.0, proxy_share_ = 1.0, velocity_share_ = 1.0;
  LinkCounters counters_;
};

}  // namespace tandem
#pragma GCC visibility pop
