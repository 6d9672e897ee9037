#pragma once

#include <deque>

#include "tandem/coordination/link.h"
#include "tandem/falcon/haptic_device.h"
#include "tandem/plugin/site.h"

#include "bench/speed/speed_world.h"

namespace tandem::demos::bench {

/// A scene with a site in a host at 60 Hz: a device, and remote users whose packets come 128 times
/// per second.
class SpeedSite {
 public:
  static constexpr double kHapticRate = 1000.0, kHostRate = 60.0;  // [Hz]

  explicit SpeedSite(const SpeedScene& scene);

  /// Runs the next haptic tick. Ticks of a host step come before it.
  void tick() { site_.tick(now()); }
  /// Runs the ticks that begin before `end` [s]; returns their number.
  int tickUntil(double end);
  void stepHost() { world_.step(1.0 / kHostRate); }
  [[nodiscard]] const Site& site() const { return site_; }

 private:
  class PathDevice final : public HapticDevice {
   public:
    explicit PathDevice(const SpeedScene& scene) : scene_(scene) {}
    const DeviceCapabilities& capabilities() const noexcept override { return capabilities_; }
    DeviceSample read(double now) noexcept override { return {handAt(scene_, now), true}; }
    void write(const Vec3&) noexcept override {}

   private:
    SpeedScene scene_;
    DeviceCapabilities capabilities_{"path"};
  };

  /// Packets carry no objects: these stay tied to where they were shared.
  class PathLink final : public Link {
   public:
    /// `place`: of the remote user; the first is 0.
    PathLink(const SpeedScene& scene, int place) : scene_(scene), place_(place) {
      packet_.sender = id();
    }
    [[nodiscard]] PeerId id() const noexcept {
      return PeerId{static_cast<std::uint32_t>(place_) + 2};
    }
    /// The first touches the cube, the others stand beside it in a row.
    [[nodiscard]] PointState findUser(double now) const;
    void send(const StatePacket&, double) noexcept override {}
    std::optional<Arrival> receive(double from, double until) noexcept override;

   private:
    SpeedScene scene_;
    int place_;
    StatePacket packet_;
  };

  [[nodiscard]] double now() const { return static_cast<double>(site_.tickCount()) / kHapticRate; }

  SpeedWorld world_;
  PathDevice device_;
  std::deque<PathLink> links_;
  Site site_;
};

}  // namespace tandem::demos::bench
