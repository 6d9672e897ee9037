#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/wire/wire_state.h"
#include "wire/golden.h"

namespace tandem {
namespace {

using test::Bytes;
using test::collect;
using test::makeFullState;
using test::makeState;
using test::viewOf;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Bytes encode(const StateMessage& message, const WireLimits& limits = {}) {
  return collect([&](ByteSpan out) { return encodeState(message, out, limits); });
}

Decoded<StateMessage> decode(const Bytes& bytes, const WireLimits& limits = {}) {
  return decodeState(viewOf(bytes), PeerId{1}, limits);
}

TEST(WireState, SizesAreThoseOfTheStandard) {
  EXPECT_EQ(computeStateSize(WireProfile::kFloat32, 0), 88U);
  EXPECT_EQ(computeStateSize(WireProfile::kFloat32, 1), 148U);
  EXPECT_EQ(computeStateSize(WireProfile::kFloat64, 1), 224U);
  EXPECT_EQ(computeStateSize(WireProfile::kFloat32, 1, true), 184U);
  EXPECT_EQ(computeStateSize(WireProfile::kFloat64, 0, true), 176U);
  EXPECT_EQ(computeStateSize(WireProfile::kFloat32, 0, false, true), 108U);
  EXPECT_EQ(kMaxStateSize, 1092U);
  EXPECT_LE(kMaxStateSize, kMaxPayloadSize);
}

TEST(WireState, SecondsAreWholeMicroseconds) {
  EXPECT_EQ(toMicroseconds(0.0), 0);
  EXPECT_EQ(toMicroseconds(1.0 / 128.0), 7813);  // 7812.5
  EXPECT_EQ(toMicroseconds(-1e-6), -1);
  EXPECT_EQ(toMicroseconds(std::nan("")), -1);
  EXPECT_EQ(toMicroseconds(kInfinity), -1);
  EXPECT_EQ(toMicroseconds(1.2e9), -1);
}

// This is why times end at 2^50 us: up to there a double in seconds keeps every microsecond.
TEST(WireState, EveryMicrosecondComesBack) {
  constexpr std::uint64_t kSeed = 2;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 100000; ++i) {
    const auto bits = random() % 51;
    const auto us = static_cast<std::int64_t>(random() % (std::uint64_t{1} << bits) + 1);
    ASSERT_EQ(toMicroseconds(static_cast<double>(us) / 1e6), us) << "seed " << kSeed;
  }
  EXPECT_EQ(toMicroseconds(static_cast<double>(kMaxWireTimeUs) / 1e6), kMaxWireTimeUs);
}

/// All reals of the records.
std::vector<double*> listReals(StatePacket& packet) {
  std::vector<double*> reals;
  const auto add = [&reals](auto& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) reals.push_back(&numbers[i]);
  };
  add(packet.user.p_W);
  add(packet.user.v_W);
  if (packet.grip) {
    add(packet.grip->p_BG);
    add(packet.grip->q_BG.coeffs());
  }
  for (std::size_t i = 0; i < packet.object_count; ++i) {
    RigidState& state = packet.objects[i].state;
    add(state.p_W);
    add(state.q_WB.coeffs());
    add(state.v_W);
    add(state.w_W);
  }
  return reals;
}

/// True if the real at this place of the list belongs to a quaternion.
bool isOfOrientation(std::size_t index, bool has_grip) {
  if (has_grip && index >= 6 && index < 13) return index >= 9;
  if (has_grip && index >= 13) index -= 7;
  return index >= 6 && (index - 6) % 13 >= 3 && (index - 6) % 13 < 7;
}

class WireStateProfiles : public ::testing::TestWithParam<WireProfile> {};

