// Golden files of coordination/STANDARD.md, section 12: these values give exactly these bytes.

#include "wire/golden.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "coordination/src/wire/wire_sealing.h"

namespace tandem {
namespace {

using namespace test;  // NOLINT: the golden values

void expectRoute(const HandshakeRoute& route, PeerId sender, PeerId receiver) {
  EXPECT_EQ(route.sender, sender);
  EXPECT_EQ(route.receiver, receiver);
  EXPECT_EQ(route.nonce, kNonce);
}

const HandshakeRoute kThere{kInitiator, kResponder, kNonce};
const HandshakeRoute kBack{kResponder, kInitiator, kNonce};

/// The tag as it stands in the file; tests/secure computes it.
HandshakeTag readTag(const char* file, std::size_t offset) {
  HandshakeTag tag{};
  const Bytes golden = readGolden(file);
  std::copy_n(golden.begin() + static_cast<std::ptrdiff_t>(offset), tag.size(), tag.begin());
  return tag;
}

TEST(WireGolden, Hello) {
  const auto tag = readTag("hello.bin", kHelloTagOffset);
  EXPECT_EQ(collect([&](ByteSpan out) {
              return encodeHello({kThere, tag}, out);
            }),
            readGolden("hello.bin"));
  const auto hello = decodeHello(viewOf(readGolden("hello.bin")));
  ASSERT_TRUE(hello);
  EXPECT_EQ(hello->tag, tag);
  expectRoute(hello->route, kInitiator, kResponder);
}

TEST(WireGolden, Cookie) {
  const auto cookie = makeCounting<16>(0xa0);
  const auto tag = readTag("cookie.bin", kCookieTagOffset);
  EXPECT_EQ(collect([&](ByteSpan out) {
              return encodeCookie({kBack, cookie, tag}, out);
            }),
            readGolden("cookie.bin"));
  const auto message = decodeCookie(viewOf(readGolden("cookie.bin")));
  ASSERT_TRUE(message);
  expectRoute(message->route, kResponder, kInitiator);
  EXPECT_EQ(message->cookie, cookie);
  EXPECT_EQ(message->tag, tag);
}

TEST(WireGolden, Open) {
  const OpenMessage open{kThere, 3, makeCounting<16>(0xa0), makeCounting<56>(0),
                         readTag("open.bin", kOpenTagOffset)};
  EXPECT_EQ(collect([&](ByteSpan out) { return encodeOpen(open, out); }), readGolden("open.bin"));
  const auto message = decodeOpen(viewOf(readGolden("open.bin")));
  ASSERT_TRUE(message);
  expectRoute(message->route, kInitiator, kResponder);
  EXPECT_EQ(message->key_epoch, 3);
  EXPECT_EQ(message->cookie, open.cookie);
  EXPECT_EQ(message->noise, open.noise);
  EXPECT_EQ(message->tag, open.tag);
}

TEST(WireGolden, Accept) {
  const AcceptMessage accept{kBack, kInitiatorsSession, 3, makeCounting<56>(0x40)};
  EXPECT_EQ(collect([&](ByteSpan out) { return encodeAccept(accept, out); }),
            readGolden("accept.bin"));
  const auto message = decodeAccept(viewOf(readGolden("accept.bin")));
  ASSERT_TRUE(message);
  expectRoute(message->route, kResponder, kInitiator);
  EXPECT_EQ(message->session, kInitiatorsSession);
  EXPECT_EQ(message->key_epoch, 3);
  EXPECT_EQ(message->noise, accept.noise);
}

TEST(WireGolden, Refuse) {
  for (const RefuseMessage& refuse :
       {RefuseMessage{kBack, RefuseCode::kKey, 3}, RefuseMessage{kBack, RefuseCode::kVersion, 4}}) {
    const Bytes golden =
        readGolden(refuse.version == kWireVersion ? "refuse_key.bin" : "refuse_version.bin");
    EXPECT_EQ(collect([&](ByteSpan out) { return encodeRefuse(refuse, out); }), golden);
    const auto message = decodeRefuse(viewOf(golden));
    ASSERT_TRUE(message);
    expectRoute(message->route, kResponder, kInitiator);
    EXPECT_EQ(message->code, refuse.code);
    EXPECT_EQ(message->version, refuse.version);
  }
}

void expectHeader(const ClearHeader& header, const ClearHeader& expected) {
  EXPECT_EQ(header.type, expected.type);
  EXPECT_EQ(header.version, kWireVersion);
  EXPECT_EQ(header.session, expected.session);
  EXPECT_EQ(header.sender, expected.sender);
  EXPECT_EQ(header.key_epoch, expected.key_epoch);
  EXPECT_EQ(header.sequence, expected.sequence);
}

/// Compares bit for bit, including signs of zeros.
template <class A, class B>
void expectSame(const A& a, const B& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i], b[i]);
    EXPECT_EQ(std::signbit(a[i]), std::signbit(b[i]));
  }
}

