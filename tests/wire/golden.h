#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "coordination/src/wire/wire_agree.h"
#include "coordination/src/wire/wire_handshake.h"
#include "coordination/src/wire/wire_state.h"
#include "support/checkout.h"

/// \file
/// The golden files as bytes, and their values from golden/index.txt.
namespace tandem::test {

using Bytes = std::vector<std::uint8_t>;

inline ByteView viewOf(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

inline Bytes readGolden(const std::string& file) {
  std::ifstream in(inCheckout("tests/wire/golden/" + file), std::ios::binary);
  if (!in) throw std::runtime_error("no golden file " + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Calls encode(ByteSpan) with room for any datagram. Returns the written bytes.
template <class Encode>
Bytes collect(const Encode& encode) {
  Bytes bytes(kMaxDatagramSize);
  bytes.resize(encode(ByteSpan{bytes.data(), bytes.size()}));
  return bytes;
}

/// A header, then the payload written by encode(ByteSpan); empty if either is refused.
template <class Encode>
Bytes collectOpened(const ClearHeader& header, const Encode& encode) {
  return collect([&](ByteSpan out) -> std::size_t {
    const std::size_t head = encodeHeader(header, out);
    if (head == 0) return 0;
    const std::size_t payload = encode(ByteSpan{out.data + head, out.size - head});
    return payload == 0 ? 0 : head + payload;
  });
}

inline constexpr PeerId kInitiator{2};
inline constexpr PeerId kResponder{7};
inline constexpr std::uint64_t kNonce = 0x1122334455667788;
inline constexpr std::uint32_t kInitiatorsSession = 0x12345678;
inline constexpr std::uint32_t kRespondersSession = 0x9abcdef0;

inline ClearHeader makeHeader(MessageType type, std::uint64_t sequence) {
  return {type, kWireVersion, kRespondersSession, kInitiator, 3, sequence};
}

inline ClearHeader makeAnswersHeader(MessageType type, std::uint64_t sequence) {
  return {type, kWireVersion, kInitiatorsSession, kResponder, 3, sequence};
}

template <std::size_t kCount>
std::array<std::uint8_t, kCount> makeCounting(std::uint8_t first) {
  std::array<std::uint8_t, kCount> bytes{};
  for (std::uint8_t& byte : bytes) byte = first++;
  return bytes;
}

/// Values of state_float32.bin (before they are rounded) and state_float64.bin.
inline StateMessage makeState(WireProfile profile) {
  StateMessage message;
  message.send_time_us = 5000123;
  message.packet.sender = kInitiator;
  message.packet.time = 4.999987;
  message.packet.sequence = 640;
  message.echo_send_time_us = 77000456;
  message.echo_hold_us = 7812;
  message.ack_bits = 0xfffffffd;
  message.energy = {0.375, -0.0125};
  message.flags = profile == WireProfile::kFloat32 ? kStateFlags & ~(kStateGrip | kStateRoll) : 0;
  message.profile = profile;
  message.config_hash = 0xdeadbeef;
  message.packet.user = {Vec3(0.1, -0.05, 1000.0), Vec3(-100.0, 0.7, 5e-324)};
  message.packet.object_count = 1;
  message.packet.objects[0] = {3,
                               {Vec3(0.126, -0.0, 0.25), Quat(0.6, 0.0, -0.8, 0.0),
                                Vec3(0.1, -0.2, 0.3), Vec3(-1.5, 0.001, 12.25)},
                               {1, kInitiator}};
  return message;
}

/// Values of state_grip.bin.
inline StateMessage makeGripState() {
  StateMessage message = makeState(WireProfile::kFloat64);
  message.flags = kStateAccount | kStateGrip;
  message.packet.user = {Vec3(0.125, -0.5, 1000.0), Vec3(-100.0, 0.75, 0.0)};
  message.packet.grip =
      GripState{65535, 3, Vec3(0.25, -0.0, -1000.0), Quat(0.6, 0.0, 0.0, 0.8), 0.250001};
  return message;
}

/// Values of state_grip_released.bin.
inline StateMessage makeReleasedState() {
  StateMessage message = makeGripState();
  message.flags = kStateGrip;
  message.profile = WireProfile::kFloat32;
  message.packet.object_count = 0;
  message.packet.grip = GripState{};
  message.packet.grip->epoch = 2;
  message.packet.grip->age = 4294.967295;
  return message;
}

/// Values of state_roll.bin.
inline StateMessage makeRollState() {
  StateMessage message = makeGripState();
  message.flags = kStateGrip | kStateRoll;
  message.profile = WireProfile::kFloat32;
  message.packet.grip = GripState{};
  message.packet.object_count = 0;
  message.packet.roll = RollCall{SiteSet(0x8000000000000046), SiteSet(2), 61.5};
  return message;
}

/// Values of state_full.bin: every field at its bound.
inline StateMessage makeFullState() {
  StateMessage message;
  message.send_time_us = message.echo_send_time_us = kMaxWireTimeUs;
  message.packet.sender = kResponder;
  message.packet.time = 1125899906.842624;  // 2^50 us
  message.packet.sequence = ~std::uint64_t{0};
  message.echo_hold_us = message.ack_bits = ~std::uint32_t{0};
  message.energy = {1e9, -1e9};
  message.flags = kStateFading;
  message.config_hash = 0xdeadbeef;
  message.packet.user = {Vec3(-1000.0, 1000.0, 0.0), Vec3(100.0, -100.0, 0.0)};
  message.packet.object_count = kMaxObjectsPerPacket;
  for (ObjectId i = 0; i < 7; ++i) {
    message.packet.objects[i] = {i * 36,
                                 {Vec3(1000.0 - i, 0.1 * i, -1000.0), Quat(0.5, -0.5, 0.5, -0.5),
                                  Vec3(100.0, -100.0, i), Vec3(1000.0, -1000.0, i / 3.0)},
                                 {i, PeerId{i}}};
  }
  message.packet.objects[0].epoch = {~std::uint32_t{0}, PeerId{8}};
  message.packet.objects[7] = {
      255, {Vec3(0.0, 0.0, 1e-300), Quat(0.0, 0.0, 0.0, -1.0), Vec3::Zero(), Vec3::Zero()}};
  return message;
}

/// Values of agree.bin.
inline Configuration makeGoldenConfiguration() {
  return makeConfiguration({{"object.mass", "0.2"},
                            {"contact.stiffness", "2000"},
                            {"contact.damping", "10"},
                            {"network.profile", "float64"},
                            {"scene", "W\xc3\xbcrfel auf Tisch"}});
}

}  // namespace tandem::test
