// Sealing and opening of datagrams. Only sealed datagrams open, and no nonce repeats.

#include "secure/seal.h"

#include <limits>
#include <set>
#include <type_traits>

#include <gtest/gtest.h>

#include "coordination/src/wire/wire_sealing.h"
#include "secure/secure_support.h"

namespace tandem::test {
namespace {

using secure::kTagSize;
using secure::Opener;
using secure::Sealer;

static_assert(!std::is_copy_constructible_v<Sealer> && !std::is_copy_assignable_v<Sealer>);

const ByteVector kHeader = bytesOf("twenty bytes, clear.");

ByteVector seal(Sealer& sealer, const ByteVector& text, const ByteVector& header = kHeader) {
  ByteVector datagram = text;
  datagram.resize(text.size() + kTagSize);
  EXPECT_TRUE(sealer.seal(header, datagram));
  return datagram;
}

TEST(Nonce, IsSaltThenSequenceLowestByteFirst) {
  EXPECT_EQ(toHex(writeNonce(0x01020304, 0x1122334455667788)), "040302018877665544332211");
  EXPECT_EQ(toHex(writeNonce(0, 1)), "000000000100000000000000");
}

TEST(Seal, OpensToWhatWasSealed) {
  constexpr std::uint64_t kSeed = 3;
  Draw draw(kSeed);
  for (int trial = 0; trial < 2000; ++trial) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
    const SecretKey key = draw.key();
    const auto salt = static_cast<std::uint32_t>(draw.number());
    Sealer sealer(copyOf(key), salt);
    const Opener opener(copyOf(key), salt);
    const ByteVector text = draw.bytes(draw.below(1200)), header = draw.bytes(draw.below(40));
    for (std::uint64_t sequence = 0; sequence < 3; ++sequence) {
      ASSERT_EQ(sealer.nextSequence(), sequence);
      ByteVector datagram = seal(sealer, text, header);
      ASSERT_TRUE(opener.open(sequence, header, datagram));
      datagram.resize(text.size());
      ASSERT_EQ(datagram, text);
    }
  }
}

TEST(Seal, RefusesAtItsLimitForGood) {
  Sealer sealer(SecretKey::generate(), 0, 3);
  for (int i = 0; i < 3; ++i) seal(sealer, bytesOf("text"));
  for (int i = 0; i < 3; ++i) {
    ByteVector datagram(20, 0xaa);
    EXPECT_FALSE(sealer.seal(kHeader, datagram));
    EXPECT_EQ(datagram, ByteVector(20, 0xaa));
    EXPECT_EQ(sealer.nextSequence(), 3U);
  }
}

TEST(Seal, RefusesWithoutRoomForTheTag) {
  Sealer sealer(SecretKey::generate(), 0);
  ByteVector datagram(kTagSize - 1, 0xaa);
  EXPECT_FALSE(sealer.seal(kHeader, datagram));
  EXPECT_FALSE(sealer.seal(kHeader, {}));
  EXPECT_EQ(datagram, ByteVector(kTagSize - 1, 0xaa));
  EXPECT_EQ(sealer.nextSequence(), 0U);
}

TEST(Seal, AMovedSealerGoesOnAndTheOldOneSealsNothing) {
  Sealer old(SecretKey::generate(), 0);
  seal(old, bytesOf("text"));
  Sealer sealer = std::move(old);
  EXPECT_EQ(sealer.nextSequence(), 1U);
  seal(sealer, bytesOf("text"));
  ByteVector datagram(20);
  EXPECT_FALSE(old.seal(kHeader, datagram));

  Opener gone(SecretKey::generate(), 0);
  const Opener opener = std::move(gone);
  EXPECT_FALSE(gone.open(0, kHeader, datagram));
}

// Zeros seal to the key stream itself. Two datagrams have the same one only for equal key and
// nonce.
TEST(Seal, NoNonceComesTwiceOverRekeys) {
  constexpr int kEpochs = 200;
  constexpr std::uint64_t kLimit = 50;
  const SecretKey shared = SecretKey::generate();
  std::set<ByteVector> streams;
  std::size_t sealed = 0;
  for (std::uint16_t epoch = 0; epoch < kEpochs; ++epoch) {
    Pair pair(shared, {});
    ASSERT_TRUE(read(pair.responder, write(pair.initiator)));
    ASSERT_TRUE(read(pair.initiator, write(pair.responder)));
    Sealer sealers[] = {
        {std::move(pair.initiator.split()->send), computeNonceSalt(PeerId{1}, epoch), kLimit},
        {std::move(pair.responder.split()->send), computeNonceSalt(PeerId{2}, epoch), kLimit}};
    for (Sealer& sealer : sealers) {
      ByteVector datagram(32 + kTagSize);
      while (sealer.seal(kHeader, datagram)) {
        ++sealed;
        datagram.resize(32);
        EXPECT_TRUE(streams.insert(datagram).second) << "epoch " << epoch;
        datagram.assign(32 + kTagSize, 0);
      }
    }
  }
  EXPECT_EQ(sealed, 2 * kEpochs * kLimit);
  EXPECT_EQ(streams.size(), sealed);
}

class WrongDatagram : public ::testing::Test {
 protected:
  void expectRefused(const Opener& tried, std::uint64_t sequence, const ByteVector& header,
                     ByteVector datagram) const {
    const ByteVector before = datagram;
    EXPECT_FALSE(tried.open(sequence, header, datagram));
    ASSERT_EQ(datagram.size(), before.size());
    // The datagram is unchanged, or its text is wiped.
    if (datagram != before) {
      datagram.resize(datagram.size() - kTagSize);
      EXPECT_EQ(datagram, ByteVector(datagram.size(), 0));
    }
  }

