#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// One body at one tick: in the island, and as the btRigidBody had it after the latest host step.
struct BodyRecord {
  RigidState island;
  RigidState bullet;
};

/// One site at one tick, at the tick's start.
struct TickRecord {
  double time = 0.0;  ///< [s]
  DeviceSample device;
  Vec3 f_W = Vec3::Zero();  ///< force on the device [N]
  bool contact = false;     ///< the local device's contact force is above 0
};

/// A packet that was taken in, for replay.
struct ArrivalRecord {
  int remote = 0;
  Arrival arrival;
};

/// All ticks of one site, in memory of a size chosen beforehand: recording never allocates in a
/// tick.
class Recording {
 public:
  /// Room for `ticks` ticks and `arrivals` packets; what is beyond is counted and left out.
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
  /// orientation and contact. Positions are displacements from the first tick, in a frame turned by
  /// `q_WS` from W. A body that is not there has zeros. Numbers are the shortest that read back to
  /// the same bits. The file appears whole or not at all. Throws tandem::Error naming the file.
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
