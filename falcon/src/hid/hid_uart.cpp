#include "hid/hid_uart.h"

#include <algorithm>
#include <utility>

#include "tandem/coordination/types.h"
#include "tandem/falcon/monotonic_clock.h"

#include "hid/ft260_reports.h"

namespace tandem {
namespace {

/// Most reports that purge() drops; the kernel buffers 64.
constexpr int kMostPurged = 256;

bool setFeature(HidPort& port, const HidReport& report) noexcept {
  return port.setFeature(report.bytes.data(), report.size);
}

class HidUart final : public ByteTransport {
 public:
  explicit HidUart(std::unique_ptr<HidPort> port) : port_(std::move(port)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return port_->name(); }

  [[nodiscard]] bool write(const std::uint8_t* bytes, std::size_t count) noexcept override {
    while (count > 0) {
      const HidReport report = encodeUartBytes(bytes, count);
      if (!port_->write(report.bytes.data(), report.size)) return false;
      const std::size_t sent = std::min(count, kMostUartBytes);
      bytes += sent;
      count -= sent;
    }
    return true;
  }

  [[nodiscard]] std::ptrdiff_t read(std::uint8_t* bytes, std::size_t room,
                                    double wait) noexcept override {
    if (taken_ == waiting_.count && !fetch(wait)) return -1;
    const std::size_t count = std::min(room, waiting_.count - taken_);
    std::copy_n(waiting_.bytes.begin() + static_cast<std::ptrdiff_t>(taken_), count, bytes);
    taken_ += count;
    return static_cast<std::ptrdiff_t>(count);
  }

  [[nodiscard]] bool setLine(const SerialLine& line) noexcept override {
    if (line.baud < kLeastUartBaud || line.baud > kMostUartBaud) return false;
    return setFeature(*port_, makeUartOn()) &&
           setFeature(*port_, makeUartLine(static_cast<std::uint32_t>(line.baud)));
  }

  void purge() noexcept override {
    waiting_.count = taken_ = 0;
    HidReport report;
    for (int i = 0; i < kMostPurged; ++i)
      if (port_->read(report.bytes.data(), report.bytes.size(), 0.0) <= 0) return;
  }

 private:
  /// Waits up to `wait` [s] for the next report with data; skips the chip's status reports. Returns
  /// false if the device is gone.
  [[nodiscard]] bool fetch(double wait) noexcept {
    waiting_.count = taken_ = 0;
    const double until = readMonotonicClock() + wait;
    HidReport report;
    for (double left = wait;; left = until - readMonotonicClock()) {
      const std::ptrdiff_t size =
          port_->read(report.bytes.data(), report.bytes.size(), std::max(left, 0.0));
      if (size < 0) return false;
      const auto content = decodeUartBytes(report.bytes.data(), static_cast<std::size_t>(size));
      if (content) waiting_ = *content;
      if (content || left <= 0.0) return true;
    }
  }

  std::unique_ptr<HidPort> port_;
  UartBytes waiting_;      ///< bytes of the last report
  std::size_t taken_ = 0;  ///< number of those already read
};

}  // namespace

std::unique_ptr<ByteTransport> makeHidUart(std::unique_ptr<HidPort> port) {
  if (!setFeature(*port, makeUartOn()))
    throw Error(port->name() + " does not become a serial line; give an FT260's interface 1");
  return std::make_unique<HidUart>(std::move(port));
}

void requireFastBridge(const HidAddress& address) {
  if (address.vendor == 0x10C4 && address.product == 0xEA80)
    throw Error("HID " + toText(address) +
                " is a CP2110, which ends at 1 MBd, and a Falcon needs 1.5; use an FT260");
}

}  // namespace tandem
