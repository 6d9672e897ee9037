#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include "net/peer_group.h"
#include "support/random.h"

namespace tandem::test {

using Bytes = std::vector<std::uint8_t>;

/// Amount of work of a test: the number in this environment variable, or else `usual`.
inline std::uint64_t readCount(const char* variable, std::uint64_t usual) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : usual;
}

/// Conditions that a virtual network applies to datagrams.
struct NetConditions {
  double delay = 0.02, jitter = 0.0;  // [s]
  double loss = 0.0, duplicate = 0.0, corrupt = 0.0;
};

/// Sites with a mesh each, and the network between them in virtual time.
class VirtualNet {
 public:
  struct Datagram {
    double due = 0.0;
    std::uint64_t number = 0;
    Address from, to;
    Bytes bytes;
  };

  explicit VirtualNet(const NetConditions& usual = {}, std::uint64_t seed = 1)
      : conditions(usual), random_(seed) {}

  static Address addressOf(int site) {
    Address address;
    address.ip[10] = address.ip[11] = 0xff;
    address.ip[12] = 10;
    address.ip[15] = static_cast<std::uint8_t>(site);
    address.port = 7000;
    return address;
  }

  /// A port of the network, for sites and strangers.
  class Port final : public net::Outlet {
   public:
    Port(VirtualNet& owner, const Address& own) : address(own), owner_(owner) {}
    void send(ByteView datagram, const Address& to) noexcept override {
      bytes_sent += datagram.size;
      owner_.carry({datagram.data, datagram.data + datagram.size}, address, to);
    }

    Address address;
    std::uint64_t bytes_sent = 0;

   private:
    VirtualNet& owner_;
  };

  void carry(Bytes bytes, const Address& from, const Address& to) {
    if (tap) tap(bytes, from, to);
    const NetConditions way = conditions_between ? conditions_between(from, to) : conditions;
    if (is_down || random_.uniform(0, 1) < way.loss) return;
    const int copies = random_.uniform(0, 1) < way.duplicate ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      Datagram datagram{now + way.delay + random_.uniform(0, 1) * way.jitter, number_++, from, to,
                        bytes};
      if (random_.uniform(0, 1) < way.corrupt)
        datagram.bytes[static_cast<std::size_t>(random_.below(static_cast<int>(bytes.size())))] ^=
            static_cast<std::uint8_t>(1 << random_.below(8));
      flying_.push_back(std::move(datagram));
      std::push_heap(flying_.begin(), flying_.end(), &comesLater);
    }
  }

  /// Delivers all datagrams due until `time`, through `take`.
  template <typename Take>
  void deliverUntil(double time, Take take) {
    while (!flying_.empty() && flying_.front().due <= time) {
      std::pop_heap(flying_.begin(), flying_.end(), &comesLater);
      Datagram datagram = std::move(flying_.back());
      flying_.pop_back();
      now = datagram.due;
      take(datagram);
    }
    now = time;
  }

  NetConditions conditions;
  /// Conditions of one way, instead of the usual ones; empty: all are alike.
  std::function<NetConditions(const Address&, const Address&)> conditions_between;
  double now = 0.0;
  bool is_down = false;
  std::function<void(const Bytes&, const Address&, const Address&)> tap;

 private:
  static bool comesLater(const Datagram& a, const Datagram& b) {
    return a.due != b.due ? a.due > b.due : a.number > b.number;
  }

  Random random_;
  std::vector<Datagram> flying_;  ///< a heap
  std::uint64_t number_ = 0;
};

/// A pair's key in tests: all bytes equal.
inline SecretKey makeKey(std::uint8_t byte) {
  std::array<std::uint8_t, SecretKey::kSize> bytes;
  bytes.fill(byte);
  return SecretKey::take(bytes);
}

/// Several sites that send states at 128 Hz from when they can.
class VirtualSites {
 public:
  struct Site {
    int id = 1;
    std::unique_ptr<VirtualNet::Port> port;
    std::unique_ptr<net::PeerGroup> mesh;
    std::uint64_t sequence = 0;
    std::vector<std::vector<Arrival>> given;  ///< arrivals by peer id
  };

