#include "tandem/falcon/mapped_device.h"

#include <stdexcept>
#include <utility>

namespace tandem {

MappedDevice::MappedDevice(std::unique_ptr<HapticDevice> device, const WorkspaceSettings& settings)
    : device_(std::move(device)), map_(settings), p_W_(settings.centre_W) {
  if (!device_) throw std::invalid_argument("device of the workspace map is null, give it one");
  capabilities_ = map_.toWorld(device_->capabilities());
}

DeviceSample MappedDevice::read(double now) noexcept {
  const DeviceSample sample_D = device_->read(now);
  const bool is_wanted = is_wanted_.load(std::memory_order_relaxed);
  if (!is_wanted) is_engaged_ = false;
  DeviceSample sample = sample_D;
  if (sample_D.wrist) sample.wrist = map_.toWorld(*sample_D.wrist);
  sample.hip = {p_W_, Vec3::Zero()};
  sample.valid = sample_D.valid && isFinite(sample_D.hip);
  if (!sample.valid) return sample;

  if (is_wanted && !is_engaged_) {
    if (was_read_) map_.place(sample_D.hip.p_W, p_W_);
    is_engaged_ = true;
  }
  const PointState hip = map_.toWorld(sample_D.hip);
  if (is_engaged_ || !was_read_) p_W_ = hip.p_W;
  was_read_ = true;
  sample.hip = is_engaged_ ? hip : PointState{p_W_, Vec3::Zero()};
  return sample;
}

bool MappedDevice::putPoint(const Vec3& p_W) noexcept {
  if (is_engaged_) return false;
  p_W_ = p_W;
  was_read_ = true;
  return true;
}

void MappedDevice::write(const Vec3& f_W) noexcept {
  device_->write(is_engaged_ ? map_.toDevice(f_W) : Vec3(Vec3::Zero()));
}

void MappedDevice::writeTorque(const Vec3& t_W) noexcept {
  device_->writeTorque(is_engaged_ ? map_.torqueToDevice(t_W) : Vec3(Vec3::Zero()));
}

}  // namespace tandem
