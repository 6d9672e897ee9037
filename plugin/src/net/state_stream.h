#pragma once

#include <cstdint>
#include <optional>

#include "coordination/src/link/playout.h"
#include "coordination/src/link/round_trip.h"
#include "coordination/src/wire/wire_state.h"
#include "net/loss_meter.h"
#include "net/refusal.h"

namespace tandem::net {

/// States of one pair in both directions: stamps, echoes, acknowledgements, playout. It outlives
/// the keys. If the peer restarts, its numbers are continued, so the receiver sees one increasing
/// sequence. Real-time safe after construction.
class StateStream {
 public:
  StateStream(const PlayoutSettings& playout, WireProfile profile, std::uint32_t config_hash)
      : playout_(playout), profile_(profile), config_hash_(config_hash) {}

  /// Writes the payload of the next STATE. Returns its size, 0 if the state cannot be encoded.
  /// A peer of an older `minor` version hears of no grip, or of no roll.
  [[nodiscard]] std::size_t write(const StatePacket& packet, std::uint8_t minor, double now,
                                  ByteSpan payload) noexcept;

  /// Notes any opened datagram, for acknowledgements and loss.
  void note(std::uint64_t sequence) noexcept;

  /// Takes an opened STATE, after note(). `sequence` is that of its datagram, empty under replaced
  /// keys. A state under replaced keys is dropped if the peer has restarted since. Unless
  /// `is_agreed` the state only updates times.
  [[nodiscard]] Outcome read(ByteView payload, PeerId sender, std::optional<std::uint64_t> sequence,
                             bool is_agreed, double now) noexcept;

  /// Returns the next state due before `until`; see Playout::pop().
  [[nodiscard]] std::optional<Arrival> pop(double from, double until) noexcept {
    return playout_.pop(from, until);
  }

  /// Starts new keys: datagrams count from 0 again.
  void startKeys() noexcept;

  /// Time since the first STATE that the peer may have missed, 0 if it missed none [s].
  [[nodiscard]] double unheardFor(double now) const noexcept {
    return unheard_since_ ? now - *unheard_since_ : 0.0;
  }

  [[nodiscard]] const RoundTrip& trip() const noexcept { return trip_; }
  [[nodiscard]] const Playout& playout() const noexcept { return playout_; }
  /// Fraction of the peer's states lost in the last second, 0 to 1.
  [[nodiscard]] double loss() const noexcept { return loss_.loss(); }

 private:
  [[nodiscard]] std::uint32_t computeAckBits() const noexcept;

  Playout playout_;
  RoundTrip trip_;
  WireProfile profile_;
  std::uint32_t config_hash_;
  std::int64_t last_sent_us_ = 0;
  std::int64_t newest_echo_us_ = 0;      ///< newest STATE that the peer says it has
  std::optional<double> unheard_since_;  ///< first STATE after that [s]

  // Received under the present keys.
  std::optional<std::uint64_t> top_;  ///< highest sequence of all datagrams
  std::uint64_t came_ = 0;            ///< bit i: datagram top - i came
  bool has_news_ = false;
  std::uint64_t newest_ = 0;  ///< highest sequence of a STATE
  std::int64_t newest_sent_us_ = 0;
  double newest_at_ = 0.0;

  // A restarted peer counts its states and its grants from 0.
  bool is_first_of_keys_ = true;
  bool has_begun_anew_ = false;      ///< with the present keys; drops states under the old ones
  std::int64_t latest_sent_us_ = 0;  ///< latest time stamp by the peer's clock [us]
  std::uint64_t offset_ = 0;
  std::uint64_t highest_ = 0;
  bool has_state_ = false;
  double granted_ = 0.0, granted_offset_ = 0.0;  ///< by the state with the highest sequence [J]

  LossMeter loss_;
};

}  // namespace tandem::net
