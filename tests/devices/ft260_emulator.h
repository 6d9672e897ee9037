#pragma once

#include <optional>

#include "devices/fake_hid_port.h"
#include "falcon/src/novint/falcon_frames.h"

namespace tandem::test {

/// The bytes of an FT260 whose serial line answers each Falcon command with the command's own
/// motors as counts. Written from the chip's documents, not with ft260_reports.h.
class Ft260Emulator {
 public:
  /// Takes a feature report.
  void take(const Bytes& feature) {
    if (feature == Bytes{0xA1, 0x03, 0x04}) is_on_ = true;
    if (feature.size() == 11 && feature[0] == 0xA1 && feature[1] == 0x41)
      baud_ = feature[3] | feature[4] << 8 | feature[5] << 16 | feature[6] << 24;
  }
  [[nodiscard]] bool isOn() const { return is_on_; }
  [[nodiscard]] int baud() const { return baud_; }

  /// Input reports that an output report causes. With `in_pieces` bytes come one by one.
  std::vector<Bytes> answer(const Bytes& output, bool in_pieces = false) {
    std::vector<Bytes> inputs;
    if (!is_on_ || output.size() < 3 || output[0] < 0xF0 || output[0] > 0xFE) return inputs;
    for (std::size_t i = 2; i < 2U + output[1]; ++i) {
      const auto frame = reader_.take(output.at(i));
      const auto command = frame ? decodeCommand(*frame) : std::nullopt;
      if (!command) continue;
      const FalconFrame reply = encodeReply({command->motors, 7, 0});
      if (in_pieces)
        for (const std::uint8_t byte : reply) inputs.push_back({0xF0, 1, byte, 0, 0, 0});
      else
        inputs.push_back(wrap(reply));
    }
    return inputs;
  }

 private:
  static Bytes wrap(const FalconFrame& frame) {
    Bytes report = {0xF3, 16};
    report.insert(report.end(), frame.begin(), frame.end());
    return report;
  }

  FalconFrameReader reader_;
  bool is_on_ = false;
  int baud_ = 0;
};

}  // namespace tandem::test
