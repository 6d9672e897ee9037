#include "net/membership_sites.h"

#include <algorithm>
#include <cmath>

#include "net/virtual_net.h"

namespace tandem::test {
namespace {

constexpr std::uint16_t kPort = 7000;
constexpr std::size_t kRemembered = 64;  ///< datagrams kept for replays

PeerId idOf(std::size_t site) { return PeerId{static_cast<std::uint32_t>(site + 1)}; }

MessageType typeOf(const std::vector<std::uint8_t>& bytes) {
  return static_cast<MessageType>(bytes[3]);
}

/// Session, sender, epoch and sequence. These form the nonce, and identify its key.
std::vector<std::uint8_t> nonceOf(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin() + 4, bytes.begin() + kHeaderSize};
}

}  // namespace

struct MembershipSites::Port final : net::Outlet {
  Port(MembershipSites& sites, std::size_t number, const Address& own)
      : owner(sites), site(number), address(own) {}
  void send(ByteView datagram, const Address& to) noexcept override {
    owner.carry(site, datagram, to);
  }
  MembershipSites& owner;
  std::size_t site;
  Address address;
};

MembershipSites::Site::Site() = default;
MembershipSites::Site::Site(Site&&) noexcept = default;
MembershipSites::Site::~Site() = default;

MembershipSites::MembershipSites(std::size_t count) : sites_(count) {
  for (std::size_t i = 0; i < count; ++i)
    sites_[i].port = std::make_unique<Port>(*this, i, addressOf(i));
  for (std::size_t i = 0; i < count; ++i) start(i, {});
}

Address MembershipSites::addressOf(std::size_t site) {
  Address address = VirtualNet::addressOf(static_cast<int>(site) + 1);
  address.port = kPort;
  return address;
}

/// A state that encodes its sender and that sender's start.
StatePacket MembershipSites::makeState(std::size_t site, const Start& how, std::uint64_t number) {
  StatePacket packet;
  packet.sender = idOf(site);
  packet.sequence = number;
  packet.user.p_W = Vec3(static_cast<double>(number % 512), static_cast<double>(site), 0.0);
  packet.user.v_W = Vec3(how.key, how.configuration, static_cast<double>(number * 7 % 64));
  packet.energy = EnergyReport{static_cast<double>(number), packet.user.p_W.x()};
  return packet;
}

void MembershipSites::start(std::size_t site, const Start& how) {
  Site& self = sites_[site];
  std::vector<net::PeerGroup::Peer> peers;
  for (std::size_t i = 0; i < sites_.size(); ++i)
    if (i != site)
      peers.push_back({idOf(i), addressOf(i), makeKey(static_cast<std::uint8_t>(how.key + 1))});
  net::PeerSession::Common common;
  common.first_nonce = net::drawFirstNonce(now_);
  common.configuration = makeConfiguration({{"object.mass", std::to_string(how.configuration)}});
  self.mesh = std::make_unique<net::PeerGroup>(idOf(site), std::move(peers), common, *self.port);
  self.how = how;
  self.ahead = how.clock - now_;
  self.has_left = false;
  self.states = 0;
  self.newest = {};
  self.given = {};
  self.granted = {};
  self.is_given_since_mended = {};
}

void MembershipSites::stop(std::size_t site) { sites_[site].mesh.reset(); }

void MembershipSites::leave(std::size_t site, ByeReason reason) {
  Site& self = sites_[site];
  if (!self.mesh) return;
  self.mesh->leave(reason, clockOf(self));
  self.has_left = true;
}

void MembershipSites::rebind(std::size_t site, std::uint16_t shift) {
  sites_[site].port->address.port = static_cast<std::uint16_t>(kPort + shift);
}

void MembershipSites::act(unsigned mask) {
  const bool is_state_due = now_ >= state_at_;
  if (is_state_due) state_at_ = now_ + kStatePeriod;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    Site& self = sites_[i];
    if (!self.mesh || (mask >> i & 1U) == 0) continue;
    const double clock = clockOf(self);
    self.mesh->advance(clock);
    StatePacket packet = makeState(i, self.how, self.states);
    packet.time = clock;
    for (std::size_t peer = 0; peer < sites_.size(); ++peer) {
      if (peer == i) continue;
      if (is_state_due) self.mesh->link(idOf(peer)).send(packet, clock);
      takeGiven(i, peer);
    }
    if (is_state_due) ++self.states;
    checkCounts(i);
  }
}

void MembershipSites::takeGiven(std::size_t site, std::size_t peer) {
  Site& self = sites_[site];
  const double clock = clockOf(self);
  const std::size_t id = peer + 1;
  while (const auto arrival = self.mesh->link(idOf(peer)).receive(clock, clock + kStep)) {
    const StatePacket& packet = arrival->packet;
    require(!self.newest[id] || packet.sequence > *self.newest[id], "states out of order");
    self.newest[id] = packet.sequence;
    ++self.given[id];
    self.is_given_since_mended[id] = true;
    const Vec3& p = packet.user.p_W;
    const Vec3& v = packet.user.v_W;
    const bool is_whole = p.x() == std::floor(p.x()) && p.x() >= 0.0 && p.x() < 512.0 &&
                          v.z() == std::fmod(p.x() * 7.0, 64.0) && packet.sender == idOf(peer) &&
                          p.y() == static_cast<double>(peer);
    require(is_whole, "a state that nobody sent");
    const bool has_energy = packet.energy && packet.energy->holdings == p.x();
    require(has_energy, "an account that nobody sent");
    require(packet.energy->granted >= self.granted[id], "granted energy that fell");
    self.granted[id] = packet.energy->granted;
    require(v.x() == self.how.key, "a state under another key");
    require(v.y() == self.how.configuration, "a state of another configuration");
    require(arrival->time >= clock, "a state of the past");
  }
  require(self.mesh->status(idOf(peer), clock).states_given == self.given[id],
          "states that were given are not counted");
}

