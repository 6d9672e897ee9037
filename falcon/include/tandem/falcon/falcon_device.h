#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/falcon_settings.h"
#include "tandem/falcon/falcon_status.h"
#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Opens the line to a device, or throws. The device's thread calls it until it succeeds. Must not
/// block for long.
using OpenTransport = std::function<std::unique_ptr<ByteTransport>()>;

/// A Novint Falcon. Its own thread owns the line and runs the driver. The thread opens the line,
/// boots the device, polls it at 1 kHz and starts again after a loss. Before it closes a line it
/// tries to send zero force. Forces written while there was no line are ignored.
///
/// read() and write() exchange two latest values with that thread. They are wait-free: no lock,
/// allocation or system call.
///
/// The two clocks are never mixed. read(now) returns the newest reading. It is valid until the same
/// reading has been the newest for 20 ms of the caller's time. A position is at most one exchange
/// and one read older than the first read that returns it. The age of the force is measured by the
/// thread's clock, from when it sees a write, within 1 ms.
///
/// W is the device's frame D (x right, y up, z to the user) with its origin at the device's centre.
class FalconDevice final : public HapticDevice {
 public:
  /// Starts the thread and returns at once. Throws std::invalid_argument as FalconDriver does.
  FalconDevice(const FalconSettings& settings, FirmwareImage image, OpenTransport open);
  /// Ramps the force to zero, turns the lights off and closes the line. Takes at most 0.2 s plus
  /// the time of the line's own calls.
  ~FalconDevice() override;
  FalconDevice(const FalconDevice&) = delete;
  FalconDevice& operator=(const FalconDevice&) = delete;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// Status of the device. Wait-free. Only one thread may call it, any one.
  [[nodiscard]] const FalconStatus& status() noexcept;
  /// Pressed buttons as bits of FalconButton; 0 while the device does not answer. Wait-free, for
  /// any thread.
  [[nodiscard]] std::uint8_t buttons() const noexcept;

 private:
  class [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
