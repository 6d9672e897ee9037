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
constexpr std::size_t kRoll = 5;  // two sets of 64 bits, each as low and high half; an age

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

/// The size of what follows the objects tells which parts there are.
bool hasPart(std::size_t size, std::size_t part, std::size_t other) {
  return size == part || size == part + other;
}

void appendGrip(const TandemPacket& packet, std::vector<double>& doubles) {
  const bool holds = packet.grip_object != TANDEM_NO_OBJECT;
  doubles.push_back(static_cast<double>(packet.grip_epoch));
  doubles.push_back(holds ? static_cast<double>(packet.grip_object) : -1.0);
  doubles.insert(doubles.end(), packet.grip_position, packet.grip_position + 3);
  doubles.insert(doubles.end(), packet.grip_orientation, packet.grip_orientation + 4);
  doubles.push_back(packet.grip_age);
}

void readGrip(const double* at, TandemPacket& packet) {
  packet.grip_epoch = static_cast<std::uint32_t>(toWhole(at[0], 65535.0, "a grip's epoch"));
  packet.grip_object = at[1] == -1.0
                           ? TANDEM_NO_OBJECT
                           : static_cast<std::uint32_t>(toWhole(at[1], kMostId, "a grip's object"));
  std::copy_n(at + 2, 3, packet.grip_position);
  std::copy_n(at + 5, 4, packet.grip_orientation);
  packet.grip_age = at[9];
}

void appendSet(std::uint64_t set, std::vector<double>& doubles) {
  doubles.push_back(static_cast<double>(set & 0xffffffffU));
  doubles.push_back(static_cast<double>(set >> 32U));
}

std::uint64_t readSet(const double* at) {
  const auto half = [&](int i) {
    return static_cast<std::uint64_t>(toWhole(at[i], kMostId, "half of a set of sites"));
  };
  return half(0) | half(1) << 32U;
}

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
  if (packet.has_grip != 0) appendGrip(packet, doubles);
  if (packet.roll_heard != 0) {
    appendSet(packet.roll_heard, doubles);
    appendSet(packet.roll_members, doubles);
    doubles.push_back(packet.roll_age);
  }
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
  const std::size_t needed = kHead + kPerObject * packet.object_count;
  const std::size_t rest = doubles.size() - std::min(needed, doubles.size());
  packet.has_grip = hasPart(rest, kGrip, kRoll) ? 1 : 0;
  const bool has_roll = hasPart(rest, kRoll, kGrip);
  if (doubles.size() != needed + (packet.has_grip ? kGrip : 0) + (has_roll ? kRoll : 0)) {
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
  if (packet.has_grip != 0) readGrip(at, packet);
  if (packet.has_grip != 0) at += kGrip;
  if (has_roll) {
    packet.roll_heard = readSet(at);
    packet.roll_members = readSet(at + 2);
    packet.roll_age = at[4];
  }
  return packet;
}

}  // namespace tandem::pybullet
