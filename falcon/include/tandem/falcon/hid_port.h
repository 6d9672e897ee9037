#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

class ByteTransport;

/// An identifier and the 64 bytes that a full speed interrupt transfer carries.
inline constexpr std::size_t kMostHidReport = 65;

/// One report as it goes over the line. With identifiers the first byte is one; a report that is
/// sent without them starts with a 0 all the same.
struct HidReport {
  std::array<std::uint8_t, kMostHidReport> bytes{};
  std::size_t size = 0;  ///< 0: there is none
};

/// An open HID device. Never throws once it is made; calls may wait. One thread may read while
/// another writes and uses features; not more.
class HidPort {
 public:
  virtual ~HidPort() = default;

  /// What it is, for messages: "HID 256f:c635 SpaceMouse Compact".
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;

  /// The next input report, after waiting for it up to `wait` [s]: its size, 0 for none, negative
  /// if the device is gone. What is beyond `room` is cut off.
  [[nodiscard]] virtual std::ptrdiff_t read(std::uint8_t* report, std::size_t room,
                                            double wait) noexcept = 0;

  /// Sends an output report. False: the device is gone or does not take it.
  [[nodiscard]] virtual bool write(const std::uint8_t* report, std::size_t size) noexcept = 0;

  /// Sends a feature report. False: the device is gone or does not take it.
  [[nodiscard]] virtual bool setFeature(const std::uint8_t* report, std::size_t size) noexcept = 0;

  /// Asks for the feature report that `report[0]` names: its size, with the identifier; negative:
  /// there is none.
  [[nodiscard]] virtual std::ptrdiff_t getFeature(std::uint8_t* report,
                                                  std::size_t room) noexcept = 0;
};

/// How a HID interface is found; 0, -1 and empty mean any.
struct HidAddress {
  int vendor = 0, product = 0;
  int usage_page = 0, usage = 0;  ///< of its first collection
  int interface_number = -1;      ///< of a USB device with several
  std::string path;               ///< "/dev/hidraw3"
  std::string product_name;       ///< told by findHid(), not asked for
};

/// True if all that `like` names is so.
[[nodiscard]] bool isLike(const HidAddress& found, const HidAddress& like) noexcept;

/// "256f:c635 SpaceMouse Compact (/dev/hidraw3)", as much as is known; "any" if nothing is.
[[nodiscard]] std::string toText(const HidAddress& address);

/// Opens a device anew, at the start and after it was unplugged; throws tandem::Error if it cannot.
using HidOpener = std::function<std::unique_ptr<HidPort>()>;

/// The HID interfaces that are plugged in now and are like that. Needs tandem_devices, as does
/// openHid(). Thread safe.
[[nodiscard]] std::vector<HidAddress> findHid(const HidAddress& like = {});

/// Opens the one at `address.path`, or else the first like it, through hidapi: no kernel driver,
/// but the right to read and write its hidraw node. Throws tandem::Error with the remedy if it is
/// not there or may not be opened. Thread safe.
[[nodiscard]] std::unique_ptr<HidPort> openHid(const HidAddress& address);

/// The serial one of an FT260's two interfaces.
inline const HidAddress kFt260{0x0403, 0x6030, 0, 0, 1, "", ""};

/// Opens it. Throws tandem::Error with the remedy. Needs tandem_devices.
[[nodiscard]] std::unique_ptr<ByteTransport> openHidUart(const HidAddress& address = kFt260);

/// How a HID device is written to, and looked for again after it was unplugged.
struct HidStreamSettings {
  double write_period = 0.0;   ///< [s], > 0; 0: nothing is ever sent
  double first_retry = 0.1;    ///< until an unplugged device is looked for again [s], > 0
  double longest_retry = 2.0;  ///< each try waits twice as long as the last, up to this [s]
};

/// What a HID device and its line have done.
struct HidStreamCounters {
  std::uint64_t reports = 0;       ///< that came
  std::uint64_t refused = 0;       ///< of them, that the client could make nothing of
  std::uint64_t written = 0;       ///< that went out
  std::uint64_t write_misses = 0;  ///< periods without a report, because the last one took longer
  std::uint64_t losses = 0;        ///< times that the device was unplugged
};

}  // namespace tandem
#pragma GCC visibility pop
