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

/// Opens the line to a device, or throws; called again and again until it succeeds, from the
/// device's thread. Must not block for long.
using OpenTransport = std::function<std::unique_ptr<ByteTransport>()>;

/// A Novint Falcon. A thread of its own runs the driver and owns the line: it opens it, boots the
/// device, asks it a thousand times a second, and begins anew after a loss. Before it leaves a
/// line, whyever, it tries to take the force away. A force asked for while there was no line does
/// not count. The side that ticks
/// meets that thread in two latest values: read() and write() are wait-free, without lock,
/// allocation or system call.
///
/// Clocks are not mixed. read(now) gives the newest reading, valid as long as its number grows: one
/// that is the newest for more than 20 ms of the caller's own time is not. Its position is older
/// than the first read that sees it by one exchange with the device and one read at most. The
/// force's age is told by the thread's clock from when a write is seen, within a millisecond.
///
/// W is the device's frame D (x right, y up, z to the user) moved to its centre.
class FalconDevice final : public HapticDevice {
 public:
  /// Starts the thread; returns at once. Throws std::invalid_argument as FalconDriver does.
  FalconDevice(const FalconSettings& settings, FirmwareImage image, OpenTransport open);
  /// Takes the force away, frame by frame, puts the lights out and closes the line; 0.2 s at most,
  /// and what the line's own calls take.
  ~FalconDevice() override;
  FalconDevice(const FalconDevice&) = delete;
  FalconDevice& operator=(const FalconDevice&) = delete;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// How it does; for one thread, whichever it is. Wait-free.
  [[nodiscard]] const FalconStatus& status() noexcept;
  /// Of FalconButton, those that are pressed; none while it does not answer. Wait-free, for any
  /// thread.
  [[nodiscard]] std::uint8_t buttons() const noexcept;

 private:
  class [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