void expectState(const Bytes& golden, const ClearHeader& expected_header,
                 const StateMessage& expected) {
  const auto header = decodeHeader(viewOf(golden));
  ASSERT_TRUE(header);
  expectHeader(*header, expected_header);
  const auto message = decodeState(payloadOf(viewOf(golden)), header->sender);
  ASSERT_TRUE(message) << name(message.refusal());
  EXPECT_EQ(message->send_time_us, expected.send_time_us);
  EXPECT_EQ(message->echo_send_time_us, expected.echo_send_time_us);
  EXPECT_EQ(message->echo_hold_us, expected.echo_hold_us);
  EXPECT_EQ(message->ack_bits, expected.ack_bits);
  EXPECT_EQ(message->energy.granted, expected.energy.granted);
  EXPECT_EQ(message->energy.holdings, expected.energy.holdings);
  EXPECT_EQ(message->flags, expected.flags);
  EXPECT_EQ(message->profile, expected.profile);
  EXPECT_EQ(message->config_hash, expected.config_hash);
  const StatePacket& packet = message->packet;
  EXPECT_EQ(packet.sender, header->sender);
  EXPECT_EQ(packet.sequence, expected.packet.sequence);
  EXPECT_EQ(packet.time, expected.packet.time);
  expectSame(packet.user.p_W, expected.packet.user.p_W);
  expectSame(packet.user.v_W, expected.packet.user.v_W);
  ASSERT_EQ(packet.grip.has_value(), expected.packet.grip.has_value());
  if (packet.grip) {
    EXPECT_EQ(packet.grip->epoch, expected.packet.grip->epoch);
    EXPECT_EQ(packet.grip->object, expected.packet.grip->object);
    EXPECT_EQ(packet.grip->age, expected.packet.grip->age);
    expectSame(packet.grip->p_BG, expected.packet.grip->p_BG);
    expectSame(packet.grip->q_BG.coeffs(), expected.packet.grip->q_BG.coeffs());
  }
  ASSERT_EQ(packet.roll.has_value(), expected.packet.roll.has_value());
  if (packet.roll) {
    EXPECT_EQ(packet.roll->heard, expected.packet.roll->heard);
    EXPECT_EQ(packet.roll->members, expected.packet.roll->members);
    EXPECT_EQ(packet.roll->age, expected.packet.roll->age);
  }
  ASSERT_EQ(packet.object_count, expected.packet.object_count);
  for (std::size_t i = 0; i < packet.object_count; ++i) {
    const ObjectState& object = packet.objects[i];
    const ObjectState& wanted = expected.packet.objects[i];
    EXPECT_EQ(object.id, wanted.id);
    EXPECT_EQ(object.epoch, wanted.epoch);
    expectSame(object.state.p_W, wanted.state.p_W);
    expectSame(object.state.q_WB.coeffs(), wanted.state.q_WB.coeffs());
    expectSame(object.state.v_W, wanted.state.v_W);
    expectSame(object.state.w_W, wanted.state.w_W);
  }
}

