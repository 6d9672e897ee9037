// The handshake succeeds for two sites with the same key, and refuses all others.

#include "secure/handshake.h"

#include <gtest/gtest.h>

#include "secure/secure_support.h"

namespace tandem::test {
namespace {

const ByteVector kPrologue = bytesOf("tandem/1 sites 1 and 2");

void complete(Pair& pair) {
  ASSERT_TRUE(read(pair.responder, write(pair.initiator)));
  ASSERT_TRUE(read(pair.initiator, write(pair.responder)));
}

TEST(Handshake, BothSidesAgreeOnKeysForEachDirection) {
  constexpr std::uint64_t kSeed = 7;
  Draw draw(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
    Pair pair(draw.key(), draw.bytes(draw.below(64)).size() % 2 ? kPrologue : ByteVector{});
    const ByteVector first = draw.bytes(draw.below(300)), second = draw.bytes(draw.below(300));
    ASSERT_EQ(read(pair.responder, write(pair.initiator, first)), first);
    ASSERT_EQ(read(pair.initiator, write(pair.responder, second)), second);
    EXPECT_TRUE(pair.initiator.isComplete() && pair.responder.isComplete());
    EXPECT_EQ(pair.initiator.hash(), pair.responder.hash());

    const auto of_initiator = pair.initiator.split(), of_responder = pair.responder.split();
    ASSERT_TRUE(of_initiator && of_responder);
    EXPECT_TRUE(of_initiator->send.equals(of_responder->receive));
    EXPECT_TRUE(of_initiator->receive.equals(of_responder->send));
    EXPECT_FALSE(of_initiator->send.equals(of_initiator->receive));
  }
}

TEST(Handshake, EachOneGivesOtherKeysAndAnotherHash) {
  const SecretKey shared = SecretKey::generate();
  Pair one(shared, kPrologue), two(shared, kPrologue);
  complete(one);
  complete(two);
  EXPECT_NE(one.initiator.hash(), two.initiator.hash());
  EXPECT_FALSE(one.initiator.split()->send.equals(two.initiator.split()->send));
}

TEST(Handshake, RefusesAnotherKey) {
  secure::Initiator initiator(SecretKey::generate(), kPrologue);
  secure::Responder responder(SecretKey::generate(), kPrologue);
  EXPECT_FALSE(read(responder, write(initiator)));
}

TEST(Handshake, RefusesAnotherPrologue) {
  const SecretKey shared = SecretKey::generate();
  secure::Initiator initiator(shared, kPrologue);
  secure::Responder responder(shared, bytesOf("tandem/1 sites 1 and 3"));
  EXPECT_FALSE(read(responder, write(initiator)));
}

TEST(Handshake, RefusesTheAnswerToAnotherHandshake) {
  const SecretKey shared = SecretKey::generate();
  Pair one(shared, kPrologue), two(shared, kPrologue);
  ASSERT_TRUE(read(one.responder, write(one.initiator)));
  ASSERT_TRUE(read(two.responder, write(two.initiator)));
  const ByteVector answer = write(one.responder), other = write(two.responder);
  EXPECT_FALSE(read(one.initiator, other));
  EXPECT_TRUE(read(one.initiator, answer));
}

TEST(Handshake, RefusesItsOwnMessageSentBack) {
  const SecretKey shared = SecretKey::generate();
  Pair pair(shared, kPrologue);
  const ByteVector first = write(pair.initiator);
  EXPECT_FALSE(read(pair.initiator, first));
  ASSERT_TRUE(read(pair.responder, first));
  EXPECT_TRUE(read(pair.initiator, write(pair.responder)));
}

TEST(Handshake, RefusesBuffersThatAreTooSmall) {
  Pair pair(SecretKey::generate(), kPrologue);
  const ByteVector payload = bytesOf("payload");
  ByteVector small(payload.size() + secure::kHandshakeOverhead - 1);
  EXPECT_FALSE(pair.initiator.writeMessage(payload, small));

  const ByteVector message = write(pair.initiator, payload);
  ByteVector room(payload.size() - 1, 0xaa);
  EXPECT_FALSE(pair.responder.readMessage(message, room));
  EXPECT_EQ(room, ByteVector(payload.size() - 1, 0xaa));
  EXPECT_EQ(read(pair.responder, message), payload);
}

TEST(Handshake, RefusesMessagesThatAreTooLong) {
  Pair pair(SecretKey::generate(), kPrologue);
  ByteVector message(70000);
  EXPECT_FALSE(pair.initiator.writeMessage(ByteVector(65535 - 47), message));
  EXPECT_EQ(pair.initiator.writeMessage(ByteVector(65535 - 48), message), 65535U);
  message.resize(65536);
  EXPECT_FALSE(read(pair.responder, message));
  message.resize(65535);
  EXPECT_TRUE(read(pair.responder, message));
}

TEST(Handshake, GivesNothingOutOfTurn) {
  Pair pair(SecretKey::generate(), kPrologue);
  EXPECT_TRUE(write(pair.responder).empty());
  EXPECT_FALSE(read(pair.initiator, ByteVector(100)));
  EXPECT_FALSE(pair.initiator.split() || pair.responder.split());

  const ByteVector first = write(pair.initiator);
  EXPECT_TRUE(write(pair.initiator).empty());
  EXPECT_FALSE(pair.initiator.split());
  ASSERT_TRUE(read(pair.responder, first));
  EXPECT_FALSE(read(pair.responder, first));
  EXPECT_FALSE(pair.responder.split());

  const ByteVector second = write(pair.responder);
  EXPECT_TRUE(write(pair.responder).empty());
  ASSERT_TRUE(read(pair.initiator, second));
  EXPECT_FALSE(read(pair.initiator, second));
  EXPECT_TRUE(pair.initiator.split() && pair.responder.split());
  EXPECT_FALSE(pair.initiator.split() || pair.responder.split());
}

TEST(Handshake, RefusesAKeyThatWasMovedAway) {
  SecretKey key = SecretKey::generate();
  const SecretKey taken = std::move(key);
  EXPECT_THROW(secure::Initiator(key, kPrologue), std::invalid_argument);
  EXPECT_THROW(secure::Responder(taken, kPrologue, std::move(key)), std::invalid_argument);
}

// Points whose product with any secret is zero (RFC 7748, section 6.1), from a peer that has the
// key.
TEST(Handshake, RefusesPointsOfLowOrder) {
  const char* const kPoints[] = {
      "0000000000000000000000000000000000000000000000000000000000000000",
      "0100000000000000000000000000000000000000000000000000000000000000",
      "ecffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
      "edffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
      "eeffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
      "e0eb7a7c3b41b8ae1656e3faf19fc46ada098deb9c32b1fd866205165f49b800",
      "5f9c95bca3508c24b1d0b1559c83ef5b04445cc4581c8e86d8224eddd09f1157",
  };
  constexpr std::string_view kName = "Noise_NNpsk0_25519_ChaChaPoly_BLAKE2b";
  const SecretKey shared = SecretKey::generate();
  for (const char* point : kPoints) {
    SCOPED_TRACE(point);
    const ByteVector low = fromHex(point);
    secure::SymmetricState state{};
    state.start(bytesOf(kName));
    state.mixHash(kPrologue);
    state.mixKeyAndHash({shared.data(), SecretKey::kSize});
    state.mixHash(low);
    state.mixKey(low);
    ByteVector message = low;
    message.resize(secure::kHandshakeOverhead);
    state.encryptAndHash({}, secure::Bytes(message).subspan(low.size()));

    secure::Responder responder(shared, kPrologue);
    ASSERT_TRUE(read(responder, message));
    EXPECT_TRUE(write(responder).empty());
    EXPECT_FALSE(responder.split());
  }
}

TEST(Handshake, ForgedMessagesNeverOpenAndChangeNothing) {
  constexpr std::uint64_t kSeed = 11;
  constexpr int kToResponder = 100000, kToInitiator = 3000;  // the latter cost an X25519 each
  Draw draw(kSeed);
  Pair pair(draw.key(), kPrologue, draw.key(), draw.key());
  const ByteVector payload = draw.bytes(20);
  const auto forge = [&](auto& side, const ByteVector& right, int count) {
    const auto hash = side.hash();
    for (int trial = 0; trial < count; ++trial)
      ASSERT_FALSE(read(side, draw.forge(right))) << "seed " << kSeed << ", trial " << trial;
    EXPECT_EQ(side.hash(), hash);
  };

  const ByteVector first = write(pair.initiator, payload);
  forge(pair.responder, first, kToResponder);
  ASSERT_EQ(read(pair.responder, first), payload);
  const ByteVector second = write(pair.responder, payload);
  forge(pair.initiator, second, kToInitiator);
  ASSERT_EQ(read(pair.initiator, second), payload);
  EXPECT_TRUE(pair.initiator.split()->send.equals(pair.responder.split()->receive));
}

TEST(Handshake, ARefusedMessageLeavesNoText) {
  Pair pair(SecretKey::generate(), kPrologue);
  ByteVector message = write(pair.initiator, bytesOf("payload"));
  message.back() ^= 1;
  ByteVector payload(7, 0xaa);
  EXPECT_FALSE(pair.responder.readMessage(message, payload));
  EXPECT_TRUE(payload == ByteVector(7, 0xaa) || payload == ByteVector(7, 0));
}

}  // namespace
}  // namespace tandem::test
