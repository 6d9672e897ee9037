#include "net/state_stream.h"

#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/wire/wire_sealing.h"

namespace tandem::net {
namespace {

GripState makeGrip(std::uint16_t epoch, std::optional<ObjectId> object) {
  GripState grip;
  grip.epoch = epoch;
  grip.object = object;
  return grip;
}

/// States from one stream to another. The test decides when keys are renewed.
struct Way {
  StateStream receiver{PlayoutSettings{}, WireProfile::kFloat64, 7};
  StateStream sender{PlayoutSettings{}, WireProfile::kFloat64, 7};
  double now = 1.0;
  std::uint64_t datagram = 0;
  std::uint8_t minor = kMinorVersion;
  std::optional<GripState> grip;
  std::optional<RollCall> roll;

  void send(std::uint64_t sequence, std::optional<double> granted) {
    EXPECT_EQ(receive(make(sequence, granted), datagram++), Refusal::kNone);
  }
  std::vector<std::uint8_t> make(std::uint64_t sequence, std::optional<double> granted) {
    StatePacket packet;
    packet.sender = PeerId{2};
    packet.sequence = sequence;
    packet.time = now;
    if (granted) packet.energy = {*granted, -0.5};
    packet.grip = grip;
    packet.roll = roll;
    std::vector<std::uint8_t> bytes(2048);
    bytes.resize(sender.write(packet, minor, now, {bytes.data(), bytes.size()}));
    now += 0.01;
    return bytes;
  }
  /// `number` is the datagram's under the present keys; empty means the previous keys.
  Refusal receive(const std::vector<std::uint8_t>& bytes, std::optional<std::uint64_t> number) {
    if (number) receiver.note(*number);
    return receiver.read({bytes.data(), bytes.size()}, PeerId{2}, number, true, now).refusal;
  }
  /// All states that arrived.
  [[nodiscard]] std::vector<StatePacket> take() {
    std::vector<StatePacket> packets;
    while (const auto arrival = receiver.pop(0.0, now + 1.0)) packets.push_back(arrival->packet);
    return packets;
  }
};

TEST(StateStream, EnergyArrivesOrThatThereIsNone) {
  Way way;
  way.send(0, 0.25);
  way.send(1, 1.5);
  way.send(2, std::nullopt);
  const std::vector<StatePacket> got = way.take();
  ASSERT_EQ(got.size(), 3u);
  EXPECT_EQ(got[0].energy->granted, 0.25);
  EXPECT_EQ(got[0].energy->holdings, -0.5);
  EXPECT_EQ(got[1].energy->granted, 1.5);
  EXPECT_FALSE(got[2].energy);
}

TEST(StateStream, GripArrives) {
  Way way;
  way.grip = GripState{7, 3, Vec3(0.1, -0.2, 0.3), Quat(0.6, 0.0, -0.8, 0.0), 0.25};
  way.send(0, std::nullopt);
  way.grip = makeGrip(8, std::nullopt);
  way.send(1, std::nullopt);
  const std::vector<StatePacket> got = way.take();
  ASSERT_EQ(got.size(), 2u);
  ASSERT_TRUE(got[0].grip && got[1].grip);
  EXPECT_EQ(got[0].grip->object, 3u);
  EXPECT_EQ(got[0].grip->p_BG, Vec3(0.1, -0.2, 0.3));
  EXPECT_EQ(got[0].grip->age, 0.25);
  EXPECT_EQ(got[1].grip->epoch, 8u);
  EXPECT_FALSE(got[1].grip->object);
}

// A peer of minor version 0 would refuse the whole state.
TEST(StateStream, AnOlderPeerHearsOfNoGrip) {
  Way way;
  way.grip = makeGrip(7, 3);
  way.minor = kGripMinor - 1;
  EXPECT_EQ(way.make(0, std::nullopt).size(), computeStateSize(WireProfile::kFloat64, 0));
  way.minor = kGripMinor;
  EXPECT_EQ(way.make(1, std::nullopt).size(), computeStateSize(WireProfile::kFloat64, 0, true));
}

TEST(StateStream, AnOlderPeerHearsOfNoRoll) {
  Way way;
  way.roll = RollCall{SiteSet(3), SiteSet(1)};
  way.minor = kRollMinor - 1;
  EXPECT_EQ(way.make(0, std::nullopt).size(), computeStateSize(WireProfile::kFloat64, 0));
  way.minor = kRollMinor;
  EXPECT_EQ(way.make(1, std::nullopt).size(),
            computeStateSize(WireProfile::kFloat64, 0, false, true));
}

// The restarted peer's grants begin at zero. The receiver goes on from those before.
TEST(StateStream, GrantsOfAPeerThatBeginsAnewGoOn) {
  Way way;
  way.send(0, 0.25);
  way.send(1, 3.0);
  ASSERT_EQ(way.take().size(), 2u);
  way.sender = StateStream(PlayoutSettings{}, WireProfile::kFloat64, 7);
  way.receiver.startKeys();
  way.datagram = 0;
  way.send(0, 0.0);
  way.send(1, 0.5);
  const std::vector<StatePacket> got = way.take();
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[0].energy->granted, 3.0);
  EXPECT_EQ(got[1].energy->granted, 3.5);
}

// New keys alone do not change the grants.
TEST(StateStream, GrantsGoOnOverNewKeys) {
  Way way;
  way.send(0, 1.0);
  way.receiver.startKeys();
  way.datagram = 0;
  way.send(1, 2.0);
  const std::vector<StatePacket> got = way.take();
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[1].energy->granted, 2.0);
}

// A datagram with the new keys that overtakes must not invalidate those under the old keys.
TEST(StateStream, StatesUnderTheOldKeysStillCount) {
  Way way;
  way.send(0, 1.0);
  const auto old = way.make(1, 1.5);
  way.receiver.startKeys();
  way.datagram = 0;
  way.send(2, 2.0);
  EXPECT_EQ(way.receive(old, std::nullopt), Refusal::kNone);
  EXPECT_EQ(way.take().size(), 3u);
}

TEST(StateStream, OfAPeerThatHasBegunAnewTheyArePast) {
  Way way;
  way.send(7, 1.0);
  const auto old = way.make(8, 1.5);
  way.sender = StateStream(PlayoutSettings{}, WireProfile::kFloat64, 7);
  way.receiver.startKeys();
  way.datagram = 0;
  way.send(0, 0.0);
  EXPECT_EQ(way.receive(old, std::nullopt), Refusal::kExpired);
}

}  // namespace
}  // namespace tandem::net
