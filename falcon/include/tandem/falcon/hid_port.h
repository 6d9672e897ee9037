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

/// Largest report: the identifier and the 64 bytes of a full-speed interrupt transfer.
inline constexpr std::size_t kMostHidReport = 65;

/// One report as sent over the line. The first byte is the identifier; it is 0 for devices without
/// identifiers.
struct HidReport {
  std::array<std::uint8_t, kMostHidReport> bytes{};
  std::size_t size = 0;  ///< [bytes]; 0: no report
};

/// An open HID device. No call throws once it is open; calls may wait. One thread may read while
/// another one writes and uses features.
class HidPort {
 public:
  virtual ~HidPort() = default;

  /// Name for messages: "HID 256f:c635 SpaceMouse Compact".
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;

  /// Waits up to `wait` [s] for the next input report and returns its size. Returns 0 if none came,
  /// a negative number if the device is gone. Cuts off what exceeds `room`.
  [[nodiscard]] virtual std::ptrdiff_t read(std::uint8_t* report, std::size_t room,
                                            double wait) noexcept = 0;

  /// Sends an output report. Returns false if the device is gone or refuses it.
  [[nodiscard]] virtual bool write(const std::uint8_t* report, std::size_t size) noexcept = 0;

  /// Sends a feature report. Returns false if the device is gone or refuses it.
  [[nodiscard]] virtual bool setFeature(const std::uint8_t* report, std::size_t size) noexcept = 0;

  /// Requests the feature report with identifier `report[0]`. Returns its size with the identifier,
  /// or a negative number if there is none.
  [[nodiscard]] virtual std::ptrdiff_t getFeature(std::uint8_t* report,
                                                  std::size_t room) noexcept = 0;
};

/// Search pattern for a HID interface; 0, -1 and empty match any.
struct HidAddress {
  int vendor = 0, product = 0;
  int usage_page = 0, usage = 0;  ///< of the interface's first collection
  int interface_number = -1;      ///< for USB devices with several interfaces
  std::string path;               ///< "/dev/hidraw3"
  std::string product_name;       ///< filled in by findHid(); not part of the search
};

/// True if every field that `like` sets matches `found`.
[[nodiscard]] bool isLike(const HidAddress& found, const HidAddress& like) noexcept;

/// Text of the known fields, "256f:c635 SpaceMouse Compact (/dev/hidraw3)"; "any" if none is known.
[[nodiscard]] std::string toText(const HidAddress& address);

/// Opens a device at the start and again after it was unplugged. Throws tandem::Error on failure.
using HidOpener = std::function<std::unique_ptr<HidPort>()>;

/// Lists the HID interfaces plugged in now that match `like`. Thread safe. Needs tandem_devices, as
/// does openHid().
[[nodiscard]] std::vector<HidAddress> findHid(const HidAddress& like = {});

/// Opens `address.path`, or else the first interface that matches, through hidapi. Needs the right
/// to read and write its hidraw node, but no kernel driver. Throws tandem::Error with the remedy on
/// failure. Thread safe.
[[nodiscard]] std::unique_ptr<HidPort> openHid(const HidAddress& address);

/// The serial one of an FT260's two interfaces.
inline const HidAddress kFt260{0x0403, 0x6030, 0, 0, 1, "", ""};

/// Opens the bridge as a serial line. Throws tandem::Error with the remedy. Needs tandem_devices.
[[nodiscard]] std::unique_ptr<ByteTransport> openHidUart(const HidAddress& address = kFt260);

/// Write period of a HID device, and pauses before it is reopened after unplugging.
struct HidStreamSettings {
  double write_period = 0.0;   ///< time between reports to the device [s], > 0; 0: never writes
  double first_retry = 0.1;    ///< pause before the first attempt to reopen [s], > 0
  double longest_retry = 2.0;  ///< longest pause [s]; the pause doubles after each attempt
};

/// Counters of a HID device and its line.
struct HidStreamCounters {
  std::uint64_t reports = 0;       ///< input reports received
  std::uint64_t refused = 0;       ///< received reports that the client could not use
  std::uint64_t written = 0;       ///< output reports sent
  std::uint64_t write_misses = 0;  ///< periods without a report, because the last write took longer
  std::uint64_t losses = 0;        ///< times that the device was unplugged
};

}  // namespace tandem
#pragma GCC visibility pop
