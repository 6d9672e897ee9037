#include "packet_doubles.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "refusal.h"

namespace tandem::pybullet {
namespace {

constexpr std::size_t kHead = 13;
constexpr std::size_t kPerObject = 16;
constexpr std::size_t kGrip = 10;

/// Checks that `value` is a whole number in [0, most].
double toWhole(double value, double most, const char* what) {
  if (!(value >= 0.0 && value <= most) ||
      value != static_cast<double>(static_cast<std::uint64_t>(value))) {
    throw Refusal(kBadCommand, std::string("push: ") + what + " is no whole number that fits");
  }
  return value;
}

constexpr double kMostId = 4294967295.0;
constexpr double kMostSequence = 9007199254740992.0;  // 2^53: doubles count up to it

}  // namespace

std::vector<double> toDoubles(const TandemPacket& packet) {
  std::vector<double> doubles{static_cast<double>(packet.sender), packet.is_idle != 0 ? 1.0 : 0.0,
                              static_cast<double>(packet.sequence), packet.time};
  const auto append = [&](const double* values, std::size_t size) {
    doubles.insert(doubles.end(), values, values + size);
  };
  append(packet.position, 3);
  append(packet.velocity, 3);
  doubles.push_back(packet.energy_granted);
  doubles.push_back(packet.energy_holdings);
  doubles.push_back(static_cast<double>(packet.object_count));
  for (std::size_t i = 0; i < packet.object_count; ++i) {
    const TandemState& state = packet.objects[i];
    doubles.push_back(static_cast<double>(packet.object_ids[i]));
    append(state.position, 3);
    append(state.orientation, 4);
    append(state.velocity, 3);
    append(state.angular_velocity, 3);
    doubles.push_back(static_cast<double>(packet.object_epochs[i]));
    doubles.push_back(static_cast<double>(packet.object_epoch_authors[i]));
  }
  if (packet.has_grip == 0) return doubles;
  const bool holds = packet.grip_object != TANDEM_NO_OBJECT;
  doubles.push_back(static_cast<double>(packet.grip_epoch));
  doubles.push_back(holds ? static_cast<double>(packet.grip_object) : -1.0);
  append(packet.grip_position, 3);
  append(packet.grip_orientation, 4);
  doubles.push_back(packet.grip_age);
  return doubles;
}

TandemPacket toPacket(const std::vector<double>& doubles) {
  if (doubles.size() < kHead) throw Refusal(kBadCommand, "push: a packet has 13 doubles or more");
  TandemPacket packet{};
  const double* at = doubles.data();
  packet.sender = static_cast<std::uint32_t>(toWhole(*at++, kMostId, "sender"));
  packet.is_idle = *at++ != 0.0 ? 1 : 0;
  packet.sequence = static_cast<std::uint64_t>(toWhole(*at++, kMostSequence, "sequence"));
  packet.time = *at++;
  std::copy_n(at, 3, packet.position);
  std::copy_n(at + 3, 3, packet.velocity);
  at += 6;
  packet.energy_granted = *at++;
  packet.energy_holdings = *at++;
  packet.object_count = static_cast<std::size_t>(
      toWhole(*at++, TANDEM_MAX_OBJECTS_PER_PACKET, "the number of objects"));
  const std::size_t without_grip = kHead + kPerObject * packet.object_count;
  packet.has_grip = doubles.size() == without_grip + kGrip ? 1 : 0;
  if (packet.has_grip == 0 && doubles.size() != without_grip) {
    throw Refusal(kBadCommand, "push: " + std::to_string(doubles.size()) +
                                   " doubles are not what its number of objects needs");
  }
  for (std::size_t i = 0; i < packet.object_count; ++i) {
    packet.object_ids[i] = static_cast<std::uint32_t>(toWhole(at[0], kMostId, "an object's id"));
    TandemState& state = packet.objects[i];
    std::copy_n(at + 1, 3, state.position);
    std::copy_n(at + 4, 4, state.orientation);
    std::copy_n(at + 8, 3, state.velocity);
    std::copy_n(at + 11, 3, state.angular_velocity);
    packet.object_epochs[i] = static_cast<std::uint32_t>(toWhole(at[14], kMostId, "an epoch"));
    packet.object_epoch_authors[i] =
        static_cast<std::uint32_t>(toWhole(at[15], kMostId, "an epoch's author"));
    at += kPerObject;
  }
  if (packet.has_grip == 0) return packet;
  packet.grip_epoch = static_cast<std::uint32_t>(toWhole(at[0], 65535.0, "a grip's epoch"));
  packet.grip_object = at[1] == -1.0
                           ? TANDEM_NO_OBJECT
                           : static_cast<std::uint32_t>(toWhole(at[1], kMostId, "a grip's object"));
  std::copy_n(at + 2, 3, packet.grip_position);
  std::copy_n(at + 5, 4, packet.grip_orientation);
  packet.grip_age = at[9];
  return packet;
}

}  // namespace tandem::pybullet