void MembershipSites::checkCounts(std::size_t site) {
  const net::DatagramCounts& counts = sites_[site].mesh->counts();
  std::uint64_t refused = 0, form = 0;
  for (const std::uint64_t count : counts.refused) refused += count;
  for (const std::uint64_t count : counts.form) form += count;
  require(counts.received == counts.taken + refused, "datagrams not counted once");
  require(counts.of(net::Refusal::kForm) == form, "forms not counted once");
}

void MembershipSites::carry(std::size_t from, ByteView bytes, const Address& to) {
  const Site& self = sites_[from];
  std::vector<std::uint8_t> copy(bytes.data, bytes.data + bytes.size);
  if (isSealed(typeOf(copy)))
    require(sealed_.insert(nonceOf(copy)).second, "a nonce used twice under a key");
  if (flying_.size() >= kMostInFlight) flying_.erase(flying_.begin());
  flying_.push_back({std::move(copy), self.port->address, to, now_, self.how});
}

bool MembershipSites::handOver(const Datagram& datagram) {
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    Site& self = sites_[i];
    if (!self.mesh || self.port->address != datagram.to) continue;
    std::vector<std::uint8_t> bytes = datagram.bytes;
    const std::uint64_t taken = self.mesh->counts().taken;
    self.mesh->receive({bytes.data(), bytes.size()}, datagram.from, clockOf(self));
    checkCounts(i);
    return self.mesh->counts().taken > taken;
  }
  return false;
}

MembershipSites::Datagram MembershipSites::takeOut(std::size_t which) {
  const auto at = flying_.begin() + static_cast<std::ptrdiff_t>(which % flying_.size());
  Datagram datagram = std::move(*at);
  flying_.erase(at);
  return datagram;
}

void MembershipSites::deliver(std::size_t which) {
  if (flying_.empty()) return;
  const Datagram datagram = takeOut(which);
  const bool is_taken = handOver(datagram);
  if (is_taken && isSealed(typeOf(datagram.bytes)))
    require(taken_.insert(nonceOf(datagram.bytes)).second, "a datagram taken twice");
  if (delivered_.size() >= kRemembered) delivered_.erase(delivered_.begin());
  delivered_.push_back(datagram);
}

void MembershipSites::drop(std::size_t which) {
  if (!flying_.empty()) (void)takeOut(which);
}

void MembershipSites::repeat(std::size_t which) {
  if (!flying_.empty()) flying_.push_back(Datagram(flying_[which % flying_.size()]));
}

void MembershipSites::change(std::size_t which, std::size_t at, std::uint8_t turn) {
  if (flying_.empty()) return;
  Datagram datagram = flying_[which % flying_.size()];
  const auto as_it_was = datagram.bytes;
  datagram.bytes[at % datagram.bytes.size()] ^= turn;
  handOverChanged(std::move(datagram), as_it_was);
}

void MembershipSites::cut(std::size_t which, std::size_t size) {
  if (flying_.empty()) return;
  Datagram datagram = flying_[which % flying_.size()];
  const auto as_it_was = datagram.bytes;
  datagram.bytes.resize(size % as_it_was.size());
  handOverChanged(std::move(datagram), as_it_was);
}

/// REFUSE has no authenticated bit; in all others each bit is authenticated.
void MembershipSites::handOverChanged(Datagram datagram,
                                      const std::vector<std::uint8_t>& as_it_was) {
  const bool is_covered = typeOf(as_it_was) != MessageType::kRefuse;
  const bool is_taken = handOver(datagram);
  require(!is_taken || !is_covered, "a changed datagram taken");
}

void MembershipSites::replay(std::size_t which, bool is_from_stranger) {
  if (delivered_.empty()) return;
  Datagram datagram = delivered_[which % delivered_.size()];
  if (is_from_stranger) datagram.from = addressOf(7);
  const bool is_taken = handOver(datagram);
  if (is_taken && isSealed(typeOf(datagram.bytes)))
    require(taken_.insert(nonceOf(datagram.bytes)).second, "a replayed datagram taken");
}

void MembershipSites::forge(std::size_t site, std::vector<std::uint8_t> bytes) {
  const bool is_sealed = bytes.size() > 3 && isSealed(typeOf(bytes));
  const bool is_taken = handOver({std::move(bytes), addressOf(7), addressOf(site), now_, {}});
  require(!is_taken || !is_sealed, "a forged datagram taken");
}

void MembershipSites::runPerfectly(double seconds) {
  const double end = now_ + seconds;
  while (now_ < end) {
    pass(kStatePeriod);
    while (!flying_.empty() && flying_.front().sent + kDelay <= now_) deliver(0);
    act(~0U);
  }
}

void MembershipSites::mend() {
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    rebind(i, 0);
    Site& self = sites_[i];
    if (!self.mesh || self.has_left || !self.how.mayMeet({})) start(i, {});
    self.is_given_since_mended = {};
  }
  // Delayed datagrams arrive first.
  std::stable_sort(flying_.begin(), flying_.end(),
                   [](const Datagram& a, const Datagram& b) { return a.sent < b.sent; });
}

bool MembershipSites::areTogether() const {
  for (std::size_t i = 0; i < sites_.size(); ++i)
    for (std::size_t peer = 0; peer < sites_.size(); ++peer)
      if (peer != i &&
          (!sites_[i].is_given_since_mended[peer + 1] ||
           sites_[i].mesh->status(idOf(peer), clockOf(sites_[i])).phase != PeerPhase::kLive))
        return false;
  return true;
}

}  // namespace tandem::test
