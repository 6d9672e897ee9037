#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/wire/wire_handshake.h"
#include "wire/golden.h"

namespace tandem {
namespace {

using test::Bytes;
using test::collect;
using test::readGolden;
using test::viewOf;

constexpr PeerId kLow{1};
constexpr PeerId kHigh{8};
const HandshakeRoute kThere{kLow, kHigh, 5};
const HandshakeRoute kBack{kHigh, kLow, 5};

TEST(WireHandshake, EveryAnswerIsShorter) {
  EXPECT_LT(kCookieSize, kHelloSize);
  EXPECT_LT(kAcceptSize, kOpenSize);
  EXPECT_LT(kRefuseSize, kOpenSize);
}

TEST(WireHandshake, EachAnswerHasItsSide) {
  EXPECT_TRUE(collect([](ByteSpan out) { return encodeCookie({kThere, {}, {}}, out); }).empty());
  EXPECT_TRUE(collect([](ByteSpan out) {
                return encodeOpen({kBack, 1, {}, {}, {}}, out);
              }).empty());
  EXPECT_TRUE(collect([](ByteSpan out) { return encodeAccept({kThere, 1, 1, {}}, out); }).empty());
  for (const HandshakeRoute& route : {kThere, kBack}) {
    EXPECT_FALSE(collect([&](ByteSpan out) { return encodeHello({route, {}}, out); }).empty());
    const RefuseMessage refuse{route, RefuseCode::kBusy, 1};
    EXPECT_FALSE(collect([&](ByteSpan out) { return encodeRefuse(refuse, out); }).empty());
  }
}

TEST(WireHandshake, SendersKeepToTheStandard) {
  for (const std::uint32_t bad : {0U, kMaxPeerId + 1, 65537U}) {
    const HelloMessage from{{PeerId{bad}, kHigh, 5}, {}}, to{{kLow, PeerId{bad}, 5}, {}};
    EXPECT_TRUE(collect([&](ByteSpan out) { return encodeHello(from, out); }).empty()) << bad;
    EXPECT_TRUE(collect([&](ByteSpan out) { return encodeHello(to, out); }).empty()) << bad;
  }
  EXPECT_TRUE(collect([](ByteSpan out) {
                return encodeOpen({kThere, 0, {}, {}, {}}, out);
              }).empty());
  EXPECT_TRUE(collect([](ByteSpan out) { return encodeAccept({kBack, 0, 1, {}}, out); }).empty());
  EXPECT_TRUE(collect([](ByteSpan out) { return encodeAccept({kBack, 1, 0, {}}, out); }).empty());
  for (const RefuseCode code : {RefuseCode{0}, RefuseCode{6}}) {
    const RefuseMessage refuse{kBack, code, 1};
    EXPECT_TRUE(collect([&](ByteSpan out) { return encodeRefuse(refuse, out); }).empty());
  }
}

TEST(WireHandshake, WritesNothingWithoutRoom) {
  Bytes bytes(kHelloSize, 0xee);
  const auto shortBy1 = [&bytes](std::size_t size) { return ByteSpan{bytes.data(), size - 1}; };
  EXPECT_EQ(encodeHello({kThere, {}}, shortBy1(kHelloSize)), 0U);
  EXPECT_EQ(encodeCookie({kBack, {}, {}}, shortBy1(kCookieSize)), 0U);
  EXPECT_EQ(encodeOpen({kThere, 1, {}, {}, {}}, shortBy1(kOpenSize)), 0U);
  EXPECT_EQ(encodeAccept({kBack, 1, 1, {}}, shortBy1(kAcceptSize)), 0U);
  EXPECT_EQ(encodeRefuse({kBack, RefuseCode::kKey, 1}, shortBy1(kRefuseSize)), 0U);
  EXPECT_EQ(encodeHeader({}, shortBy1(kHeaderSize)), 0U);
  EXPECT_EQ(encodeBye(ByeReason::kFault, shortBy1(kByeSize)), 0U);
  EXPECT_EQ(bytes, Bytes(kHelloSize, 0xee));
}

TEST(WireHandshake, HeadersKeepToTheStandard) {
  const ClearHeader good = test::makeHeader(MessageType::kState, 1);
  const auto encode = [](const ClearHeader& header) {
    return collect([&](ByteSpan out) { return encodeHeader(header, out); }).size();
  };
  EXPECT_EQ(encode(good), kHeaderSize);
  std::vector<ClearHeader> bad(6, good);
  bad[0].session = 0;
  bad[1].sender = PeerId{0};
  bad[2].sender = PeerId{65537};
  bad[3].key_epoch = 0;
  bad[4].version = kWireVersion + 1;
  bad[5].type = MessageType{6};
  for (const ClearHeader& header : bad) EXPECT_EQ(encode(header), 0U);
}

TEST(WireHandshake, ByesHaveAKnownReason) {
  std::uint8_t byte = 0;
  EXPECT_EQ(encodeBye(ByeReason::kConfigurationsDiffer, {&byte, 1}), kByeSize);
  EXPECT_EQ(encodeBye(ByeReason{4}, {&byte, 1}), 0U);
}

TEST(WireHandshake, HelloOfAnotherVersionIsAnswered) {
  Bytes hello = readGolden("hello.bin");
  Bytes answer(kRefuseSize);
  const ByteSpan out{answer.data(), answer.size()};
  EXPECT_EQ(encodeVersionRefusal(viewOf(hello), out), 0U) << "it is of ours";
  hello[2] = 9;
  ASSERT_EQ(encodeVersionRefusal(viewOf(hello), out), kRefuseSize);
  const auto refuse = decodeRefuse(viewOf(answer));
  ASSERT_TRUE(refuse);
  EXPECT_EQ(refuse->route.sender, test::kResponder);
  EXPECT_EQ(refuse->route.receiver, test::kInitiator);
  EXPECT_EQ(refuse->route.nonce, test::kNonce);
  EXPECT_EQ(refuse->code, RefuseCode::kVersion);
  EXPECT_EQ(refuse->version, kWireVersion);

  hello[48] = 1;  // invalid in any version of HELLO
  EXPECT_EQ(encodeVersionRefusal(viewOf(hello), out), 0U);
  Bytes other = readGolden("open.bin");
  other[2] = 9;
  EXPECT_EQ(encodeVersionRefusal(viewOf(other), out), 0U);
}

}  // namespace
}  // namespace tandem
