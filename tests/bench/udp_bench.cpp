// Extra cost of sealing for a datagram through the loopback, in one run. Compares raw send and
// receive with write, seal, send, receive, open and read of a state of one device and one object.

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "tandem/plugin/udp_socket.h"

#include "net/peer_group.h"

namespace tandem {
namespace {

constexpr std::size_t kStateSize = 172;  // one device and one object, float32 [bytes]

struct Sockets {
  net::UdpSocket first{resolveAddress("127.0.0.1:0")}, second{resolveAddress("127.0.0.1:0")};
};

/// Median time from `send` to the end of `receive` in another thread, at one datagram a
/// millisecond. This is the delay of a state, including waking the receiver.
template <typename Send, typename Receive>
double measureOneWay(int count, Send send, Receive receive) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> ways;
  std::atomic<std::int64_t> sent{0};
  std::thread receiver([&] {
    for (int i = 0; i < count; ++i) {
      receive();
      ways.push_back(1e-9 * static_cast<double>(Clock::now().time_since_epoch().count() - sent));
    }
  });
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    sent = Clock::now().time_since_epoch().count();
    send();
  }
  receiver.join();
  std::nth_element(ways.begin(), ways.begin() + count / 2, ways.end());
  return ways[static_cast<std::size_t>(count / 2)];
}

void rawDatagram(benchmark::State& state) {
  Sockets sockets;
  const Address to = sockets.second.bound();
  std::array<std::uint8_t, kStateSize> bytes{};
  std::array<std::uint8_t, kMaxDatagramSize> room{};
  for (auto unused : state) {
    (void)unused;
    sockets.first.send({bytes.data(), bytes.size()}, to);
    while (!sockets.second.receive({room.data(), room.size()})) {
    }
  }
}
BENCHMARK(rawDatagram);

SecretKey makeKey() {
  std::array<std::uint8_t, SecretKey::kSize> bytes{};
  return SecretKey::take(bytes);
}

/// A live pair of sites.
struct SealedPair {
  SealedPair() {
    common.playout.is_on = false;
    std::vector<net::PeerGroup::Peer> peers;
    peers.push_back({PeerId{2}, sockets.second.bound(), makeKey()});
    first = std::make_unique<net::PeerGroup>(PeerId{1}, std::move(peers), common, sockets.first);
    peers.clear();
    peers.push_back({PeerId{1}, std::nullopt, makeKey()});
    second = std::make_unique<net::PeerGroup>(PeerId{2}, std::move(peers), common, sockets.second);
    packet.object_count = 1;
    while (second->status(PeerId{1}, now).phase != PeerPhase::kLive ||
           first->status(PeerId{2}, now).phase != PeerPhase::kLive) {
      now += 1e-3;
      first->advance(now);
      second->advance(now);
      take(sockets.first, *first);
      take(sockets.second, *second);
    }
  }
  void take(net::UdpSocket& socket, net::PeerGroup& mesh) {
    while (const auto got = socket.receive({room.data(), room.size()}))
      mesh.receive({room.data(), got->size}, got->from, now);
  }
  void send() {
    ++packet.sequence;
    first->link(PeerId{2}).send(packet, now);
  }
  bool receive() {
    take(sockets.second, *second);
    return second->link(PeerId{1}).receive(now, now + 1e-3).has_value();
  }

  Sockets sockets;
  net::PeerSession::Common common;
  std::unique_ptr<net::PeerGroup> first, second;
  StatePacket packet;
  double now = 1.0;
  std::array<std::uint8_t, kMaxDatagramSize> room{};
};

void sealedState(benchmark::State& state) {
  SealedPair pair;
  for (auto unused : state) {
    (void)unused;
    pair.now += 1e-6;
    pair.send();
    while (!pair.receive()) {
    }
  }
}
BENCHMARK(sealedState);

constexpr int kPaced = 2000;

/// Paces both variants in one run; counters are in microseconds.
void oneWay(benchmark::State& state) {
  for (auto unused : state) {
    (void)unused;
    Sockets sockets;
    const Address to = sockets.second.bound();
    std::array<std::uint8_t, kStateSize> bytes{};
    std::array<std::uint8_t, kMaxDatagramSize> room{};
    const double raw = measureOneWay(
        kPaced,
        [&] {
          sockets.first.send({bytes.data(), bytes.size()}, to);
        },
        [&] {
          while (!sockets.second.receive({room.data(), room.size()})) sockets.second.wait(1.0);
        });
    SealedPair pair;
    const double sealed = measureOneWay(
        kPaced, [&] { pair.send(); },
        [&] {
          while (!pair.receive()) pair.sockets.second.wait(1.0);
        });
    state.counters["raw_us"] = 1e6 * raw;
    state.counters["sealed_us"] = 1e6 * sealed;
    state.counters["ratio"] = sealed / raw;
  }
}
BENCHMARK(oneWay)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tandem
