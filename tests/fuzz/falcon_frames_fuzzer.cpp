// Bytes from a Falcon, or to one, for all their readers: the frame reader, the boot, the check of
// firmware images, the driver and the emulator. Each frame found encodes to itself.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "falcon/src/novint/falcon_driver.h"
#include "falcon/src/novint/falcon_emulator.h"

namespace tandem {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// The meaning of byte 14 is unknown.
bool isSameBut14(FalconFrame a, const FalconFrame& b) {
  a[14] = b[14];
  return a == b;
}

void readFrames(const std::uint8_t* bytes, std::size_t count) {
  FalconFrameReader reader;
  for (std::size_t i = 0; i < count; ++i) {
    const auto frame = reader.take(bytes[i]);
    const std::uint64_t gone = kFalconFrameSize * reader.frames() + reader.dropped();
    require(gone <= i + 1 && i + 1 - gone < kFalconFrameSize);  // bytes that the reader still holds
    if (!frame) continue;
    require(isFrame(*frame));
    const auto reply = decodeReply(*frame);
    require(reply && isSameBut14(encodeReply(*reply), *frame));
    const auto command = decodeCommand(*frame);
    if (command) require(isSameBut14(encodeCommand(*command), *frame));
    require(readCommand(*frame).motors == reply->counts);
  }
}

void checkImage(const std::uint8_t* bytes, std::size_t count) {
  BootTableReader table;
  for (std::size_t i = 0; i < count; ++i) {
    const bool was_wrong = table.isWrong();
    table.take(bytes[i]);
    require(!was_wrong || table.isWrong());
    require(2 * table.words() <= table.bytes());
  }
  const char* fault = findFaultOfFirmware(bytes, count);
  if (count > 0 && count <= kMostFirmware && table.blocks() > 0)
    require((fault == nullptr) == (table.state() == BootTableReader::State::kDone));
}

/// The input comes in pieces whose sizes and times come from its bytes; both ends run at once.
template <typename Take>
void inPieces(const std::uint8_t* bytes, std::size_t count, const Take& take) {
  double now = 1.0;
  for (std::size_t i = 0; i < count;) {
    const std::size_t size = std::min<std::size_t>(1 + bytes[i] % 37, count - i);
    take(bytes + i, size, now);
    now += 0.0002 * (bytes[i] % 64);
    i += size;
  }
}

void boot(const std::uint8_t* bytes, std::size_t count) {
  FalconBoot boot(makeSyntheticFirmware(1, 8));
  boot.start(1.0);
  inPieces(bytes, count, [&](const std::uint8_t* piece, std::size_t size, double now) {
    boot.take(piece, size, now);
    const LineStep step = boot.advance(now);
    require(step.count <= step.bytes.size() && boot.loaded() <= boot.size());
  });
}

/// The driver accepts the bytes, is asked for far too much force, and stays within its limits.
void drive(const std::uint8_t* bytes, std::size_t count) {
  FalconSettings settings;
  settings.force.ramp_in = 0.0;
  FalconDriver driver(settings);
  driver.connect(1.0);
  (void)driver.advance(1.0);
  const FalconFrame reply = encodeReply({{-200, -200, -200}, 7, 0});
  driver.take(reply.data(), reply.size(), 1.0);
  inPieces(bytes, count, [&](const std::uint8_t* piece, std::size_t size, double now) {
    driver.command(Vec3(1e9, -1e9, 3.0), now);
    driver.take(piece, size, now);
    const LineStep step = driver.advance(now);
    require(step.count <= step.bytes.size());
    const auto& f = driver.status().force_D;
    require(std::hypot(f[0], f[1], f[2]) <= 8.0 * (1.0 + 1e-9));
    const FalconReading& reading = driver.reading();
    require(!reading.is_valid || driver.status().state == FalconState::kReady);
    for (std::size_t i = 0; i < 3; ++i)
      require(std::abs(reading.p[i]) < 0.5 && std::abs(reading.v[i]) <= 4.0);
  });
}

void emulate(const std::uint8_t* bytes, std::size_t count) {
  FalconEmulatorSettings settings;
  settings.runs = count % 2 == 0;
  settings.overrange = count % 4 < 2 ? FalconOverrange::kClamp : FalconOverrange::kIgnore;
  FalconEmulator emulator(settings);
  emulator.setLine({settings.runs ? 1500000 : 9600, 1, true, false});
  inPieces(bytes, count, [&](const std::uint8_t* piece, std::size_t size, double now) {
    emulator.take(piece, size, now);
    if (!settings.runs)
      emulator.setLine({piece[0] % 2 ? 140000 : 9600, 1, piece[0] % 4 > 1, false});
    std::uint8_t out[128];
    (void)emulator.collect(out, sizeof out, now);
    require(emulator.plant().position().allFinite());
    for (const std::int16_t motor : emulator.command().motors)
      require(std::abs(motor) <= kMostMotor);
  });
}

}  // namespace
}  // namespace tandem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tandem::readFrames(data, size);
  tandem::checkImage(data, size);
  tandem::boot(data, size);
  tandem::drive(data, size);
  tandem::emulate(data, size);
  return 0;
}
