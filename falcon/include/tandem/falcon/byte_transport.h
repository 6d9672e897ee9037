#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

/// Settings of a serial line. A Falcon's boot loader and its firmware expect different ones.
struct SerialLine {
  int baud = 9600;      ///< [Bd]; 8 data bits, no parity, one stop bit, no flow control
  int latency_ms = 16;  ///< an FTDI chip sends a partial transfer after this [ms]
  bool dtr = false;     ///< level of the modem control line DTR: true is high
  bool rts = false;     ///< level of the modem control line RTS
};

/// A line that carries bytes to and from a device: USB, a tty, a HID bridge or memory. No call
/// throws once the line is open. One thread uses it, never the haptic one, because calls may wait.
class ByteTransport {
 public:
  virtual ~ByteTransport() = default;

  /// Name for messages: "FTDI 0403:cb48 FTPNM0FB", "/dev/ttyUSB0".
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;

  /// Sends all bytes. Returns false if the device is gone or takes longer than 0.1 s.
  [[nodiscard]] virtual bool write(const std::uint8_t* bytes, std::size_t count) noexcept = 0;

  /// Waits up to `wait` [s] for the first byte, then returns the number of bytes read, at most
  /// `room`. Returns 0 if nothing came, a negative number if the device is gone. USB may wait a
  /// little longer than `wait`: see openFtdi().
  [[nodiscard]] virtual std::ptrdiff_t read(std::uint8_t* bytes, std::size_t room,
                                            double wait) noexcept = 0;

  /// Sets DTR and RTS, then the speed. Returns false if the line refuses. Lines without these wires
  /// skip DTR and RTS.
  [[nodiscard]] virtual bool setLine(const SerialLine& line) noexcept = 0;

  /// Discards received bytes that are not read yet, and bytes that are not sent yet.
  virtual void purge() noexcept = 0;
};

/// Opens a serial line of the kernel, such as /dev/ttyUSB0 or a pseudo terminal, with exclusive
/// access. Sets any speed (termios2). Skips DTR, RTS and the latency time where the line has none.
/// Throws tandem::Error with the remedy if it cannot be opened. Linux only.
[[nodiscard]] std::unique_ptr<ByteTransport> openTty(const std::string& path);

/// A device behind an FTDI chip on USB.
struct FtdiAddress {
  int vendor = 0x0403, product = 0xCB48;  ///< USB identifiers; the default is a Novint Falcon
  std::string serial;                     ///< empty: the first device found
};

/// Lists the devices plugged in now with their serial numbers. The serial is empty where the
/// program may not open the device.
[[nodiscard]] std::vector<FtdiAddress> findFtdi(const FtdiAddress& like = {});

/// Opens the device through libftdi1 in user space. Needs the right to open the USB device, but no
/// kernel driver. A tty that ftdi_sio made for the device goes away. A read takes at least one USB
/// transfer, which ends within the line's latency time, even if `wait` is 0. Throws tandem::Error
/// with the remedy if the device is missing or cannot be opened.
[[nodiscard]] std::unique_ptr<ByteTransport> openFtdi(const FtdiAddress& address = {});

}  // namespace tandem
#pragma GCC visibility pop
