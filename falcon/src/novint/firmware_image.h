#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tandem/falcon/falcon_settings.h"

/// \file
/// The program that a Falcon needs at every power-up. It belongs to Novint; Tandem contains none.
/// It is a boot table of the C28x processor, in 16-bit words, low byte first:
///
///     0x08AA | 8 reserved | entry, high and low | size, high, low, data... | ... | size 0
namespace tandem {

/// Parses a boot table byte by byte. The host and the emulator share it.
class BootTableReader {
 public:
  enum class State : std::uint8_t {
    kReading,
    kDone,          ///< the table is complete
    kWrongKey,      ///< the first word is not 0x08AA
    kWrongAddress,  ///< a block or the entry lies outside of 22-bit memory
    kOverrun        ///< bytes follow the end
  };

  /// Takes the next byte. An error state is final.
  State take(std::uint8_t byte) noexcept;
  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] bool isWrong() const noexcept {
    return state_ != State::kReading && state_ != State::kDone;
  }

  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }  ///< taken so far
  [[nodiscard]] std::uint32_t entry() const noexcept { return entry_; }
  [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }
  [[nodiscard]] std::size_t words() const noexcept { return words_; }  ///< words of data

 private:
  State takeWord(std::uint16_t word) noexcept;

  enum class Part : std::uint8_t { kHead, kSize, kHigh, kLow, kData };
  State state_ = State::kReading;
  Part part_ = Part::kHead;
  std::size_t bytes_ = 0, blocks_ = 0, words_ = 0;
  std::uint32_t entry_ = 0, address_ = 0, left_ = 0;
  std::uint8_t low_ = 0;
};

inline constexpr std::size_t kMostFirmware = 256 * 1024;  ///< [bytes]; known images have 8 KiB

/// Describes the fault of `bytes` as an image; nullptr if there is none. Pure.
[[nodiscard]] const char* findFaultOfFirmware(const std::uint8_t* bytes,
                                              std::size_t count) noexcept;

}  // namespace tandem
