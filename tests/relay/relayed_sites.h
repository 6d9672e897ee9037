#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "net/relayed_address.h"
#include "net/virtual_net.h"
#include "relay/relay.h"
#include "relay/relay_member.h"

namespace tandem::test {

/// Sites that know no address but the relay's, and send states at 128 Hz.
class RelayedSites {
 public:
  struct Ways {
    double to_relay = 0.01;  ///< from any site to the relay and back, one way [s]
    double direct = 0.01;    ///< between any two sites, one way [s]
    double loss = 0.0;
    bool has_relay = true, has_direct = true;
  };
  /// Sends what goes to a peer by the way that the test wants.
  struct WaySwitch final : net::Outlet {
    WaySwitch(net::Outlet& member, const std::optional<bool>& by_relay) noexcept
        : member_(member), by_relay_(by_relay) {}
    void send(ByteView datagram, const Address& to) noexcept override {
      const auto peer = net::relayedPeer(to);
      if (!by_relay_ || peer.has_value() == *by_relay_)
        member_.send(datagram, to);
      else if (*by_relay_)
        member_.send(datagram, net::makeRelayedAddress(PeerId{to.ip[15]}));
      else
        member_.send(datagram, VirtualNet::addressOf(static_cast<int>(*peer)));
    }

   private:
    net::Outlet& member_;
    const std::optional<bool>& by_relay_;
  };
  /// The relay's way out, on which it may lie.
  struct RelayPort final : net::Outlet {
    explicit RelayPort(VirtualNet& on) : port(on, VirtualNet::addressOf(200)) {}
    void send(ByteView datagram, const Address& to) noexcept override {
      Bytes bytes(datagram.data, datagram.data + datagram.size);
      Address where = to;
      if (lie) lie(bytes, where);
      port.send({bytes.data(), bytes.size()}, where);
    }
    VirtualNet::Port port;
    std::function<void(Bytes&, Address&)> lie;
  };
  struct Site {
    std::unique_ptr<VirtualNet::Port> port;
    std::unique_ptr<relay::RelayMember> member;
    std::unique_ptr<WaySwitch> way;
    std::unique_ptr<net::PeerGroup> mesh;
    std::uint64_t sequence = 0;
    std::vector<std::vector<Arrival>> given;  ///< by peer id
  };

  explicit RelayedSites(int count, const Ways& at_first, const RelaySettings& settings = {})
      : ways(at_first), relay_port(net) {
    relay = std::make_unique<relay::Relay>(settings, makeKey(0x17), relay_port);
    net.conditions_between = [this](const Address& from, const Address& to) {
      const bool is_relayed = from == relay_port.port.address || to == relay_port.port.address;
      NetConditions way;
      way.delay = is_relayed ? ways.to_relay : ways.direct;
      way.loss = (is_relayed ? ways.has_relay : ways.has_direct) ? ways.loss : 1.1;
      return way;
    };
    sites.resize(static_cast<std::size_t>(count));
    for (int id = 1; id <= count; ++id) start(id);
  }

  void start(int id) {
    Site& site = at(id);
    const PeerId self{static_cast<std::uint32_t>(id)};
    const std::uint64_t nonce = net::drawFirstNonce(net.now);
    site.port = std::make_unique<VirtualNet::Port>(net, VirtualNet::addressOf(id));
    site.member =
        std::make_unique<relay::RelayMember>(relay_port.port.address, makeKey(0x17),
                                             *relay::makeRoomName("lab"), self, nonce, *site.port);
    site.way = std::make_unique<WaySwitch>(*site.member, by_relay);
    std::vector<net::PeerGroup::Peer> peers;
    for (std::uint32_t other = 1; other <= sites.size(); ++other)
      if (PeerId{other} != self) peers.push_back({PeerId{other}, std::nullopt, makeKey(1), true});
    net::PeerSession::Common common;
    common.first_nonce = nonce;
    common.configuration = VirtualSites::usual();
    site.mesh = std::make_unique<net::PeerGroup>(self, std::move(peers), common, *site.way);
    site.given.assign(sites.size() + 1, {});
  }

