#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <sodium.h>

namespace tandem::secure {

using ByteView = std::span<const std::uint8_t>;
using Bytes = std::span<std::uint8_t>;

/// Short-lived secret bytes on the stack; the destructor wipes them.
template <std::size_t kSize>
struct WipedBytes : std::array<std::uint8_t, kSize> {
  WipedBytes() noexcept : std::array<std::uint8_t, kSize>{} {}
  ~WipedBytes() { sodium_memzero(this->data(), kSize); }
  WipedBytes(const WipedBytes&) = delete;
  WipedBytes& operator=(const WipedBytes&) = delete;
};

}  // namespace tandem::secure
