#pragma once

#include "tandem/coordination/link.h"

namespace tandem {

// clang-format off
/// Tells a peer that restarted, and counts its packets from 0 again, from packets that are late.
///
///   packets    none newer than the newest known, in rising order of sequence and of the peer's time
///   restart    three of them, later than the newest by the peer's clock: no late packet is
///              kLongestDelay of them by both clocks: its clock began anew, too
///
/// Late packets are older by the sender's clock, and end once they have caught up with the newest.
/// A link that is slower than kLongestDelay and then passes nothing else is taken for a restart;
/// that leads the peer's states back in time. Plain value; real-time safe.
// clang-format on
class RestartWatch {
 public:
  /// Notes a packet that is newer than all before.
  void noteNewest() noexcept { count_ = 0; }

  /// Notes one that is not, which came at `arrived` [s]. True if its sender has restarted.
  [[nodiscard]] bool isRestart(const StatePacket& packet, const StatePacket& newest,
                               double arrived) noexcept {
    const bool is_behind = packet.sequence <= sequence_ && packet.time <= time_;
    if (count_ > 0 && is_behind) return false;
    const bool rises = packet.sequence > sequence_ && packet.time > time_;
    if (count_ == 0 || !rises) {
      count_ = 0;
      first_time_ = packet.time;
      first_arrived_ = arrived;
    }
    ++count_;
    sequence_ = packet.sequence;
    time_ = packet.time;
    if (count_ < kEnough) return false;
    return packet.time > newest.time ||
           (packet.time - first_time_ > kLongestDelay && arrived - first_arrived_ > kLongestDelay);
  }

 private:
  static constexpr int kEnough = 3;
  static constexpr double kLongestDelay = 2.0;  // [s]

  int count_ = 0;  ///< packets in a row
  std::uint64_t sequence_ = 0;
  double time_ = 0.0, first_time_ = 0.0, first_arrived_ = 0.0;
};

}  // namespace tandem
