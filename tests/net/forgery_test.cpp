// An attacker without the key sends datagrams to a live pair: none has an effect.

#include <gtest/gtest.h>

#include "net/virtual_net.h"

namespace tandem {
namespace {

using net::Refusal;
using test::Bytes;
using test::VirtualNet;
using test::VirtualSites;

void expectSame(const PeerStatus& before, const PeerStatus& after) {
  EXPECT_EQ(before.phase, after.phase);
  EXPECT_EQ(before.address, after.address);
  EXPECT_EQ(before.silence, after.silence);
  EXPECT_EQ(before.round_trip, after.round_trip);
  EXPECT_EQ(before.clock_offset, after.clock_offset);
  EXPECT_EQ(before.wait, after.wait);
  EXPECT_EQ(before.jitter, after.jitter);
  EXPECT_EQ(before.loss, after.loss);
  EXPECT_EQ(before.key_epoch, after.key_epoch);
  EXPECT_EQ(before.states_sent, after.states_sent);
  EXPECT_EQ(before.states_unsent, after.states_unsent);
  EXPECT_EQ(before.states_given, after.states_given);
  EXPECT_EQ(before.states_stale, after.states_stale);
  EXPECT_EQ(before.states_too_late, after.states_too_late);
  EXPECT_EQ(before.refused, after.refused);
  EXPECT_EQ(before.refused_version, after.refused_version);
  EXPECT_EQ(before.left, after.left);
  EXPECT_EQ(before.difference.has_value(), after.difference.has_value());
}

/// Makes forgeries from overheard datagrams, as an attacker on the way can.
class Forger {
 public:
  Forger(std::vector<Bytes> heard, std::uint64_t seed) : heard_(std::move(heard)), random_(seed) {}

  Bytes make() {
    Bytes bytes = heard_[below(heard_.size())];
    switch (random_.below(6)) {
      case 0:  // replayed
        break;
      case 1:  // changed
        bytes[below(bytes.size())] ^= static_cast<std::uint8_t>(1 << random_.below(8));
        break;
      case 2:  // cut
        bytes.resize(below(bytes.size()));
        break;
      case 3:  // numbered far ahead
        for (std::size_t k = 12; k < kHeaderSize; ++k) bytes[k] = 0x7f;
        break;
      case 4:  // random bytes under the next datagram's header
        writeNextHeader(bytes);
        fill(bytes, kHeaderSize);
        break;
      default:
        bytes.resize(1 + below(kMaxDatagramSize));
        fill(bytes, 0);
    }
    return bytes;
  }

  [[nodiscard]] bool isComingFromItsOwnAddress() { return random_.below(2) == 0; }

 private:
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(count)));
  }

  void fill(Bytes& bytes, std::size_t first) {
    for (std::size_t k = first; k < bytes.size(); ++k)
      bytes[k] = static_cast<std::uint8_t>(random_.below(256));
  }

  void writeNextHeader(Bytes& bytes) {
    constexpr std::array kSealed = {MessageType::kState,         MessageType::kAgree,
                                    MessageType::kAgreeAck,      MessageType::kBye,
                                    MessageType::kPathChallenge, MessageType::kPathResponse};
    ClearHeader header = *decodeHeader({heard_.back().data(), heard_.back().size()});
    header.type = kSealed[below(kSealed.size())];
    header.sequence += 1 + below(2000);
    bytes.assign(kHeaderSize + 1 + below(kMaxDatagramSize - kHeaderSize), 0);
    ASSERT_EQ(encodeHeader(header, {bytes.data(), bytes.size()}), kHeaderSize);
  }

  std::vector<Bytes> heard_;
  test::Random random_;
};

/// A HELLO from anyone gets a cookie, and a repeated OPEN the same answer. Neither changes state.
bool isAnswered(const Bytes& bytes) {
  if (bytes.size() <= 3) return false;
  const auto type = static_cast<MessageType>(bytes[3]);
  return type == MessageType::kHello || type == MessageType::kOpen;
}