/// Draws any state that may be sent.
StateMessage drawState(std::mt19937_64& random, WireProfile profile) {
  const auto draw = [&random](double bound) {
    // Half of the values are small, on a logarithmic scale.
    const double unit = static_cast<double>(random() >> 11) * 0x1p-53;
    const double size = random() % 2 == 0 ? unit : std::pow(10.0, -20.0 * unit);
    return (random() % 2 == 0 ? bound : -bound) * size;
  };
  const auto drawVector = [&draw](double bound) {
    const double x = draw(bound), y = draw(bound), z = draw(bound);
    return Vec3(x, y, z);
  };
  StateMessage message;
  message.profile = profile;
  message.packet.sender = PeerId{1};
  message.packet.sequence = random();
  message.packet.time = static_cast<double>(random() >> 14) / 1e6;
  message.send_time_us = static_cast<std::int64_t>(random() >> 14);
  message.echo_send_time_us = static_cast<std::int64_t>(random() >> 14);
  message.echo_hold_us = static_cast<std::uint32_t>(random());
  message.ack_bits = static_cast<std::uint32_t>(random());
  message.energy = {draw(1e9), draw(1e9)};
  message.flags = static_cast<std::uint16_t>(random() & kStateFlags);
  message.config_hash = static_cast<std::uint32_t>(random());
  message.packet.user = {drawVector(1e3), drawVector(1e2)};
  if ((message.flags & kStateGrip) != 0) {
    GripState& grip = message.packet.grip.emplace();
    grip.epoch = static_cast<std::uint16_t>(random());
    if (random() % 4 != 0) grip.object = static_cast<ObjectId>(random() % kMaxSharedObjects);
    grip.age = static_cast<double>(random() >> 32) / 1e6;
    grip.p_BG = drawVector(1e3);
    grip.q_BG = Quat(draw(1.0), draw(1.0), draw(1.0), 0.5).normalized();
  }
  if ((message.flags & kStateRoll) != 0)
    message.packet.roll =
        RollCall{SiteSet(random()), SiteSet(random()), static_cast<double>(random() >> 32) / 1e3};
  message.packet.object_count = static_cast<std::uint32_t>(random() % (kMaxObjectsPerPacket + 1));
  const auto first = static_cast<ObjectId>(random());
  for (ObjectId i = 0; i < message.packet.object_count; ++i) {
    Quat q(draw(1.0), draw(1.0), draw(1.0), 0.5);
    message.packet.objects[i] = {
        (first + 7 * i) % kMaxSharedObjects,
        {drawVector(1e3), q.normalized(), drawVector(1e2), drawVector(1e3)}};
  }
  return message;
}

void expectEqualBlocks(const StateMessage& a, const StateMessage& b) {
  EXPECT_EQ(a.send_time_us, b.send_time_us);
  EXPECT_EQ(a.echo_send_time_us, b.echo_send_time_us);
  EXPECT_EQ(a.echo_hold_us, b.echo_hold_us);
  EXPECT_EQ(a.ack_bits, b.ack_bits);
  EXPECT_EQ(a.energy.granted, b.energy.granted);
  EXPECT_EQ(a.energy.holdings, b.energy.holdings);
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_EQ(a.profile, b.profile);
  EXPECT_EQ(a.config_hash, b.config_hash);
  EXPECT_EQ(a.packet.sender, b.packet.sender);
  EXPECT_EQ(a.packet.sequence, b.packet.sequence);
  EXPECT_EQ(a.packet.time, b.packet.time);
}

TEST_P(WireStateProfiles, WhatGoesInComesOut) {
  constexpr std::uint64_t kSeed = 3;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 5000; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i));
    StateMessage sent = drawState(random, GetParam());
    const Bytes bytes = encode(sent);
    const bool has_grip = sent.packet.grip.has_value();
    const bool has_roll = sent.packet.roll.has_value();
    ASSERT_EQ(bytes.size(),
              computeStateSize(sent.profile, sent.packet.object_count, has_grip, has_roll));
    auto got = decode(bytes);
    ASSERT_TRUE(got) << name(got.refusal());
    ASSERT_TRUE(isSane(got->packet));
    expectEqualBlocks(*got, sent);
    ASSERT_EQ(got->packet.grip.has_value(), has_grip);
    ASSERT_EQ(got->packet.roll.has_value(), has_roll);
    if (has_roll) {
      EXPECT_EQ(got->packet.roll->heard, sent.packet.roll->heard);
      EXPECT_EQ(got->packet.roll->members, sent.packet.roll->members);
      EXPECT_EQ(got->packet.roll->age, sent.packet.roll->age);
    }
    if (has_grip) {
      EXPECT_EQ(got->packet.grip->epoch, sent.packet.grip->epoch);
      EXPECT_EQ(got->packet.grip->object, sent.packet.grip->object);
      EXPECT_EQ(got->packet.grip->age, sent.packet.grip->age);
    }
    ASSERT_EQ(got->packet.object_count, sent.packet.object_count);
    for (std::size_t k = 0; k < sent.packet.object_count; ++k)
      EXPECT_EQ(got->packet.objects[k].id, sent.packet.objects[k].id);
    if (GetParam() == WireProfile::kFloat32) {
      for (double* real : listReals(sent.packet)) *real = static_cast<float>(*real);
      for (std::size_t k = 0; k < sent.packet.object_count; ++k)
        sent.packet.objects[k].state.q_WB.normalize();
      if (has_grip) sent.packet.grip->q_BG.normalize();
    }
    const auto expected = listReals(sent.packet);
    const auto reals = listReals(got->packet);
    for (std::size_t k = 0; k < reals.size(); ++k) {
      // Compares exactly, except float's orientations. Those off by less than 1e-14 stay as they
      // are.
      const bool divided =
          GetParam() == WireProfile::kFloat32 && isOfOrientation(k, sent.packet.grip.has_value());
      ASSERT_NEAR(*reals[k], *expected[k], divided ? 1e-14 : 0.0) << "number " << k;
    }
    if (::testing::Test::HasFailure()) return;
  }
}

