#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tandem::wire {

/// Converts between native and little-endian byte order.
template <class Unsigned>
[[nodiscard]] constexpr Unsigned swapToLittleEndian(Unsigned value) noexcept {
  static_assert(std::is_unsigned_v<Unsigned>);
  if constexpr (std::endian::native == std::endian::little) {
    return value;
  } else {
    Unsigned swapped = 0;
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
      swapped = static_cast<Unsigned>(swapped << 8 | (value & 0xff));
      value = static_cast<Unsigned>(value >> 8);
    }
    return swapped;
  }
}

template <class Unsigned>
void storeLittleEndian(Unsigned value, std::uint8_t* bytes) noexcept {
  value = swapToLittleEndian(value);
  std::memcpy(bytes, &value, sizeof value);
}

template <class Unsigned>
[[nodiscard]] Unsigned loadLittleEndian(const std::uint8_t* bytes) noexcept {
  Unsigned value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return swapToLittleEndian(value);
}

}  // namespace tandem::wire