// Replayed, changed, cut and far-ahead datagrams of a live pair, and random bytes with and without
// a right header. They come from a stranger and from the peer's own address.
TEST(Mesh, ForgedAndReplayedDatagramsChangeNothing) {
  constexpr std::uint64_t kSeed = 20090403;
  SCOPED_TRACE(kSeed);
  // scripts/soak.sh sends 1e8.
  const std::uint64_t count = test::readCount("TANDEM_FORGED_DATAGRAMS", 40000);
  for (const int victim : {1, 2}) {  // the initiator, the responder
    SCOPED_TRACE(victim);
    VirtualSites sites(2);
    std::vector<Bytes> heard;
    sites.net.tap = [&](const auto& bytes, const auto&, const auto& to) {
      if (to == VirtualNet::addressOf(victim)) heard.push_back(bytes);
    };
    ASSERT_TRUE(sites.goLive(1.0));
    sites.run(1.0);
    sites.net.tap = nullptr;
    sites.run(0.1);
    Forger forger(std::move(heard), kSeed);
    net::PeerGroup& mesh = *sites.at(victim).mesh;
    const std::size_t given = sites.at(victim).given[static_cast<std::size_t>(3 - victim)].size();
    const net::DatagramCounts before = mesh.counts();
    const PeerStatus status = sites.status(victim, 3 - victim);
    std::uint64_t thrown = 0;
    for (std::uint64_t i = 0; i < count / 2; ++i) {
      Bytes bytes = forger.make();
      const Address from =
          VirtualNet::addressOf(forger.isComingFromItsOwnAddress() ? 3 - victim : 9);
      if (isAnswered(bytes)) continue;
      mesh.receive({bytes.data(), bytes.size()}, from, sites.clock());
      ++thrown;
    }
    EXPECT_EQ(mesh.counts().taken, before.taken);
    EXPECT_EQ(mesh.counts().received, before.received + thrown);
    EXPECT_GT(mesh.counts().of(Refusal::kForged), before.of(Refusal::kForged) + thrown / 10);
    expectSame(status, sites.status(victim, 3 - victim));
    sites.run(0.5);
    EXPECT_GT(sites.at(victim).given[static_cast<std::size_t>(3 - victim)].size(), given + 55);
  }
}

// Replayed and changed OPENs: the keys in use stay.
TEST(Mesh, ReplayedAndForgedOpensChangeNothing) {
  VirtualSites sites(2);
  std::vector<Bytes> opens;
  sites.net.tap = [&](const auto& bytes, const auto&, const auto&) {
    if (bytes[3] == static_cast<std::uint8_t>(MessageType::kOpen)) opens.push_back(bytes);
  };
  ASSERT_TRUE(sites.goLive(1.0));
  sites.run(1.0);
  sites.net.tap = nullptr;
  ASSERT_FALSE(opens.empty());
  const PeerStatus status = sites.status(2, 1);
  const std::uint64_t sent = sites.at(2).port->bytes_sent;
  std::uint64_t thrown = 0;
  for (const int from : {1, 9}) {
    for (std::size_t k = 0; k < kOpenSize; ++k) {
      Bytes bytes = opens.front();
      if (k > 0) bytes[k] ^= 1U;
      sites.at(2).mesh->receive({bytes.data(), bytes.size()}, VirtualNet::addressOf(from),
                                sites.clock() + 0.1 * static_cast<double>(k));
      thrown += bytes.size();
    }
  }
  EXPECT_GT(sites.at(2).mesh->counts().of(Refusal::kKey), 0u);
  EXPECT_LT(sites.at(2).port->bytes_sent, sent + thrown);
  expectSame(status, sites.status(2, 1));
  sites.run(0.5);
  EXPECT_TRUE(sites.areLive());
  EXPECT_EQ(sites.status(2, 1).key_epoch, status.key_epoch);
}

}  // namespace
}  // namespace tandem
