#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace tandem {

/// FNV-1a hash, 64 bits.
class Fnv {
 public:
  /// Adds 64 bits at once.
  void addWord(std::uint64_t word) noexcept { value_ = (value_ ^ word) * 0x100000001b3u; }
  void addWord(double number) noexcept { addWord(std::bit_cast<std::uint64_t>(number)); }
  /// Adds byte after byte, as the definition has it.
  void addBytes(const void* bytes, std::size_t size) noexcept {
    const auto* const begin = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < size; ++i) addWord(std::uint64_t{begin[i]});
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace tandem