  explicit VirtualSites(int count, const NetConditions& conditions = {}, std::uint64_t seed = 1)
      : net(conditions, seed) {
    sites_.resize(static_cast<std::size_t>(count));
    for (int i = 1; i <= count; ++i) {
      at(i).id = i;
      at(i).port = std::make_unique<VirtualNet::Port>(net, VirtualNet::addressOf(i));
    }
    for (int i = 1; i <= count; ++i) start(i);
  }

  /// (Re)starts a site's program without any memory of earlier runs.
  void start(int id, std::uint8_t key = 0x42, const Configuration& configuration = usual()) {
    startWith(id, true, key, configuration);
  }
  /// Starts one that waits for calls, from wherever they come.
  void startWithoutAddress(int id) { startWith(id, false, 0x42, usual()); }
  void startWith(int id, bool knows_addresses, std::uint8_t key,
                 const Configuration& configuration) {
    Site& site = at(id);
    std::vector<net::PeerGroup::Peer> peers;
    for (const Site& other : sites_)
      if (other.id != id)
        peers.push_back(
            {PeerId{static_cast<std::uint32_t>(other.id)},
             knows_addresses ? std::optional(VirtualNet::addressOf(other.id)) : std::nullopt,
             makeKey(key)});
    net::PeerSession::Common common;
    common.first_nonce = net::drawFirstNonce(clock() + clock_ahead);
    common.configuration = configuration;
    site.mesh = std::make_unique<net::PeerGroup>(PeerId{static_cast<std::uint32_t>(id)},
                                                 std::move(peers), common, *site.port);
    site.sequence = 0;
    site.given.assign(sites_.size() + 1, {});
  }
  void stop(int id) { at(id).mesh.reset(); }

  /// Position of a site's user. It stays within the wire's range in tests of any length.
  static Vec3 positionAt(double time, int id) { return Vec3(std::fmod(time, 500.0), id, 0.0); }

  static Configuration usual() { return makeConfiguration({{"object.mass", "0.2"}}); }

  void run(double seconds) {
    const double end = net.now + seconds;
    while (net.now < end - 1e-9) step();
  }

  /// Advances by one millisecond.
  void step() {
    net.deliverUntil(net.now + 1e-3, [&](VirtualNet::Datagram& datagram) {
      for (Site& site : sites_)
        if (site.mesh && site.port->address == datagram.to)
          site.mesh->receive({datagram.bytes.data(), datagram.bytes.size()}, datagram.from,
                             clock());
    });
    for (Site& site : sites_)
      if (site.mesh) act(site);
    ++steps_;
  }

  [[nodiscard]] double clock() const { return net.now; }
  [[nodiscard]] Site& at(int id) { return sites_[static_cast<std::size_t>(id - 1)]; }
  [[nodiscard]] PeerStatus status(int at_site, int of) {
    return at(at_site).mesh->status(PeerId{static_cast<std::uint32_t>(of)}, clock());
  }
  [[nodiscard]] bool areLive() {
    for (Site& site : sites_)
      for (const Site& other : sites_)
        if (site.id != other.id &&
            (!site.mesh || status(site.id, other.id).phase != PeerPhase::kLive))
          return false;
    return true;
  }
  void forgetGiven() {
    for (Site& site : sites_)
      for (auto& given : site.given) given.clear();
  }
  /// Runs until all are live; false after `seconds`.
  [[nodiscard]] bool goLive(double seconds) {
    const double end = net.now + seconds;
    while (net.now < end && !areLive()) step();
    return areLive();
  }

  VirtualNet net;
  double clock_ahead = 0.0;  ///< of the wall clock of programs that start now [s]

 private:
  void act(Site& site) {
    site.mesh->advance(clock());
    for (const Site& other : sites_) {
      if (other.id == site.id) continue;
      Link& link = site.mesh->link(PeerId{static_cast<std::uint32_t>(other.id)});
      if (steps_ % 8 == 0) {
        StatePacket packet;
        packet.sender = PeerId{static_cast<std::uint32_t>(site.id)};
        packet.sequence = site.sequence;
        packet.time = clock();
        packet.user.p_W = positionAt(clock(), site.id);
        link.send(packet, clock());
      }
      while (const auto arrival = link.receive(clock(), clock() + 1e-3))
        site.given[static_cast<std::size_t>(other.id)].push_back(*arrival);
    }
    if (steps_ % 8 == 0) ++site.sequence;
  }

  std::vector<Site> sites_;
  std::uint64_t steps_ = 0;
};

}  // namespace tandem::test
