#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "tandem/falcon/hid_port.h"

#pragma GCC visibility push(default)
namespace tandem {

class HidStream;

/// Encoding of a pedal or button in a report.
enum class HidSwitchKind {
  kBits,  ///< on if any bit of the mask `value` is set in one byte
  kKey,   ///< on if key `value` (usage page 7) is among the bytes from `byte` on; most pedals
  kUsage  ///< on if the 16-bit usage at `byte` is `value`, lower byte first: consumer controls
};

/// Place of the switch in a report. The default is the first button of a device without
/// identifiers.
struct HidSwitchMap {
  HidSwitchKind kind = HidSwitchKind::kBits;
  int report = 0;        ///< identifier of the report; 0: the device has none
  std::size_t byte = 0;  ///< index in the report, counted with the identifier
  std::uint16_t value = 1;
};

/// State of the switch in one report; empty if the report does not carry the switch.
[[nodiscard]] std::optional<bool> readSwitch(const HidSwitchMap& map, const std::uint8_t* report,
                                             std::size_t size) noexcept;

/// A pedal or button on HID, used as a clutch or a dead-man switch. It counts as not pressed in
/// doubt: when unplugged, before the first report and after a report that is too short.
class HidSwitch {
 public:
  /// Throws what `open` throws. Throws std::invalid_argument with the value's name for a map that
  /// no report can match.
  HidSwitch(HidOpener open, const HidSwitchMap& map, const HidStreamSettings& settings = {});
  ~HidSwitch();

  /// Wait-free, for any thread.
  [[nodiscard]] bool isPressed() const noexcept;
  [[nodiscard]] const HidStream& stream() const noexcept { return *stream_; }

 private:
  class Client;

  std::unique_ptr<Client> client_;  // outlives the stream
  std::unique_ptr<HidStream> stream_;
};

}  // namespace tandem
#pragma GCC visibility pop