Bytes collectState(const ClearHeader& header, const StateMessage& message) {
  return collectOpened(header, [&](ByteSpan out) { return encodeState(message, out); });
}

TEST(WireGolden, StateInFloat64) {
  const ClearHeader header = makeHeader(MessageType::kState, (std::uint64_t{1} << 32) + 43);
  const StateMessage message = makeState(WireProfile::kFloat64);
  EXPECT_EQ(collectState(header, message), readGolden("state_float64.bin"));
  expectState(readGolden("state_float64.bin"), header, message);
}

TEST(WireGolden, StateInFloat32) {
  const ClearHeader header = makeHeader(MessageType::kState, (std::uint64_t{1} << 32) + 42);
  EXPECT_EQ(collectState(header, makeState(WireProfile::kFloat32)),
            readGolden("state_float32.bin"));
  StateMessage rounded = makeState(WireProfile::kFloat32);
  const auto round = [](auto& numbers) {
    numbers = numbers.template cast<float>().template cast<double>().eval();
  };
  RigidState& object = rounded.packet.objects[0].state;
  round(rounded.packet.user.p_W);
  round(rounded.packet.user.v_W);
  round(object.p_W);
  round(object.q_WB.coeffs());
  object.q_WB.normalize();
  round(object.v_W);
  round(object.w_W);
  expectState(readGolden("state_float32.bin"), header, rounded);
}

TEST(WireGolden, StateOfADeviceOnly) {
  StateMessage message;
  message.flags = kStateIdle;
  message.profile = WireProfile::kFloat32;
  message.config_hash = 0xdeadbeef;
  const ClearHeader header = makeHeader(MessageType::kState, 0);
  EXPECT_EQ(collectState(header, message), readGolden("state_device_only.bin"));
  expectState(readGolden("state_device_only.bin"), header, message);
}

TEST(WireGolden, StateWithAGrip) {
  const ClearHeader header = makeHeader(MessageType::kState, (std::uint64_t{1} << 32) + 44);
  EXPECT_EQ(collectState(header, makeGripState()), readGolden("state_grip.bin"));
  expectState(readGolden("state_grip.bin"), header, makeGripState());
}

TEST(WireGolden, StateAfterARelease) {
  const ClearHeader header = makeHeader(MessageType::kState, (std::uint64_t{1} << 32) + 45);
  EXPECT_EQ(collectState(header, makeReleasedState()), readGolden("state_grip_released.bin"));
  expectState(readGolden("state_grip_released.bin"), header, makeReleasedState());
}

TEST(WireGolden, StateWithARoll) {
  const ClearHeader header = makeHeader(MessageType::kState, (std::uint64_t{1} << 32) + 46);
  EXPECT_EQ(collectState(header, makeRollState()), readGolden("state_roll.bin"));
  expectState(readGolden("state_roll.bin"), header, makeRollState());
}

TEST(WireGolden, StateAtEveryBound) {
  const ClearHeader header{MessageType::kState, kWireVersion, ~std::uint32_t{0}, kResponder, 3,
                           ~std::uint64_t{0}};
  EXPECT_EQ(collectState(header, makeFullState()), readGolden("state_full.bin"));
  expectState(readGolden("state_full.bin"), header, makeFullState());
}

TEST(WireGolden, Agree) {
  const Configuration configuration = makeGoldenConfiguration();
  const auto parts = makeAgreeParts(configuration);
  ASSERT_EQ(parts.size(), 1U);
  const ClearHeader header = makeHeader(MessageType::kAgree, 1);
  const Bytes golden = readGolden("agree.bin");
  EXPECT_EQ(collectOpened(header, [&](ByteSpan out) { return encodeAgree(parts[0], out); }),
            golden);
  const auto part = decodeAgree(payloadOf(viewOf(golden)));
  ASSERT_TRUE(part);
  EXPECT_EQ(part->config_hash, hashConfiguration(configuration));
  EXPECT_EQ(part->part, 0);
  EXPECT_EQ(part->parts, 1);
  EXPECT_EQ(part->items, configuration);
}

