#pragma once

#include <cstdint>
#include <optional>

#include "coordination/src/link/playout.h"
#include "coordination/src/link/round_trip.h"
#include "coordination/src/wire/wire_state.h"
#include "net/refusal.h"

namespace tandem::net {

/// States in both directions of one pair: stamps, echoes, acknowledgements, playout. It outlives
/// the keys, and a peer that has begun anew goes on where it ended: the receiver of states sees one
/// sequence that only goes up. Real-time safe after construction.
class StateStream {
 public:
  StateStream(const PlayoutSettings& playout, WireProfile profile, std::uint32_t config_hash)
      : playout_(playout), profile_(profile), config_hash_(config_hash) {}

  /// Payload of the next STATE; its size, 0 if the state cannot be sent.
  [[nodiscard]] std::size_t write(const StatePacket& packet, double now, ByteSpan payload) noexcept;

  /// Any datagram that was opened: for acknowledgements and loss.
  void note(std::uint64_t sequence, double now) noexcept;

  /// A STATE that was opened, after note(); `sequence` is its datagram's, nothing for one under
  /// keys that were replaced: such a one counts unless the peer has begun anew since. It has an
  /// effect on times only, unless `is_agreed`.
  [[nodiscard]] Outcome read(ByteView payload, PeerId sender, std::optional<std::uint64_t> sequence,
                             bool is_agreed, double now) noexcept;

  /// The next state due before `until`; see Playout::pop().
  [[nodiscard]] std::optional<Arrival> pop(double from, double until) noexcept {
    return playout_.pop(from, until);
  }

  /// New keys: datagrams count from 0 again.
  void startKeys() noexcept;

  [[nodiscard]] const RoundTrip& trip() const noexcept { return trip_; }
  [[nodiscard]] const Playout& playout() const noexcept { return playout_; }
  /// Share of the peer's datagrams that did not come, over the last second or so; 0 to 1.
  [[nodiscard]] double loss() const noexcept { return loss_; }

 private:
  void countLoss(std::uint64_t sequence, double now) noexcept;
  [[nodiscard]] std::uint32_t computeAckBits() const noexcept;

  Playout playout_;
  RoundTrip trip_;
  WireProfile profile_;
  std::uint32_t config_hash_;
  std::int64_t last_sent_us_ = 0;

  // What came in under the present keys.
  std::optional<std::uint64_t> top_;  ///< highest sequence of all datagrams
  std::uint64_t came_ = 0;            ///< bit i: top - i came in
  bool has_news_ = false;
  std::uint64_t newest_ = 0;  ///< highest sequence of a STATE
  std::int64_t newest_sent_us_ = 0;
  double newest_at_ = 0.0;

  // A peer that begins anew counts its states, and its energy, from 0.
  bool is_first_of_keys_ = true;
  bool has_begun_anew_ = false;      ///< with the present keys: what is under the old ones is past
  std::int64_t latest_sent_us_ = 0;  ///< by its clock, in all that came
  std::uint64_t offset_ = 0;
  std::uint64_t highest_ = 0;
  bool has_state_ = false;
  double energy_ = 0.0, energy_offset_ = 0.0;  ///< of the state with the highest sequence [J]

  double loss_ = 0.0, loss_since_ = 0.0;
  std::uint64_t loss_first_ = 0, loss_received_ = 0;
};

}  // namespace tandem::net
