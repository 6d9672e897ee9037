#pragma once

#include <deque>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/falcon/haptic_device.h"

namespace tandem::test {

/// A device at a place that the test sets; it records force and torque written to it.
class FakeDevice final : public HapticDevice {
 public:
  FakeDevice() = default;
  explicit FakeDevice(const Vec3& p_W) { sample = {{p_W, Vec3::Zero()}, true}; }
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits; }
  [[nodiscard]] DeviceSample read(double) noexcept override { return sample; }
  void write(const Vec3& f_W) noexcept override { force_W = f_W; }
  void writeTorque(const Vec3& t_W) noexcept override { torque_W = t_W; }

  DeviceCapabilities limits{"fake"};
  DeviceSample sample{{}, true};
  Vec3 force_W = Vec3::Zero(), torque_W = Vec3::Zero();
};

/// A link whose arrivals the test inserts, ordered by time. It keeps up to `room` sent packets.
class FakeLink final : public Link {
 public:
  explicit FakeLink(std::size_t room = 0) { sent.reserve(room); }
  void send(const StatePacket& packet, double) noexcept override {
    if (sent.size() < sent.capacity()) sent.push_back(packet);
  }
  [[nodiscard]] std::optional<Arrival> receive(double, double until) noexcept override {
    if (arrivals.empty() || arrivals.front().time >= until) return std::nullopt;
    const Arrival arrival = arrivals.front();
    arrivals.pop_front();
    return arrival;
  }

  [[nodiscard]] bool hasLeft() const noexcept override { return has_left; }

  std::deque<Arrival> arrivals;
  std::vector<StatePacket> sent;
  bool has_left = false;
};

/// A sane packet of a user at rest at `p_W`.
inline StatePacket makePacket(PeerId sender, std::uint64_t sequence, const Vec3& p_W) {
  StatePacket packet;
  packet.sender = sender;
  packet.sequence = sequence;
  packet.user.p_W = p_W;
  return packet;
}

}  // namespace tandem::test