TEST(WireGolden, AgreeAnswers) {
  const std::uint32_t hash = hashConfiguration(makeGoldenConfiguration());
  const AgreeAnswer same{hash, 1, AgreeVerdict::kEqual, "", ""};
  const AgreeAnswer different{hash, 1, AgreeVerdict::kDifferent, "object.mass", "0.25"};
  for (const AgreeAnswer& answer : {same, different}) {
    const bool equal = answer.verdict == AgreeVerdict::kEqual;
    const Bytes golden = readGolden(equal ? "agree_ack_same.bin" : "agree_ack_different.bin");
    const ClearHeader header = makeAnswersHeader(MessageType::kAgreeAck, equal ? 2 : 3);
    EXPECT_EQ(collectOpened(header, [&](ByteSpan out) { return encodeAgreeAck(answer, out); }),
              golden);
    const auto decoded = decodeAgreeAck(payloadOf(viewOf(golden)));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->config_hash, hash);
    EXPECT_EQ(decoded->parts_received, 1U);
    EXPECT_EQ(decoded->verdict, answer.verdict);
    EXPECT_EQ(decoded->key, answer.key);
    EXPECT_EQ(decoded->value, answer.value);
  }
}

TEST(WireGolden, Bye) {
  const ClearHeader header = makeHeader(MessageType::kBye, 99);
  const auto encode = [](ByteSpan out) { return encodeBye(ByeReason::kProgramEnds, out); };
  EXPECT_EQ(collectOpened(header, encode), readGolden("bye.bin"));
  const auto reason = decodeBye(payloadOf(viewOf(readGolden("bye.bin"))));
  ASSERT_TRUE(reason);
  EXPECT_EQ(*reason, ByeReason::kProgramEnds);
}

TEST(WireGolden, Paths) {
  for (const auto& [type, file] : {std::pair{MessageType::kPathChallenge, "path_challenge.bin"},
                                   std::pair{MessageType::kPathResponse, "path_response.bin"}}) {
    const ClearHeader header =
        type == MessageType::kPathChallenge ? makeHeader(type, 7) : makeAnswersHeader(type, 8);
    const auto encode = [](ByteSpan out) { return encodePath(kNonce, out); };
    EXPECT_EQ(collectOpened(header, encode), readGolden(file));
    const auto token = decodePath(payloadOf(viewOf(readGolden(file))));
    ASSERT_TRUE(token);
    EXPECT_EQ(*token, kNonce);
  }
}

template <std::size_t kCount>
Bytes toBytes(const std::array<std::uint8_t, kCount>& bytes) {
  return {bytes.begin(), bytes.end()};
}

TEST(WireGolden, WhatGoesIntoNoise) {
  EXPECT_EQ(toBytes(writeNoisePrologue(kInitiator, kResponder, makeCounting<16>(0xa0))),
            readGolden("prologue.bin"));
  const auto bytes = writeSessionTerms({kInitiatorsSession, 3, 0});
  EXPECT_EQ(toBytes(bytes), readGolden("terms.bin"));
  const auto terms = readSessionTerms(bytes);
  ASSERT_TRUE(terms);
  EXPECT_EQ(terms->session, kInitiatorsSession);
  EXPECT_EQ(terms->key_epoch, 3);
  EXPECT_EQ(terms->minor, 0);
}

TEST(WireGolden, WhatGoesIntoSealing) {
  const Bytes state = readGolden("state_float32.bin");
  EXPECT_EQ(toBytes(writeAssociatedData(state.data(), kInitiator, kResponder)),
            readGolden("associated_data.bin"));
  const auto header = decodeHeader(viewOf(state));
  ASSERT_TRUE(header);
  const std::uint32_t salt = computeNonceSalt(header->sender, header->key_epoch);
  EXPECT_EQ(toBytes(writeNonce(salt, header->sequence)), readGolden("nonce.bin"));
}

}  // namespace
}  // namespace tandem
