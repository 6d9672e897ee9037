#pragma once

#include <cstdint>

#include "secure/seal.h"

namespace tandem::secure {

/// When a pair of sites needs new keys. WireGuard's times (Donenfeld 2017, section 6.1).
struct RekeyLimits {
  double due_after = 120.0;     ///< age at which a new handshake begins [s]
  double refuse_after = 180.0;  ///< age from which nothing is sealed or opened any more [s]
  /// Datagrams sealed until a new handshake begins: before kSealLimit by 1000 s at 1 kHz, so that
  /// the link does not stand still meanwhile.
  std::uint64_t due_packets = kSealLimit - (std::uint64_t{1} << 20);
  std::uint64_t refuse_packets = kSealLimit;
};

/// What to do with the keys of one epoch.
enum class KeyAge {
  kGood,     ///< use them
  kDue,      ///< use them, and begin a handshake
  kExpired,  ///< neither seal nor open with them
};

/// Age of the keys of one epoch, from the time that is told. Pure; real-time safe.
class RekeyPolicy {
 public:
  /// `born`: when the handshake was complete [s], on the clock that `now` is read from later.
  explicit constexpr RekeyPolicy(double born, const RekeyLimits& limits = {}) noexcept
      : born_(born), limits_(limits) {}

  /// `packets`: sealed under these keys so far. A time that is no number makes them expired.
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
