#include "device/live_device.h"

#include <utility>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::demos {
namespace {

WorkspaceSettings makeWorkspace(const DeviceOptions& options, const Placement& placement) {
  WorkspaceSettings settings;
  settings.q_WD = placement.q_WD;
  settings.centre_W = placement.centre_W;
  if (options.offset.size() == 3)
    settings.centre_W += Vec3(options.offset[0], options.offset[1], options.offset[2]);
  settings.scale = options.scale;
  return settings;
}

}  // namespace

LiveDevice::LiveDevice(DeviceSpec spec, Driver driver, const DeviceOptions& options,
                       const Placement& placement)
    : spec_(std::move(spec)),
      driver_(std::move(driver)),
      clutch_("--clutch", options.clutch),
      grip_("--grip", options.grip ? options.grip : driver_.usual_grip),
      placement_(placement) {
  GuardSettings guard;
  guard.max_force = options.max_force;
  auto guarded = std::make_unique<GuardedDevice>(std::move(driver_.device), guard);
  guarded_ = guarded.get();
  const WorkspaceSettings workspace = makeWorkspace(options, placement);
  placement_.centre_W = workspace.centre_W;
  mapped_ = std::make_unique<MappedDevice>(std::move(guarded), workspace);
}

LiveDevice::~LiveDevice() = default;

DeviceSample LiveDevice::read(double) noexcept {
  mapped_->setEngaged(!is_held_ && !clutch_.isPressed(driver_));
  const DeviceSample sample = mapped_->read(readMonotonicClock());
  if (sample.valid) {
    p_W_ = sample.hip.p_W;
    if (driver_.emulated) driver_.emulated->tellHomed();
  }
  return sample;
}

void LiveDevice::write(const Vec3& f_W) noexcept {
  is_held_ = false;  // takes effect at the next read
  mapped_->write(f_W);
}

void LiveDevice::holdUntilTicked(const Vec3& p_W) noexcept {
  is_held_ = true;
  (void)read(0.0);
  mapped_->putPoint(p_W);
}

double LiveDevice::distanceFromMiddle() const noexcept {
  return (p_W_ - placement_.centre_W).norm() / mapped_->map().settings().scale;
}

}  // namespace tandem::demos
