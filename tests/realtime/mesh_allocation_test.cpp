// States of two live sites over real sockets allocate nothing, nor does a flood of forged
// datagrams. Time is passed in: keys are made once, and renewed only after the end.

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tandem/coordination/link.h"
#include "tandem/plugin/udp_mesh.h"
#include "tandem/plugin/udp_socket.h"

#include "realtime/allocation_count.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1.0 / 128;  // [s]
constexpr double kPatience = 10.0;     ///< longest wait for the machine [s]
constexpr std::uint64_t kMostPerPoll = 128;

SecretKey makeKey() {
  std::array<std::uint8_t, SecretKey::kSize> bytes;
  bytes.fill(0x42);
  return SecretKey::take(bytes);
}

/// Two sites. Datagrams from site 1 to site 2 pass a socket of ours. So we hear them and can speak
/// from the address that site 2 believes to be site 1's.
class Pair {
 public:
  Pair() : between_(resolveAddress("127.0.0.1:0")) {
    UdpMeshSettings settings;
    settings.bind = resolveAddress("127.0.0.1:0");
    settings.self = PeerId{2};
    std::vector<UdpPeer> peers;
    peers.push_back({PeerId{1}, std::nullopt, makeKey()});
    second = std::make_unique<UdpMesh>(settings, std::move(peers));
    settings.self = PeerId{1};
    peers.clear();
    peers.push_back({PeerId{2}, between_.bound(), makeKey()});
    first = std::make_unique<UdpMesh>(settings, std::move(peers));
  }

  /// Both sites send a state, and receive the other's.
  void tick() {
    now += kPeriod;
    StatePacket packet;
    packet.sequence = sent++;
    packet.time = now;
    first->poll(now);
    first->link(PeerId{2}).send(packet, now);
    between_.wait(kPatience);
    forward();
    second->wait(kPatience);
    second->poll(now);
    second->link(PeerId{1}).send(packet, now);
    between_.wait(kPatience);
    forward();
    first->wait(kPatience);
    first->poll(now);
    while (first->link(PeerId{2}).receive(now, now + kPeriod)) ++given_to_first;
    while (second->link(PeerId{1}).receive(now, now + kPeriod)) ++given_to_second;
  }

  /// Sends site 1's newest state from site 1's apparent address: a replay, or under a future
  /// number.
  void forge(bool is_again) {
    std::array<std::uint8_t, kMaxDatagramSize> forged = heard_;
    if (!is_again) ++forged[13];  // the sequence's second byte
    between_.send({forged.data(), heard_size_}, second->bound());
  }

  /// Lets site 2 receive all that is there. Returns the largest count of one poll.
  std::uint64_t drain() {
    std::uint64_t most = 0;
    for (std::uint64_t before = second->received() + 1; before != second->received();) {
      before = second->received();
      second->poll(now);
      most = std::max(most, second->received() - before);
    }
    return most;
  }

  void goLive() {
    for (int i = 0; i < 1000 && !areLive(); ++i) {
      now += kPeriod;
      first->poll(now);
      forward();
      second->poll(now);
      forward();
    }
    ASSERT_TRUE(areLive());
    for (int i = 0; i < 300; ++i) tick();
  }

  double now = 0.0;  // [s]
  std::uint64_t sent = 0, given_to_first = 0, given_to_second = 0;
  std::unique_ptr<UdpMesh> first, second;

 private:
  void forward() {
    std::array<std::uint8_t, kMaxDatagramSize> room;
    while (const auto received = between_.receive({room.data(), room.size()})) {
      const bool is_there = received->from == first->bound();
      if (is_there) {
        heard_ = room;
        heard_size_ = received->size;
      }
      between_.send({room.data(), received->size}, (is_there ? second : first)->bound());
    }
  }
  [[nodiscard]] bool areLive() const {
    return first->status(PeerId{2}, now).phase == PeerPhase::kLive &&
           second->status(PeerId{1}, now).phase == PeerPhase::kLive;
  }

  net::UdpSocket between_;
  std::array<std::uint8_t, kMaxDatagramSize> heard_{};
  std::size_t heard_size_ = 0;
};

std::uint64_t countRefused(const UdpMesh& mesh, const std::string& reason) {
  std::uint64_t count = 0;
  for (const RefusedDatagrams& one : mesh.refused())
    if (one.reason == reason) count += one.count;
  return count;
}

TEST(MeshAllocation, NoneForAState) {
  Pair pair;
  pair.goLive();
  const std::uint16_t epoch = pair.first->status(PeerId{2}, pair.now).key_epoch;
  const std::uint64_t given = pair.given_to_first + pair.given_to_second;
  const test::AllocationCount count;
  for (int i = 0; i < 10000; ++i) pair.tick();
  EXPECT_EQ(count.count(), 0U);
  EXPECT_EQ(pair.given_to_first + pair.given_to_second, given + 20000);
  EXPECT_EQ(pair.first->status(PeerId{2}, pair.now).key_epoch, epoch);
}

TEST(MeshAllocation, NoneInAFlood) {
  Pair pair;
  pair.goLive();
  constexpr int kTicks = 1000, kForged = 150;
  const std::uint64_t given = pair.given_to_second;
  const std::uint64_t forged = countRefused(*pair.second, "forged");
  const std::uint64_t replayed = countRefused(*pair.second, "replayed");
  std::uint64_t most = 0;
  {
    const test::AllocationCount count;
    for (int i = 0; i < kTicks; ++i) {
      for (int k = 0; k < kForged; ++k) pair.forge(k % 2 == 0);
      most = std::max(most, pair.drain());
      pair.tick();
    }
    pair.second->wait(0.01);
    (void)pair.drain();
    EXPECT_EQ(count.count(), 0U);
  }
  EXPECT_EQ(most, kMostPerPoll);
  // Each forgery is refused, and the states still arrive.
  constexpr std::uint64_t kHalf = std::uint64_t{kTicks} * kForged / 2;
  EXPECT_EQ(countRefused(*pair.second, "forged"), forged + kHalf);
  EXPECT_EQ(countRefused(*pair.second, "replayed"), replayed + kHalf);
  EXPECT_GE(pair.given_to_second, given + kTicks - 1);
}

}  // namespace
}  // namespace tandem
