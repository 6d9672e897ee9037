#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// One body at one tick: its state in the island, and in Bullet after the latest host step.
struct BodyRecord {
  RigidState island;
  RigidState bullet;
};

/// One site at the start of one tick.
struct TickRecord {
  double time = 0.0;  ///< [s]
  DeviceSample device;
  Vec3 f_W = Vec3::Zero();  ///< force on the device [N]
  bool contact = false;     ///< the local device's contact force is above 0
};

/// A packet that a site received, for replay.
struct ArrivalRecord {
  int remote = 0;
  Arrival arrival;
};

/// All ticks of one site. The memory has a fixed size, so recording never allocates in a tick.
class Recording {
 public:
  /// Reserves `ticks` ticks and `arrivals` packets. More are left out and counted.
  Recording(std::size_t ticks, std::size_t arrivals, int objects, int proxies);

  void addTick(const TickRecord& record, const BodyRecord* objects,
               const BodyRecord* proxies) noexcept;
  void addArrival(const ArrivalRecord& record) noexcept;

  [[nodiscard]] const std::vector<TickRecord>& ticks() const noexcept { return ticks_; }
  [[nodiscard]] const std::vector<ArrivalRecord>& arrivals() const noexcept { return arrivals_; }
  [[nodiscard]] int objectCount() const noexcept { return object_count_; }
  [[nodiscard]] int proxyCount() const noexcept { return proxy_count_; }
  [[nodiscard]] const BodyRecord& object(std::size_t tick, int index) const noexcept {
    return objects_[tick * static_cast<std::size_t>(object_count_) +
                    static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const BodyRecord& proxy(std::size_t tick, int index) const noexcept {
    return proxies_[tick * static_cast<std::size_t>(proxy_count_) +
                    static_cast<std::size_t>(index)];
  }
  [[nodiscard]] std::uint64_t leftOut() const noexcept { return left_out_; }

  /// Writes one row per tick: t, device_*, force_*, object_*, proxy_*, body_object_*, body_proxy_*,
  /// orientation and contact. Positions are displacements from the first tick, in a frame rotated
  /// by `q_WS` from W. A missing body has zeros. Numbers are the shortest that read back to the
  /// same bits. The file is complete or absent. Throws tandem::Error with the file's name.
  void writeCsv(const std::filesystem::path& path, const Quat& q_WS = Quat::Identity()) const;

 private:
  int object_count_;
  int proxy_count_;
  std::vector<TickRecord> ticks_;
  std::vector<BodyRecord> objects_, proxies_;
  std::vector<ArrivalRecord> arrivals_;
  std::uint64_t left_out_ = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
