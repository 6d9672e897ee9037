// Datagrams of a relay: what is written is read again, and every other byte is refused.

#include <gtest/gtest.h>

#include "relay/admission_wire.h"
#include "relay/relay_tags.h"
#include "relay/session_wire.h"
#include "support/random.h"

namespace tandem::relay {
namespace {

using Bytes = std::vector<std::uint8_t>;

ByteSpan span(Bytes& bytes) { return {bytes.data(), bytes.size()}; }
ByteView view(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

const Request kRequest{{5, 0x1122334455667788}, false, *makeRoomName("lab-1.x_"), {1, 2, 3}};

TEST(RelayWire, NamesOfRooms) {
  EXPECT_EQ(toString(*makeRoomName("a")), "a");
  EXPECT_EQ(toString(*makeRoomName(std::string(32, 'x'))), std::string(32, 'x'));
  for (const std::string& bad :
       {std::string(), std::string(33, 'x'), std::string("a b"), std::string("a\0b", 3),
        std::string("\xc3\xa4"), std::string("a/b"), std::string("a\n")})
    EXPECT_FALSE(makeRoomName(bad)) << bad;
}

TEST(RelayWire, RequestsAreReadAsWritten) {
  Bytes bytes(kJoinSize);
  ASSERT_EQ(encodeRequest(Type::kJoin, kRequest, span(bytes)), kJoinSize);
  const auto join = decodeRequest(view(bytes));
  ASSERT_TRUE(join);
  EXPECT_EQ(join->caller.member, 5);
  EXPECT_EQ(join->caller.nonce, 0x1122334455667788u);
  EXPECT_EQ(join->room, kRequest.room);
  EXPECT_EQ(join->cookie, kRequest.cookie);
}

TEST(RelayWire, LayoutOfHelloIsThatOfTheDocument) {
  Request hello = kRequest;
  hello.cookie = {};
  Bytes bytes(kHelloSize, 0xee);
  encodeRequest(Type::kHello, hello, span(bytes));
  const Bytes start = {0x54, 0x72, 1,    1,    5,    0,    0,   0,   0x88, 0x77,
                       0x66, 0x55, 0x44, 0x33, 0x22, 0x11, 'l', 'a', 'b'};
  EXPECT_TRUE(std::equal(start.begin(), start.end(), bytes.begin()));
}

TEST(RelayWire, EveryByteThatMustBeZeroIsChecked) {
  Request hello = kRequest;
  hello.cookie = {};
  Bytes bytes(kHelloSize - kLongTag);
  bytes.resize(kHelloSize);
  encodeRequest(Type::kHello, hello, span(bytes));
  for (std::size_t i = 48; i < kHelloSize - kLongTag; ++i) {
    bytes[i] = 1;
    EXPECT_FALSE(decodeRequest(view(bytes))) << i;
    bytes[i] = 0;
  }
  Bytes keep(kKeepSize);
  encodeKeep({7, 9}, 64, span(keep));
  for (std::size_t i = 18; i < kKeepSize - kShortTag; ++i) {
    keep[i] = 1;
    EXPECT_FALSE(decodeKeep(view(keep))) << i;
    keep[i] = 0;
  }
  EXPECT_EQ(decodeKeep(view(keep)), 64);
}

TEST(RelayWire, ForwardIsReadAsWritten) {
  Bytes bytes(kForwardHeader + 20 + kShortTag, 3);
  encodeForward({7, 9}, 64, 20, span(bytes));
  EXPECT_EQ(decodeForward(view(bytes)), 64);
  EXPECT_EQ(readHead(view(bytes)).session, 7u);
  EXPECT_EQ(readHead(view(bytes)).number, 9u);
  // Magic, version, type, receiver and zeros.
  for (const std::size_t i : {0, 1, 2, 3, 16, 17, 18, 19}) {
    bytes[i] ^= 0x80;
    EXPECT_FALSE(decodeForward(view(bytes))) << i;
    bytes[i] ^= 0x80;
  }
}

TEST(RelayWire, ForwardOfBadLengthIsRefused) {
  for (const std::size_t inner : {std::size_t{0}, std::size_t{19}, kMaxDatagramSize + 1}) {
    Bytes bytes(kForwardHeader + inner + kShortTag);
    encodeForward({7, 9}, 1, inner, span(bytes));
    EXPECT_FALSE(decodeForward(view(bytes))) << inner;
  }
}

TEST(RelayWire, ForwardedHasTheSenderAndTheSameInnerBytes) {
  Bytes bytes(kForwardHeader + 172 + kShortTag, 3);
  encodeForward({7, 9}, 64, 172, span(bytes));
  bytes.resize(turnForward(2, span(bytes)));
  const auto said = decodeForwarded(span(bytes));
  ASSERT_TRUE(said);
  EXPECT_EQ(said->from, 2);
  EXPECT_EQ(Bytes(said->inner.data, said->inner.data + said->inner.size), Bytes(172, 3));
}

TEST(RelayWire, KeptIsReadAsWritten) {
  Bytes bytes(kKeptSize);
  Kept kept{3, Address{{0xfd, 1}, 7001, 0}, 0x8000000000000005};
  encodeKept({7, 9}, kept, span(bytes));
  const auto read = decodeKept(view(bytes));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->asked, 3);
  EXPECT_EQ(read->address, kept.address);
  EXPECT_EQ(read->members, kept.members);
  kept.address.reset();
  encodeKept({7, 9}, kept, span(bytes));
  EXPECT_FALSE(decodeKept(view(bytes))->address);
}

TEST(RelayTags, AnyChangedByteIsNoticed) {
  const SecretKey key = SecretKey::generate();
  Bytes join(kJoinSize);
  encodeRequest(Type::kJoin, kRequest, span(join));
  tagLong(key, span(join));
  const SessionKey session_key = computeSessionKey(key, kRequest, 7);
  Bytes leave(kLeaveSize);
  encodeLeave({7, 9}, span(leave));
  tagShort(session_key, span(leave));
  EXPECT_TRUE(isTaggedLong(key, view(join)) && isTaggedShort(session_key, view(leave)));
  for (std::uint8_t& byte : join) {
    byte ^= 1;
    EXPECT_FALSE(isTaggedLong(key, view(join)));
    byte ^= 1;
  }
  for (std::uint8_t& byte : leave) {
    byte ^= 1;
    EXPECT_FALSE(isTaggedShort(session_key, view(leave)));
    byte ^= 1;
  }
}

TEST(RelayTags, EverySessionHasAnotherKey) {
  const SecretKey key = SecretKey::generate();
  const SessionKey one = computeSessionKey(key, kRequest, 7);
  Request other = kRequest;
  ++other.caller.nonce;
  EXPECT_NE(one, computeSessionKey(key, other, 7));
  EXPECT_NE(one, computeSessionKey(key, kRequest, 8));
  EXPECT_NE(one, computeSessionKey(SecretKey::generate(), kRequest, 7));
}

}  // namespace
}  // namespace tandem::relay
