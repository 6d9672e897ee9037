#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "net/relayed_address.h"
#include "net/virtual_net.h"
#include "relay/relay.h"
#include "relay/relay_member.h"

namespace tandem::test {

/// Address of the relay of a test.
inline Address relayAddress() { return VirtualNet::addressOf(200); }

/// A relay and members of its rooms on a virtual network. Members say plain bytes to each other.
class RelayRig {
 public:
  struct Member {
    std::uint16_t id = 1;
    std::unique_ptr<VirtualNet::Port> port;
    std::unique_ptr<relay::RelayMember> member;
    std::vector<std::pair<std::uint16_t, Bytes>> heard;  ///< from whom, and what
  };

  explicit RelayRig(const RelaySettings& settings = {}, const NetConditions& conditions = {},
                    std::uint64_t seed = 1)
      : net(conditions, seed), port_(net, relayAddress()), settings_(settings) {
    startRelay();
  }

  /// (Re)starts the relay without any memory.
  void startRelay() { relay = std::make_unique<relay::Relay>(settings_, makeKey(kKey), port_); }
  void stopRelay() { relay.reset(); }

  /// (Re)starts a member's program at the address with this number.
  Member& join(int address, std::uint16_t id, const std::string& room = "lab",
               std::uint8_t key = kKey) {
    return joinAt(VirtualNet::addressOf(address), address, id, room, key);
  }
  Member& joinAt(const Address& address, int number, std::uint16_t id, const std::string& room,
                 std::uint8_t key = kKey, bool is_watcher = false) {
    Member& one = members[number];
    one.id = id;
    one.heard.clear();
    one.member.reset();
    one.port = std::make_unique<VirtualNet::Port>(net, address);
    by_ip_[address.ip] = &one;
    one.member = std::make_unique<relay::RelayMember>(
        relayAddress(), makeKey(key), *relay::makeRoomName(room), PeerId{id},
        net::drawFirstNonce(net.now), *one.port, is_watcher);
    return one;
  }

  void say(Member& from, std::uint16_t to, const Bytes& bytes) {
    from.member->send({bytes.data(), bytes.size()}, net::makeRelayedAddress(PeerId{to}));
  }

  void run(double seconds, double period = 1e-3) {
    for (const double end = net.now + seconds; net.now < end - 1e-9;) step(period);
  }
  void step(double period = 1e-3) {
    net.deliverUntil(net.now + period, [&](VirtualNet::Datagram& datagram) {
      const ByteSpan bytes{datagram.bytes.data(), datagram.bytes.size()};
      if (datagram.to == relayAddress() && relay) relay->receive(bytes, datagram.from, net.now);
      if (datagram.from == relayAddress()) deliver(datagram.to, bytes);
    });
    if (relay) relay->advance(net.now);
    for (auto& [number, one] : members)
      if (one.member) one.member->advance(net.now);
  }

  [[nodiscard]] std::uint64_t count(relay::Result result) const {
    return relay->counts().of(result);
  }

  static constexpr std::uint8_t kKey = 0x17;
  VirtualNet net;
  std::map<int, Member> members;  ///< by number, usually that of their address
  std::unique_ptr<relay::Relay> relay;

 private:
  void deliver(const Address& to, ByteSpan bytes) {
    const auto at = by_ip_.find(to.ip);
    if (at == by_ip_.end() || !at->second->member || at->second->port->address != to) return;
    Member& one = *at->second;
    if (const auto said = one.member->receive(bytes, net.now))
      one.heard.emplace_back(said->from,
                             Bytes(said->inner.data, said->inner.data + said->inner.size));
  }

  std::map<decltype(Address::ip), Member*> by_ip_;  ///< each has an own one
  VirtualNet::Port port_;
  RelaySettings settings_;
};

/// A relay with two members in one room, for a while already.
struct RelayOfTwo : RelayRig {
  explicit RelayOfTwo(double seconds = 1.0, const RelaySettings& settings = {})
      : RelayRig(settings), first(join(1, 1)), second(join(2, 2)) {
    run(seconds);
  }
  Member& first;
  Member& second;
};

/// Bytes as long as a state's datagram.
inline Bytes makeInner(std::uint8_t value, std::size_t size = 172) { return Bytes(size, value); }

}  // namespace tandem::test
