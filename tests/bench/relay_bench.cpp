// Cost of a relay: of one forwarded datagram alone, of a full room at 128 Hz over the loopback, and
// the time that it adds to one datagram on an idle machine.

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "tandem/plugin/relay.h"

#include "net/relayed_address.h"
#include "relay/batch_socket.h"
#include "relay/relay.h"
#include "relay/relay_member.h"

namespace tandem {
namespace {

constexpr std::size_t kStateSize = 172;  // one device and one object, float32 [bytes]
using State = std::array<std::uint8_t, kStateSize>;

double clockNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

SecretKey makeKey() {
  std::array<std::uint8_t, SecretKey::kSize> bytes{};
  return SecretKey::take(bytes);
}

/// A member with a socket of its own.
struct Member {
  Member(const Address& relay, std::uint32_t id)
      : socket(resolveAddress("127.0.0.1:0")),
        member(relay, makeKey(), *relay::makeRoomName("bench"), PeerId{id}, 1, socket) {}

  void say(ByteView state, std::uint32_t to) {
    member.send(state, net::makeRelayedAddress(PeerId{to}));
  }
  /// Calls `take` with each datagram of another member.
  template <typename Take>
  void poll(Take take) {
    const double now = clockNow();
    while (const std::size_t count = socket.receive())
      for (std::size_t i = 0; i < count; ++i)
        if (const auto said = member.receive(socket.datagram(i), now)) take(*said);
    member.advance(now);
    socket.flush();
  }

