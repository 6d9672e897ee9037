#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tandem::net {

/// Lost fraction of a peer's states, second by second.
///
/// Datagrams and states both have numbers, and neither tells alone. Among the datagrams are
/// challenges to other addresses, which need not come here. States to other peers may share the
/// numbers. So a state is lost if numbers of both kinds are missing. Real-time safe.
class LossMeter {
 public:
  /// New keys: datagrams count from 0 again.
  void begin() noexcept { datagrams_ = states_ = {}; }

  void noteDatagram(std::uint64_t sequence) noexcept { datagrams_.note(sequence); }

  /// After the noteDatagram() of its datagram.
  void noteState(std::uint64_t sequence, double now) noexcept {
    if (states_.came == 0) since_ = now;
    states_.note(sequence);
    if (now - since_ < kPeriod) return;
    const double lost = static_cast<double>(std::min(datagrams_.missing(), states_.missing()));
    loss_ = lost / (lost + static_cast<double>(states_.came));
    begin();
  }

  /// Of the last whole second, 0 to 1.
  [[nodiscard]] double loss() const noexcept { return loss_; }

 private:
  static constexpr double kPeriod = 1.0;  // [s]

  struct Numbers {
    std::uint64_t first = 0, last = 0, came = 0;

    void note(std::uint64_t number) noexcept {
      if (came++ == 0) first = last = number;
      last = std::max(last, number);
    }
    /// One of before the first makes up for one that is missing.
    [[nodiscard]] std::uint64_t missing() const noexcept {
      const std::uint64_t all = last - first + 1;
      return all > came ? all - came : 0;
    }
  };
  Numbers datagrams_, states_;
  double since_ = 0.0, loss_ = 0.0;
};

}  // namespace tandem::net
