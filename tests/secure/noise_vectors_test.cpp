// The handshake and the transport against published vectors; noise_vectors.json names their source.

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "secure/seal.h"
#include "secure/secure_support.h"
#include "support/checkout.h"

namespace tandem::test {
namespace {

struct Vectors {
  nlohmann::json all =
      nlohmann::json::parse(std::ifstream(test::inCheckout("tests/secure/noise_vectors.json")));

  [[nodiscard]] ByteVector bytes(const char* name) const {
    return fromHex(all.at(name).get<std::string>());
  }
  [[nodiscard]] ByteVector message(std::size_t number, const char* part) const {
    return fromHex(all.at("messages").at(number).at(part).get<std::string>());
  }
  [[nodiscard]] Pair makePair() const {
    const SecretKey shared = keyOf(bytes("psk"));
    return {shared, bytes("prologue"), keyOf(bytes("init_ephemeral")),
            keyOf(bytes("resp_ephemeral"))};
  }
};

TEST(NoiseVectors, Handshake) {
  const Vectors vectors;
  Pair pair = vectors.makePair();

  EXPECT_EQ(write(pair.initiator, vectors.message(0, "payload")), vectors.message(0, "ciphertext"));
  EXPECT_EQ(read(pair.responder, vectors.message(0, "ciphertext")), vectors.message(0, "payload"));
  EXPECT_EQ(write(pair.responder, vectors.message(1, "payload")), vectors.message(1, "ciphertext"));
  EXPECT_EQ(read(pair.initiator, vectors.message(1, "ciphertext")), vectors.message(1, "payload"));

  EXPECT_EQ(toHex(pair.initiator.hash()), vectors.all.at("handshake_hash"));
  EXPECT_EQ(toHex(pair.responder.hash()), vectors.all.at("handshake_hash"));
}

// With salt 0 and no associated data, sealing is Noise's own transport.
TEST(NoiseVectors, TransportAfterTheHandshake) {
  const Vectors vectors;
  Pair pair = vectors.makePair();
  ASSERT_TRUE(read(pair.responder, write(pair.initiator, vectors.message(0, "payload"))));
  ASSERT_TRUE(read(pair.initiator, write(pair.responder, vectors.message(1, "payload"))));
  auto of_initiator = pair.initiator.split(), of_responder = pair.responder.split();
  ASSERT_TRUE(of_initiator && of_responder);
  secure::Sealer sealers[] = {{std::move(of_initiator->send), 0},
                              {std::move(of_responder->send), 0}};
  const secure::Opener openers[] = {{std::move(of_responder->receive), 0},
                                    {std::move(of_initiator->receive), 0}};

  for (std::size_t number = 2; number < vectors.all.at("messages").size(); ++number) {
    SCOPED_TRACE("message " + std::to_string(number));
    const std::size_t side = number % 2;
    const ByteVector payload = vectors.message(number, "payload");
    ByteVector datagram = payload;
    datagram.resize(payload.size() + secure::kTagSize);
    const std::uint64_t sequence = sealers[side].nextSequence();
    ASSERT_TRUE(sealers[side].seal({}, datagram));
    EXPECT_EQ(datagram, vectors.message(number, "ciphertext"));
    ASSERT_TRUE(openers[side].open(sequence, {}, datagram));
    datagram.resize(payload.size());
    EXPECT_EQ(datagram, payload);
  }
}

}  // namespace
}  // namespace tandem::test