  relay::BatchSocket socket;
  relay::RelayMember member;
};

/// A relay in a thread of its own, and its room.
struct Room {
  explicit Room(std::uint32_t count) : server(makeSettings(), makeKey()) {
    thread = std::thread([this] { run(); });
    for (std::uint32_t id = 1; id <= count; ++id)
      members.push_back(std::make_unique<Member>(server.bound(), id));
    while (
        std::any_of(members.begin(), members.end(), [](auto& one) { return !one->member.isIn(); }))
      for (auto& one : members) one->poll([](auto&) {});
  }
  ~Room() {
    is_ending = true;
    thread.join();
  }
  static RelaySettings makeSettings() {
    RelaySettings settings;
    settings.bind = resolveAddress("127.0.0.1:0");
    settings.rooms = 1;
    settings.members = 64;
    return settings;
  }
  void run() {
    while (!is_ending) {
      server.poll(clockNow());
      server.wait(0.01);
      timespec used{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
      cpu_ns = used.tv_sec * 1'000'000'000 + used.tv_nsec;
    }
  }

  RelayServer server;
  std::atomic<bool> is_ending{false};
  std::atomic<std::int64_t> cpu_ns{0};
  std::thread thread;
  std::vector<std::unique_ptr<Member>> members;
};

/// Takes what a relay forwards.
struct Sink final : net::Outlet {
  void send(ByteView datagram, const Address&) noexcept override {
    last.assign(datagram.data, datagram.data + datagram.size);
  }
  std::vector<std::uint8_t> last;
};

/// One datagram through the state machine, without a socket.
void relayStateMachine(benchmark::State& state) {
  Sink to_member, to_relay;
  Address here, there;
  here.port = 1, there.port = 2;
  relay::Relay relay(Room::makeSettings(), makeKey(), to_member);
  std::vector<std::unique_ptr<relay::RelayMember>> members;
  for (const std::uint32_t id : {1u, 2u}) {
    const Address& at = id == 1 ? here : there;
    members.push_back(std::make_unique<relay::RelayMember>(
        Address{}, makeKey(), *relay::makeRoomName("bench"), PeerId{id}, 1, to_relay));
    for (int i = 0; i < 2; ++i) {
      members.back()->advance(i);
      relay.receive({to_relay.last.data(), to_relay.last.size()}, at, i);
      (void)members.back()->receive({to_member.last.data(), to_member.last.size()}, i);
    }
  }
  State inner{};
  double now = 2.0;
  for (auto unused : state) {
    (void)unused;
    now += 1e-3;
    members[0]->send({inner.data(), inner.size()}, net::makeRelayedAddress(PeerId{2}));
    relay.receive({to_relay.last.data(), to_relay.last.size()}, here, now);
  }
  state.counters["forwarded"] =
      static_cast<double>(relay.counts().forwarded) / static_cast<double>(state.iterations());
}
BENCHMARK(relayStateMachine);

/// A room at 128 Hz, each to each, for two seconds: datagrams that one core would forward, its load
/// and losses.
void relayRoom(benchmark::State& state) {
  constexpr double kPeriod = 1.0 / 128.0, kFor = 2.0;  // [s]
  const auto count = static_cast<std::uint32_t>(state.range(0));
  Room room(count);
  const State inner{};
  std::uint64_t sent = 0, came = 0;
  const auto take = [&] {
    for (auto& one : room.members) one->poll([&](auto&) { ++came; });
  };
  for (auto unused : state) {
    (void)unused;
    const std::int64_t cpu = room.cpu_ns;
    const double began = clockNow();
    for (double next = began; next < began + kFor; next += kPeriod) {
      for (std::uint32_t from = 1; from <= count; ++from) {
        for (std::uint32_t to = 1; to <= count; ++to)
          if (to != from) room.members[from - 1]->say({inner.data(), inner.size()}, to), ++sent;
        room.members[from - 1]->socket.flush();
      }
      do take();
      while (clockNow() < next + kPeriod);
    }
    const double until = clockNow() + 0.2;
    while (clockNow() < until) take();
    const double used = 1e-9 * static_cast<double>(room.cpu_ns - cpu);
    state.counters["per_core_second"] = static_cast<double>(came) / used;
    state.counters["core"] = used / kFor;
    state.counters["lost"] = static_cast<double>(sent - came);
  }
}
BENCHMARK(relayRoom)->Arg(8)->Arg(16)->Arg(32)->Iterations(1)->Unit(benchmark::kMillisecond);

/// Times of `count` datagrams at 128 Hz from `send` to a thread that waits in `receive`, sorted.
template <typename Send, typename Receive>
std::vector<double> measureOneWays(int count, Send send, Receive receive) {
  std::vector<double> ways;
  std::atomic<double> sent{0.0};
  std::thread receiver([&] {
    for (int i = 0; i < count; ++i) {
      receive();
      ways.push_back(clockNow() - sent);
    }
  });
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(7812));
    sent = clockNow();
    send();
  }
  receiver.join();
  std::sort(ways.begin(), ways.end());
  return ways;
}

/// One datagram each 7.8 ms directly and by a relay.
void relayIdleLatency(benchmark::State& state) {
  constexpr int kCount = 500;
  const auto at = [](const std::vector<double>& ways, double share) {
    return 1e6 * ways[static_cast<std::size_t>(share * static_cast<double>(ways.size() - 1))];
  };
  const State inner{};
  for (auto unused : state) {
    (void)unused;
    net::UdpSocket first{resolveAddress("127.0.0.1:0")}, second{resolveAddress("127.0.0.1:0")};
    State room{};
    const auto direct = measureOneWays(
        kCount,
        [&] {
          first.send({inner.data(), inner.size()}, second.bound());
        },
        [&] {
          while (!second.receive({room.data(), room.size()})) second.wait(1.0);
        });
    Room relayed(2);
    const auto through = measureOneWays(
        kCount,
        [&] {
          relayed.members[0]->say({inner.data(), inner.size()}, 2);
          relayed.members[0]->socket.flush();
        },
        [&] {
          for (bool has_come = false; !has_come;) {
            relayed.members[1]->socket.wait(1.0);
            relayed.members[1]->poll([&](auto&) { has_come = true; });
          }
        });
    state.counters["direct_p50_us"] = at(direct, 0.5);
    state.counters["direct_p99_us"] = at(direct, 0.99);
    state.counters["relay_p50_us"] = at(through, 0.5);
    state.counters["relay_p99_us"] = at(through, 0.99);
  }
}
BENCHMARK(relayIdleLatency)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tandem