TEST_P(WireStateProfiles, OddNumbersAreNumbers) {
  for (const double odd : {-0.0, 5e-324, -1e-310, 1e-40, -1e-45}) {
    StateMessage message = makeState(GetParam());
    message.energy.granted = odd;
    message.packet.user.p_W.x() = message.packet.objects[0].state.w_W.z() = odd;
    const auto got = decode(encode(message));
    ASSERT_TRUE(got);
    const double expected =
        GetParam() == WireProfile::kFloat32 ? static_cast<double>(static_cast<float>(odd)) : odd;
    EXPECT_EQ(got->energy.granted, odd);
    EXPECT_EQ(got->packet.user.p_W.x(), expected);
    EXPECT_EQ(got->packet.objects[0].state.w_W.z(), expected);
    EXPECT_EQ(std::signbit(got->packet.user.p_W.x()), std::signbit(odd));
  }
}

TEST_P(WireStateProfiles, EachRealMustBeFiniteAndInBounds) {
  StateMessage good = makeFullState();
  good.profile = GetParam();
  const std::size_t count = listReals(good.packet).size();
  ASSERT_EQ(count, 6U + 13U * kMaxObjectsPerPacket);
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e300, -1e300, 1001.0}) {
    for (std::size_t i = 0; i < count; ++i) {
      StateMessage message = good;
      *listReals(message.packet)[i] = bad;
      EXPECT_TRUE(encode(message).empty()) << bad << " as number " << i;
    }
  }
}

/// Overwrites a real of the records at its place in the payload. Returns it as the profile stores
/// it.
void overwriteReal(Bytes& payload, WireProfile profile, std::size_t index, double value) {
  const std::size_t width = profile == WireProfile::kFloat32 ? 4 : 8;
  const std::size_t heads = index < 6 ? 0 : 1 + (index - 6) / 13;  // object records before it
  std::uint8_t* const place = payload.data() + kStateBlockSize + index * width + 8 * heads;
  const auto narrow = static_cast<float>(value);
  if (profile == WireProfile::kFloat32) {
    std::memcpy(place, &narrow, sizeof narrow);
  } else {
    std::memcpy(place, &value, sizeof value);
  }
}

