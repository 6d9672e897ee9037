#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <sodium.h>

namespace tandem::secure {

using ByteView = std::span<const std::uint8_t>;
using Bytes = std::span<std::uint8_t>;

/// Secret bytes of a short life, on the stack: wiped at their end.
template <std::size_t kSize>
struct WipedBytes : std::array<std::uint8_t, kSize> {
  WipedBytes() noexcept : std::array<std::uint8_t, kSize>{} {}
  ~WipedBytes() { sodium_memzero(this->data(), kSize); }
  WipedBytes(const WipedBytes&) = delete;
  WipedBytes& operator=(const WipedBytes&) = delete;
};

/// Appends a number's bytes, lowest first; returns where the next goes.
template <typename Unsigned>
constexpr std::uint8_t* putLittleEndian(std::uint8_t* to, Unsigned value) noexcept {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    *to++ = static_cast<std::uint8_t>(value >> (8 * i));
  return to;
}

}  // namespace tandem::secure