  const SecretKey key = SecretKey::generate();
  Sealer sealer{copyOf(key), 5};
  const Opener opener{copyOf(key), 5};
  const ByteVector right = seal(sealer, bytesOf("the cube is here"));
};

TEST_F(WrongDatagram, OfAnotherKeySaltOrSequence) {
  expectRefused(Opener(SecretKey::generate(), 5), 0, kHeader, right);
  expectRefused(Opener(copyOf(key), 6), 0, kHeader, right);
  expectRefused(opener, 1, kHeader, right);
  expectRefused(opener, std::numeric_limits<std::uint64_t>::max(), kHeader, right);
  ByteVector datagram = right;
  EXPECT_TRUE(opener.open(0, kHeader, datagram));
}

TEST_F(WrongDatagram, UnderAnotherHeader) {
  for (std::size_t i = 0; i < kHeader.size(); ++i) {
    ByteVector header = kHeader;
    header[i] ^= 1;
    expectRefused(opener, 0, header, right);
  }
  expectRefused(opener, 0, {}, right);
  ByteVector longer = kHeader;
  longer.push_back(0);
  expectRefused(opener, 0, longer, right);
}

TEST_F(WrongDatagram, TruncatedAtEachByte) {
  for (std::size_t size = 0; size < right.size(); ++size)
    expectRefused(opener, 0, kHeader,
                  ByteVector(right.begin(), right.begin() + static_cast<long>(size)));
}

TEST_F(WrongDatagram, WithEachBitTurned) {
  for (std::size_t bit = 0; bit < 8 * right.size(); ++bit) {
    ByteVector wrong = right;
    wrong[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    expectRefused(opener, 0, kHeader, wrong);
  }
}

TEST_F(WrongDatagram, ForgedInAnyWay) {
  constexpr std::uint64_t kSeed = 5;
  Draw draw(kSeed);
  for (int trial = 0; trial < 100000; ++trial) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", trial " + std::to_string(trial));
    expectRefused(opener, draw.below(2), kHeader, draw.forge(right));
    if (HasFailure()) return;
  }
  ByteVector datagram = right;
  EXPECT_TRUE(opener.open(0, kHeader, datagram));
}

}  // namespace
}  // namespace tandem::test
