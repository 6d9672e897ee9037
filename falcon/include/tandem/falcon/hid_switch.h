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

/// How a pedal or button shows in a report.
enum class HidSwitchKind {
  kBits,  ///< any bit of the mask `value` in one byte
  kKey,   ///< the key `value` (usage page 7) among the bytes from there on: most pedals are
          ///< keyboards
  kUsage  ///< the 16-bit usage `value` there, lower byte first: consumer controls
};

/// Where it shows. The default is the first button of a device without identifiers.
struct HidSwitchMap {
  HidSwitchKind kind = HidSwitchKind::kBits;
  int report = 0;        ///< identifier, 0: the device has none
  std::size_t byte = 0;  ///< counted as in the report, its identifier included
  std::uint16_t value = 1;
};

/// The switch in one report; nothing if the report is about something else.
[[nodiscard]] std::optional<bool> readSwitch(const HidSwitchMap& map, const std::uint8_t* report,
                                             std::size_t size) noexcept;

/// A pedal or button on HID, as a clutch or a dead man's switch. What is not known to be pressed is
/// not pressed: unplugged, before its first report, after a report that is too short.
class HidSwitch {
 public:
  /// Throws what `open` throws; std::invalid_argument, naming the value, for a map that no report
  /// can fulfil.
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
