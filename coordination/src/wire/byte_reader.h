#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "wire/little_endian.h"
#include "wire/wire.h"

namespace tandem::wire {

/// Reads little-endian numbers in sequence. Behind the end every read gives zero. Callers check the
/// size first; this only keeps a bug from reading other memory.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) noexcept : at_(bytes.data), left_(bytes.size) {}

  template <class Unsigned>
  [[nodiscard]] Unsigned read() noexcept {
    if (left_ < sizeof(Unsigned)) return 0;
    const auto value = loadLittleEndian<Unsigned>(at_);
    skip(sizeof(Unsigned));
    return value;
  }

  [[nodiscard]] std::int64_t readTime() noexcept {
    return static_cast<std::int64_t>(read<std::uint64_t>());
  }

  [[nodiscard]] double readDouble() noexcept {
    return std::bit_cast<double>(read<std::uint64_t>());
  }
  [[nodiscard]] float readFloat() noexcept { return std::bit_cast<float>(read<std::uint32_t>()); }

  template <std::size_t kCount>
  void readInto(std::array<std::uint8_t, kCount>& bytes) noexcept {
    if (left_ < kCount) return;
    std::copy(at_, at_ + kCount, bytes.begin());
    skip(kCount);
  }

  [[nodiscard]] bool hasOnlyZeros() const noexcept {
    return std::all_of(at_, at_ + left_, [](std::uint8_t byte) { return byte == 0; });
  }

  /// True if at least `count` bytes are left.
  [[nodiscard]] bool has(std::size_t count) const noexcept { return left_ >= count; }

  /// The next `count` bytes as text; empty if fewer are left.
  [[nodiscard]] std::string_view readText(std::size_t count) noexcept {
    if (!has(count)) return {};
    const std::string_view text(reinterpret_cast<const char*>(at_), count);
    skip(count);
    return text;
  }

  [[nodiscard]] std::size_t left() const noexcept { return left_; }

 private:
  void skip(std::size_t count) noexcept {
    at_ += count;
    left_ -= count;
  }

  const std::uint8_t* at_;
  std::size_t left_;
};

}  // namespace tandem::wire
