#pragma once

#include <utility>

#include "tandem/coordination/link.h"
#include "tandem/falcon/haptic_device.h"
#include "tandem/plugin/recording.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Device that replays the samples of a recording, one per tick. The recording must outlive it.
class ReplayDevice final : public HapticDevice {
 public:
  /// `capabilities` are those of the recorded device: its force limit affected the rendered force.
  explicit ReplayDevice(const Recording& recording, DeviceCapabilities capabilities = {"replay"})
      : recording_(recording), capabilities_(std::move(capabilities)) {}
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  /// Returns the first recorded sample at or after `now`; an invalid one after the end.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3&) noexcept override {}

 private:
  const Recording& recording_;
  DeviceCapabilities capabilities_;
  std::size_t next_ = 0;
};

/// Link that replays the recorded packets of one remote at their times. It discards what is sent.
class ReplayLink final : public Link {
 public:
  ReplayLink(const Recording& recording, int remote) : recording_(recording), remote_(remote) {}
  void send(const StatePacket&, double) noexcept override {}
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  const Recording& recording_;
  int remote_;
  std::size_t next_ = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
