#pragma once

#include <utility>

#include "tandem/coordination/link.h"
#include "tandem/falcon/haptic_device.h"
#include "tandem/plugin/recording.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A device that gives a recording's samples again, one per tick. The recording must outlive it.
class ReplayDevice final : public HapticDevice {
 public:
  /// `capabilities`: of the recorded device, as its force limit is part of what was rendered.
  explicit ReplayDevice(const Recording& recording, DeviceCapabilities capabilities = {"replay"})
      : recording_(recording), capabilities_(std::move(capabilities)) {}
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  /// The first recorded sample at or after `now`; invalid after the end.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3&) noexcept override {}

 private:
  const Recording& recording_;
  DeviceCapabilities capabilities_;
  std::size_t next_ = 0;
};

/// A link that delivers a recording's packets of one remote again, at the same times; sends go
/// nowhere.
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
