#pragma once

#include <cstdint>
#include <optional>

#include "tandem/coordination/coupling_settings.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Damping against the world that brings a proxy to rest while its gains fade [N s/m]. With the
/// share s of K and B left and 1 - s of this, the damping ratio stays at least what it was, or 1:
///
///   b = max(B, 2 sqrt(K m), m / decay)
[[nodiscard]] double computeRestDamping(const CouplerGains& gains, double mass,
                                        double decay) noexcept;

/// How often what happened.
struct LinkCounters {
  std::uint64_t faded = 0;     ///< gains began to fall
  std::uint64_t lost = 0;      ///< and were zero
  std::uint64_t rejoined = 0;  ///< heard again after that, or for the first time after waiting
};

/// Decides what share of the gains to a remote peer is in force, from the times at which its states
/// were taken in. It fades gains, never forces: a spring that loses its stiffness loses the energy
/// in it, too.
///
///   age < stale_after   live     share 1
///   < fade_after        stale    share 1, velocities times exp(-(age - stale_after) / hold_decay)
///   <= lost_after       fading   share falls linearly to 0
///   beyond              lost     share 0, velocities 0
///
/// All ages are longer by max(1, 3 P / stale_after) for a sender with the packet period P, which is
/// kIdlePacketPeriod while it says that it is idle. Heard again while fading, the share rises from
/// where it was, by 1 / ramp_in; heard again after that, from 0. It rises only while the peer is
/// heard. The proxy has a share of its own: it must not be let in where something is in its place.
///
/// Plain value without a clock; real-time safe.
class LinkHealth {
 public:
  /// `packet_period` of the sender while it is not idle [s], > 0. Settings as checked.
  LinkHealth(const LinkLossSettings& settings, double packet_period) noexcept;

  /// A state of the peer was taken in at `time` [s], not before any other. True if the peer comes
  /// back with it: it was lost, or waited for.
  bool hear(double time, bool is_idle) noexcept;

  /// True if the peer is live and nothing has changed by `time`: update() has nothing to do.
  [[nodiscard]] bool staysLive(double time) const noexcept {
    return state_ == LinkState::kLive && !(heard_ && time - *heard_ >= stale_after_);
  }

  /// What holds from `time` on, not before the latest hear() or update(). `place_is_free`: the
  /// proxy overlaps nothing; looked at while isProxyOut().
  void update(double time, bool place_is_free) noexcept;

  [[nodiscard]] LinkState state() const noexcept { return state_; }
  /// Of the gains between copies of shared objects, 0 to 1.
  [[nodiscard]] double objectShare() const noexcept { return object_share_; }
  /// Of the proxy's gains, 0 to 1.
  [[nodiscard]] double proxyShare() const noexcept { return proxy_share_; }
  /// True while the proxy must meet nothing: lost, waiting, or heard again and not let in yet.
  [[nodiscard]] bool isProxyOut() const noexcept { return is_out_; }
  /// What silence has taken of the gains, 0 to 1; what comes back by ramping in does not count.
  [[nodiscard]] double silence() const noexcept { return 1.0 - fade_; }
  /// By which the velocity of what was heard last is to be multiplied, 0 to 1.
  [[nodiscard]] double velocityShare() const noexcept { return velocity_share_; }
  [[nodiscard]] const LinkCounters& counters() const noexcept { return counters_; }

  /// Time since the peer was heard last [s]; 0 before the first time.
  [[nodiscard]] double computeAge(double time) const noexcept;
  /// True if a state that is taken in at `time` comes after a silence in which targets stood.
  [[nodiscard]] bool isOverdue(double time) const noexcept;

 private:
  /// A share that rises to 1 from a value that it had at some time.
  struct Ramp {
    double from = 1.0, since = 0.0;
  };

  void scaleAges(double packet_period) noexcept;
  void look(double time) noexcept;
  [[nodiscard]] double valueOf(const Ramp& ramp, double time) const noexcept;

  LinkLossSettings settings_;
  double packet_period_;
  double scale_ = 1.0;        ///< of all ages
  double stale_after_ = 0.0;  ///< times the scale [s]
  std::optional<double> heard_;
  Ramp object_ramp_, proxy_ramp_;
  LinkState state_ = LinkState::kLive;
  bool is_out_ = false;
  double fade_ = 1.0, object_share_ = 1.0, proxy_share_ = 1.0, velocity_share_ = 1.0;
  LinkCounters counters_;
};

}  // namespace tandem
#pragma GCC visibility pop