  void run(double seconds) {
    for (const double end = net.now + seconds; net.now < end - 1e-9;) step();
  }
  void step() {
    net.deliverUntil(net.now + 1e-3, [&](VirtualNet::Datagram& datagram) { deliver(datagram); });
    if (relay) relay->advance(net.now);
    for (std::size_t i = 0; i < sites.size(); ++i) act(static_cast<int>(i) + 1);
    ++steps_;
  }

  [[nodiscard]] Site& at(int id) { return sites[static_cast<std::size_t>(id - 1)]; }
  [[nodiscard]] PeerStatus status(int at_site, int of) {
    return at(at_site).mesh->status(PeerId{static_cast<std::uint32_t>(of)}, net.now);
  }
  [[nodiscard]] bool areLive() {
    const int count = static_cast<int>(sites.size());
    for (int id = 1; id <= count; ++id)
      for (int other = 1; other <= count; ++other)
        if (id != other && status(id, other).phase != PeerPhase::kLive) return false;
    return true;
  }
  [[nodiscard]] bool goLive(double seconds) {
    for (const double end = net.now + seconds; net.now < end && !areLive();) step();
    return areLive();
  }
  /// Longest time between two states in the next `seconds`, at any of two sites [s].
  [[nodiscard]] double longestGapOver(double seconds) {
    at(1).given[2].clear(), at(2).given[1].clear();
    run(seconds);
    return std::max(gapOf(at(1).given[2]), gapOf(at(2).given[1]));
  }
  [[nodiscard]] double now() const { return net.now; }

  VirtualNet net;
  Ways ways;
  std::optional<bool> by_relay;  ///< all states go by the relay or directly; empty: as sites choose
  RelayPort relay_port;
  std::unique_ptr<relay::Relay> relay;
  std::vector<Site> sites;
  std::function<void(int id)> act_instead;  ///< of a site's own states; empty: it says those

 private:
  [[nodiscard]] double gapOf(const std::vector<Arrival>& given) const {
    double longest = given.empty() ? 1e9 : net.now - given.back().time;
    for (std::size_t i = 1; i < given.size(); ++i)
      longest = std::max(longest, given[i].time - given[i - 1].time);
    return longest;
  }

  void deliver(VirtualNet::Datagram& datagram) {
    const ByteSpan bytes{datagram.bytes.data(), datagram.bytes.size()};
    if (datagram.to == relay_port.port.address && relay) {
      relay->receive(bytes, datagram.from, net.now);
      return;
    }
    for (Site& site : sites) {
      if (datagram.to != site.port->address) continue;
      if (datagram.from != relay_port.port.address) {
        site.mesh->receive(bytes, datagram.from, net.now);
      } else if (const auto said = site.member->receive(bytes, net.now)) {
        site.mesh->receive(said->inner, net::makeRelayedAddress(PeerId{said->from}), net.now);
      }
    }
  }

  void act(int id) {
    Site& site = at(id);
    site.member->advance(net.now);
    if (const auto seen = site.member->takeSeen()) site.mesh->hearOf(seen->member, seen->address);
    site.mesh->advance(net.now);
    if (act_instead) return act_instead(id);
    for (std::uint32_t other = 1; other <= sites.size(); ++other) {
      if (static_cast<int>(other) == id) continue;
      Link& link = site.mesh->link(PeerId{other});
      if (steps_ % 8 == 0) {
        StatePacket packet;
        packet.sender = PeerId{static_cast<std::uint32_t>(id)};
        packet.sequence = site.sequence;
        packet.time = net.now;
        packet.user.p_W = VirtualSites::positionAt(net.now, id);
        link.send(packet, net.now);
      }
      while (const auto arrival = link.receive(net.now, net.now + 1e-3))
        site.given[other].push_back(*arrival);
    }
    if (steps_ % 8 == 0) ++site.sequence;
  }

  std::uint64_t steps_ = 0;
};

}  // namespace tandem::test
