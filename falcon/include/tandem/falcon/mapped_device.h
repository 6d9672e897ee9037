#pragma once

#include <atomic>
#include <memory>

#include "tandem/falcon/workspace_map.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A device seen through a WorkspaceMap, with a clutch. Of the device beneath, what is called W in
/// the interface is its own frame D.
///
/// While the clutch is out the world's point stands still and the hand feels nothing, so that it
/// can go back to the middle of its workspace; when it takes again the map is placed anew, so that
/// the point goes on from where it stands. A reading that is not valid moves nothing and places
/// nothing. A device that comes back with other positions (homed again) is mapped as before: the
/// point is then where the hand is; let the clutch out and in to place it anew.
class MappedDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument for no device or settings out of range.
  MappedDevice(std::unique_ptr<HapticDevice> device, const WorkspaceSettings& settings);

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// Lets the clutch in (true, as at first) or out; from the next read on. From any thread.
  void setEngaged(bool is_engaged) noexcept {
    is_wanted_.store(is_engaged, std::memory_order_relaxed);
  }
  /// As of the last read. For the thread that reads.
  [[nodiscard]] bool isEngaged() const noexcept { return is_engaged_; }

  /// Puts the world's point at `p_W`, from where it goes on when the clutch takes: a scene can say
  /// where it starts, wherever the hand is. False, and nothing, unless the clutch is out as of the
  /// last read. For the thread that reads.
  bool putPoint(const Vec3& p_W) noexcept;

  /// As it is now: the clutch has moved its centres. For the thread that reads.
  [[nodiscard]] const WorkspaceMap& map() const noexcept { return map_; }

 private:
  std::unique_ptr<HapticDevice> device_;
  WorkspaceMap map_;
  DeviceCapabilities capabilities_;
  std::atomic<bool> is_wanted_{true};
  bool is_engaged_ = true, was_read_ = false;
  Vec3 p_W_;  ///< of the last valid reading; where the point stands
};

}  // namespace tandem
#pragma GCC visibility pop
