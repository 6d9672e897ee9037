#pragma once

#include <utility>

#include <chai3d.h>

#include "tandem/falcon/haptic_device.h"

/// Wraps any haptic device that CHAI3D drives as one of Tandem's.
///
/// CHAI3D's calls talk to the hardware and may take most of a millisecond: tick the site in
/// CHAI3D's haptic thread.
class Chai3dDevice final : public tandem::HapticDevice {
 public:
  explicit Chai3dDevice(chai3d::cGenericHapticDevicePtr device) : device_(std::move(device)) {
    const chai3d::cHapticDeviceInfo info = device_->getSpecifications();
    capabilities_.name = info.m_modelName;
    capabilities_.max_force = info.m_maxLinearForce;          // [N]
    capabilities_.max_stiffness = info.m_maxLinearStiffness;  // [N/m]
    capabilities_.max_slew = 2000.0;                          // [N/s]
    device_->open();
    device_->calibrate();
  }
  ~Chai3dDevice() override {
    device_->setForce(chai3d::cVector3d(0.0, 0.0, 0.0));
    device_->close();
  }
  Chai3dDevice(const Chai3dDevice&) = delete;
  Chai3dDevice& operator=(const Chai3dDevice&) = delete;

  const tandem::DeviceCapabilities& capabilities() const noexcept override { return capabilities_; }

  tandem::DeviceSample read(double) noexcept override {
    chai3d::cVector3d p, v;
    const bool is_there = device_->getPosition(p) && device_->getLinearVelocity(v);
    return {{{p.x(), p.y(), p.z()}, {v.x(), v.y(), v.z()}}, is_there};
  }

  void write(const tandem::Vec3& f_W) noexcept override {
    device_->setForce(f_W.allFinite() ? chai3d::cVector3d(f_W.x(), f_W.y(), f_W.z())
                                      : chai3d::cVector3d(0.0, 0.0, 0.0));
  }

 private:
  chai3d::cGenericHapticDevicePtr device_;
  tandem::DeviceCapabilities capabilities_;
};
