#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

/// How a serial line is set; a Falcon knows by it what it is expected to be.
struct SerialLine {
  int baud = 9600;      ///< [Bd], with 8 data bits, no parity, one stop bit, no flow control
  int latency_ms = 16;  ///< after which an FTDI chip sends what it has [ms]
  bool dtr = false;     ///< modem control line: high
  bool rts = false;     ///< the other one
};

/// A line to a device that carries bytes both ways: USB, a tty, a HID bridge or memory. Never
/// throws once it is made. One thread uses it, not the haptic one: calls may wait.
class ByteTransport {
 public:
  virtual ~ByteTransport() = default;

  /// What it is, for messages: "FTDI 0403:cb48 FTPNM0FB", "/dev/ttyUSB0".
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;

  /// Sends all of it. False: the device is gone, or does not take it within a tenth of a second.
  [[nodiscard]] virtual bool write(const std::uint8_t* bytes, std::size_t count) noexcept = 0;

  /// What has come, up to `room` bytes, after waiting for the first of it up to `wait` [s]. 0:
  /// nothing has; negative: the device is gone. One on USB may take a little longer: openFtdi.
  [[nodiscard]] virtual std::ptrdiff_t read(std::uint8_t* bytes, std::size_t room,
                                            double wait) noexcept = 0;

  /// DTR and RTS first, then the speed. False: the line cannot be set so; lines that have no such
  /// wire leave it out.
  [[nodiscard]] virtual bool setLine(const SerialLine& line) noexcept = 0;

  /// Forgets what has come, and what is not sent yet.
  virtual void purge() noexcept = 0;
};

/// Opens a serial line of the kernel, such as /dev/ttyUSB0 or a pseudo terminal, for this program
/// alone. Any speed is set (termios2); DTR, RTS and the latency time are left out where the line
/// has none. Throws tandem::Error with the remedy if it cannot be opened. Linux.
[[nodiscard]] std::unique_ptr<ByteTransport> openTty(const std::string& path);

/// A device behind an FTDI chip on USB.
struct FtdiAddress {
  int vendor = 0x0403, product = 0xCB48;  ///< of a Novint Falcon
  std::string serial;                     ///< empty: the first there is
};

/// Those plugged in now, with their serial numbers; one that may not be opened has none.
[[nodiscard]] std::vector<FtdiAddress> findFtdi(const FtdiAddress& like = {});

/// Opens it through libftdi1, in user space: no kernel driver, but the right to open the USB
/// device. A tty that ftdi_sio made for it goes away. Reads take one transfer of USB at least,
/// which ends at the latest after the line's latency time, also without a wait. Throws
/// tandem::Error with the remedy if it is not there or cannot be opened.
[[nodiscard]] std::unique_ptr<ByteTransport> openFtdi(const FtdiAddress& address = {});

}  // namespace tandem
#pragma GCC visibility pop
