#include "device/live_device.h"

#include <utility>

#include "tandem/falcon/monotonic_clock.h"

#include "device/plugged_in.h"

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
    : spec_(std::move(spec)), driver_(std::move(driver)), placement_(placement) {
  if (options.clutch) {
    const ClutchSpec clutch = parseClutch(*options.clutch);
    clutch_button_ = clutch.button;
    if (clutch.button == 0)
      pedal_ = std::make_unique<HidSwitch>([path = clutch.path] { return openHidPath(path); },
                                           clutch.map);
  }
  GuardSettings guard;
  guard.max_force = options.max_force;
  auto guarded = std::make_unique<GuardedDevice>(std::move(driver_.device), guard);
  guarded_ = guarded.get();
  const WorkspaceSettings workspace = makeWorkspace(options, placement);
  placement_.centre_W = workspace.centre_W;
  mapped_ = std::make_unique<MappedDevice>(std::move(guarded), workspace);
}

LiveDevice::~LiveDevice() = default;

bool LiveDevice::isClutchPressed() const noexcept {
  if (pedal_) return pedal_->isPressed();
  return clutch_button_ != 0 && driver_.pressed && (driver_.pressed() & clutch_button_) != 0;
}

DeviceSample LiveDevice::read(double) noexcept {
  mapped_->setEngaged(!is_held_ && !isClutchPressed());
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
