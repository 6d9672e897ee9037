#pragma once

#include <cstdint>

#include "secure/seal.h"

namespace tandem::secure {

/// Limits after which a pair of sites needs new keys. Times of WireGuard (Donenfeld 2017, section
/// 6.1).
struct RekeyLimits {
  double due_after = 120.0;     ///< age at which a new handshake begins [s]
  double refuse_after = 180.0;  ///< age from which keys neither seal nor open [s]
  /// Sealed datagrams at which a new handshake begins: 1000 s before kSealLimit at 1 kHz, so that
  /// the link does not stop.
  std::uint64_t due_packets = kSealLimit - (std::uint64_t{1} << 20);
  std::uint64_t refuse_packets = kSealLimit;
};

/// Action for the keys of one epoch.
enum class KeyAge {
  kGood,     ///< use them
  kDue,      ///< use them and begin a handshake
  kExpired,  ///< neither seal nor open with them
};

/// Age of the keys of one epoch. The caller passes the time. Pure; real-time safe.
class RekeyPolicy {
 public:
  /// `born` is the end of the handshake [s], on the same clock as `now`.
  explicit constexpr RekeyPolicy(double born, const RekeyLimits& limits = {}) noexcept
      : born_(born), limits_(limits) {}

  /// `packets` counts the datagrams sealed under these keys. A NaN time makes them expired.
  [[nodiscard]] constexpr KeyAge age(double now, std::uint64_t packets) const noexcept {
    const double age = now - born_;
    if (!(age < limits_.refuse_after) || packets >= limits_.refuse_packets) return KeyAge::kExpired;
    if (age >= limits_.due_after || packets >= limits_.due_packets) return KeyAge::kDue;
    return KeyAge::kGood;
  }

 private:
  double born_;
  RekeyLimits limits_;
};

}  // namespace tandem::secure
