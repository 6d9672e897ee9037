#include "novint/firmware_image.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>

#include "tandem/coordination/types.h"

namespace tandem {
namespace {

constexpr std::uint16_t kKey = 0x08AA;
constexpr std::size_t kHighOfEntry = 9, kLowOfEntry = 10;  // words of the head
constexpr std::uint32_t kEndOfMemory = 0x400000;           // in words: addresses have 22 bits
constexpr std::uint32_t kUsualEntry = 0x3F8002;

}  // namespace

BootTableReader::State BootTableReader::take(std::uint8_t byte) noexcept {
  if (isWrong()) return state_;
  if (state_ == State::kDone) return state_ = State::kOverrun;
  const bool is_low = bytes_++ % 2 == 0;
  if (is_low)
    low_ = byte;
  else
    state_ = takeWord(static_cast<std::uint16_t>(byte << 8U | low_));
  return state_;
}

BootTableReader::State BootTableReader::takeWord(std::uint16_t word) noexcept {
  const std::size_t number = bytes_ / 2 - 1;
  switch (part_) {
    case Part::kHead:
      if (number == 0 && word != kKey) return State::kWrongKey;
      if (number == kHighOfEntry) entry_ = static_cast<std::uint32_t>(word) << 16U;
      if (number != kLowOfEntry) return State::kReading;
      entry_ |= word;
      part_ = Part::kSize;
      return entry_ < kEndOfMemory ? State::kReading : State::kWrongAddress;
    case Part::kSize:
      left_ = word;
      part_ = Part::kHigh;
      return word == 0 ? State::kDone : State::kReading;
    case Part::kHigh:
      address_ = static_cast<std::uint32_t>(word) << 16U;
      part_ = Part::kLow;
      return State::kReading;
    case Part::kLow:
      address_ |= word;
      ++blocks_;
      part_ = Part::kData;
      return address_ < kEndOfMemory && left_ <= kEndOfMemory - address_ ? State::kReading
                                                                         : State::kWrongAddress;
    case Part::kData:
      ++words_;
      if (--left_ == 0) part_ = Part::kSize;
      return State::kReading;
  }
  return State::kReading;
}

const char* findFaultOfFirmware(const std::uint8_t* bytes, std::size_t count) noexcept {
  if (count == 0) return "it is empty";
  if (count > kMostFirmware) return "it is larger than 256 KiB";
  BootTableReader table;
  for (std::size_t i = 0; i < count && !table.isWrong(); ++i) table.take(bytes[i]);
  switch (table.state()) {
    case BootTableReader::State::kDone:
      return table.blocks() > 0 ? nullptr : "it holds no program";
    case BootTableReader::State::kReading:
      return "it ends before its boot table does";
    case BootTableReader::State::kWrongKey:
      return "it does not begin with AA 08, the key of a C28x boot table";
    case BootTableReader::State::kWrongAddress:
      return "a block lies outside of the processor's memory";
    case BootTableReader::State::kOverrun:
      return "bytes follow the end of its boot table";
  }
  return nullptr;
}

FirmwareImage readFirmware(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  FirmwareImage image;
  image.bytes.resize(kMostFirmware + 1);
  file.read(reinterpret_cast<char*>(image.bytes.data()),
            static_cast<std::streamsize>(image.bytes.size()));
  if (!file.is_open() || file.bad())
    throw Error(path + ": cannot be read (" + std::strerror(errno) +
                "); give the path of the firmware image that came with your Falcon's software");
  image.bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (const char* fault = findFaultOfFirmware(image.bytes.data(), image.bytes.size()))
    throw Error(path + ": is no firmware image of a Falcon: " + fault +
                "; take the file from your Falcon's software again");
  return image;
}

FirmwareImage makeSyntheticFirmware(std::uint64_t seed, std::size_t words) {
  std::mt19937_64 random(seed);
  FirmwareImage image;
  const auto append = [&image](std::uint32_t word) {
    image.bytes.push_back(static_cast<std::uint8_t>(word));
    image.bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  };
  words = std::clamp<std::size_t>(words, 1, 0x7FFD);  // up to the end of memory
  append(kKey);
  for (int i = 0; i < 8; ++i) append(0);
  append(kUsualEntry >> 16U);
  append(kUsualEntry);
  append(static_cast<std::uint32_t>(words));
  append(kUsualEntry >> 16U);
  append(kUsualEntry);
  for (std::size_t i = 0; i < words; ++i) append(static_cast<std::uint32_t>(random()));
  append(0);
  return image;
}

}  // namespace tandem