// The same checks at the receiver, which no encoder protects: each real, in its place.
TEST_P(WireStateProfiles, EachRealIsCheckedOnArrival) {
  constexpr double kHuge = 3e38;  // finite as a float too
  StateMessage message = makeFullState();
  message.profile = GetParam();
  const Bytes good = encode(message);
  for (std::size_t i = 0; i < 6 + 13 * kMaxObjectsPerPacket; ++i) {
    const std::size_t place = i < 6 ? i : (i - 6) % 13;
    const WireRefusal bounded = i < 3        ? WireRefusal::kPosition
                                : i < 6      ? WireRefusal::kVelocity
                                : place < 3  ? WireRefusal::kPosition
                                : place < 7  ? WireRefusal::kOrientation
                                : place < 10 ? WireRefusal::kVelocity
                                             : WireRefusal::kAngularVelocity;
    for (const double bad : {std::nan(""), kInfinity, -kInfinity, kHuge, -kHuge}) {
      Bytes bytes = good;
      overwriteReal(bytes, GetParam(), i, bad);
      EXPECT_EQ(decode(bytes).refusal(), std::isfinite(bad) ? bounded : WireRefusal::kNotFinite)
          << bad << " as number " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BothProfiles, WireStateProfiles,
                         ::testing::Values(WireProfile::kFloat32, WireProfile::kFloat64),
                         [](const auto& tested) {
                           return tested.param == WireProfile::kFloat32 ? "Float32" : "Float64";
                         });

// Of two sites the younger must never take the other for older than it is.
TEST(WireState, AgesOfSitesAreRoundedDown) {
  StateMessage message;
  message.flags = kStateRoll;
  for (const double age : {0.0, 0.0009, 0.0015, 1.9999, 0.057, 1.001}) {
    message.packet.roll.emplace().age = age;
    const auto got = decode(encode(message));
    ASSERT_TRUE(got && got->packet.roll);
    EXPECT_LE(got->packet.roll->age, age);
    EXPECT_GT(got->packet.roll->age, age - 1e-3);
  }
}

TEST(WireState, SenderKeepsToTheGate) {
  const std::vector<std::function<void(StateMessage&)>> faults = {
      [](StateMessage& m) { m.send_time_us = -1; },
      [](StateMessage& m) { m.send_time_us = kMaxWireTimeUs + 1; },
      [](StateMessage& m) { m.echo_send_time_us = -1; },
      [](StateMessage& m) { m.packet.time = -1.0; },
      [](StateMessage& m) { m.packet.time = std::nan(""); },
      [](StateMessage& m) { m.packet.time = 1.2e9; },
      [](StateMessage& m) { m.energy.granted = std::nan(""); },
      [](StateMessage& m) { m.energy.holdings = std::nan(""); },
      [](StateMessage& m) { m.energy.granted = 1.1e9; },
      [](StateMessage& m) { m.energy.holdings = -1.1e9; },
      [](StateMessage& m) { m.flags = 64; },
      [](StateMessage& m) { m.flags |= kStateGrip; },
      [](StateMessage& m) { m.packet.grip.emplace(); },
      [](StateMessage& m) { m.flags |= kStateRoll; },
      [](StateMessage& m) { m.packet.roll.emplace(); },
      [](StateMessage& m) { m.flags |= kStateRoll, m.packet.roll.emplace().age = -1.0; },
      [](StateMessage& m) { m.flags |= kStateRoll, m.packet.roll.emplace().age = std::nan(""); },
      [](StateMessage& m) { m.profile = WireProfile{2}; },
      [](StateMessage& m) { m.packet.object_count = kMaxObjectsPerPacket + 1; },
      [](StateMessage& m) { m.packet.objects[0].id = kMaxSharedObjects; },
      [](StateMessage& m) { m.packet.objects[1].id = m.packet.objects[0].id; },
      [](StateMessage& m) { m.packet.objects[7].state.q_WB.w() = 1e-2; },
      [](StateMessage& m) { m.packet.objects[7].state.q_WB.coeffs() *= 1.0001; },
  };
  EXPECT_FALSE(encode(makeFullState()).empty());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    StateMessage message = makeFullState();
    faults[i](message);
    EXPECT_TRUE(encode(message).empty()) << "fault " << i;
  }
}

TEST(WireState, SenderKeepsAGripToTheGate) {
  const std::vector<std::function<void(GripState&)>> faults = {
      [](GripState& g) { g.object = kMaxSharedObjects; },
      [](GripState& g) { g.p_BG.y() = std::nan(""); },
      [](GripState& g) { g.p_BG.z() = -1001.0; },
      [](GripState& g) { g.q_BG.x() = kInfinity; },
      [](GripState& g) { g.q_BG.coeffs() *= 1.001; },
      [](GripState& g) { g.q_BG.coeffs().setZero(); },
      [](GripState& g) { g.age = -1e-6; },
      [](GripState& g) { g.age = std::nan(""); },
      [](GripState& g) { g.age = kInfinity; },
  };
  EXPECT_FALSE(encode(test::makeGripState()).empty());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    StateMessage message = test::makeGripState();
    faults[i](*message.packet.grip);
    EXPECT_TRUE(encode(message).empty()) << "fault " << i;
  }
}

// A long hold tells the largest age.
TEST(WireState, AgesEndAtTheirLargest) {
  StateMessage message = test::makeGripState();
  message.packet.grip->age = 1e5;
  const auto got = decode(encode(message));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->packet.grip->age, 4294.967295);
}

TEST(WireState, WritesNothingWithoutRoom) {
  const StateMessage message = makeState(WireProfile::kFloat64);
  const std::size_t size = computeStateSize(message.profile, 1);
  Bytes bytes(size, 0xee);
  EXPECT_EQ(encodeState(message, {bytes.data(), size - 1}), 0U);
  EXPECT_EQ(bytes, Bytes(size, 0xee));
  EXPECT_EQ(encodeState(message, {bytes.data(), size}), size);
}

TEST(WireState, ReceiverMayBeNarrower) {
  WireLimits narrow;
  narrow.position = 2.0;
  const Bytes bytes = encode(makeState(WireProfile::kFloat64));
  EXPECT_TRUE(decode(bytes));
  EXPECT_EQ(decode(bytes, narrow).refusal(), WireRefusal::kPosition);
}

// A peer that rounds differently is off by less than 1e-3. Such orientations are accepted and
// normalised.
TEST(WireState, OrientationsBecomeUnits) {
  Bytes bytes = encode(makeState(WireProfile::kFloat64));
  overwriteReal(bytes, WireProfile::kFloat64, 6 + 3, 0.6004);  // w; the square is off by 4.8e-4
  const auto got = decode(bytes);
  ASSERT_TRUE(got);
  const Quat& q = got->packet.objects[0].state.q_WB;
  EXPECT_NEAR(q.norm(), 1.0, 1e-15);
  EXPECT_NEAR(q.w() / q.y(), 0.6004 / -0.8, 1e-15);
  overwriteReal(bytes, WireProfile::kFloat64, 6 + 3, 0.6009);
  EXPECT_EQ(decode(bytes).refusal(), WireRefusal::kOrientation);
}

}  // namespace
}  // namespace tandem
