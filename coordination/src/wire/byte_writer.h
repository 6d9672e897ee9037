#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "tandem_assert.h"
#include "wire/little_endian.h"
#include "wire/wire.h"

namespace tandem::wire {

/// Writes little-endian numbers in sequence; the caller has checked that the room suffices.
class ByteWriter {
 public:
  explicit ByteWriter(ByteSpan out) noexcept : begin_(out.data), at_(out.data), room_(out.size) {}

  template <class Unsigned>
  void write(Unsigned value) noexcept {
    storeLittleEndian(value, advance(sizeof(Unsigned)));
  }

  void write(std::int64_t value) noexcept { write(static_cast<std::uint64_t>(value)); }
  void write(float value) noexcept { write(std::bit_cast<std::uint32_t>(value)); }
  void write(double value) noexcept { write(std::bit_cast<std::uint64_t>(value)); }

  void writeZeros(std::size_t count) noexcept { std::memset(advance(count), 0, count); }

  template <class Bytes>
  void writeBytes(const Bytes& bytes) noexcept {
    if (bytes.size() > 0) std::memcpy(advance(bytes.size()), bytes.data(), bytes.size());
  }

  /// Writes the length in one byte, then the text.
  void writeText(std::string_view text) noexcept {
    write(static_cast<std::uint8_t>(text.size()));
    writeBytes(text);
  }

  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(at_ - begin_); }

 private:
  std::uint8_t* advance(std::size_t count) noexcept {
    TANDEM_ASSERT(size() + count <= room_);
    std::uint8_t* const from = at_;
    at_ += count;
    return from;
  }

  std::uint8_t* begin_;
  std::uint8_t* at_;
  [[maybe_unused]] std::size_t room_;
};

}  // namespace tandem::wire
