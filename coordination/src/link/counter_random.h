#pragma once

#include <cstdint>

namespace tandem {

/// Bijective mix of 64 bits: each input bit flips each output bit with a probability of about one
/// half. Source: the finaliser of splitmix64 (Steele, Lea & Flood 2014; Stafford's mix 13).
[[nodiscard]] constexpr std::uint64_t scrambleBits(std::uint64_t bits) noexcept {
  bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9U;
  bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBU;
  return bits ^ (bits >> 31U);
}

/// Number `counter` of the random stream (`seed`, `direction`, `stream`), uniform in [0, 1).
///
/// A counter replaces a generator's state: a draw depends on its arguments alone. Draws from one
/// stream never shift another. Pure; real-time safe.
[[nodiscard]] constexpr double drawUniform(std::uint64_t seed, std::uint64_t direction,
                                           std::uint64_t stream, std::uint64_t counter) noexcept {
  constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;  // keeps small inputs away from 0
  std::uint64_t bits = scrambleBits(seed + kGoldenRatio);
  bits = scrambleBits((bits ^ direction) + kGoldenRatio);
  bits = scrambleBits((bits ^ stream) + kGoldenRatio);
  bits = scrambleBits((bits ^ counter) + kGoldenRatio);
  return static_cast<double>(bits >> 11U) * 0x1p-53;  // the 53 bits of a double's mantissa
}

}  // namespace tandem
