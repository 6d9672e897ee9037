#include "net/peer_group.h"

#include <array>
#include <stdexcept>
#include <string>

#include "net/relayed_address.h"
#include "net/tagged_datagrams.h"

namespace tandem::net {
namespace {

constexpr double kHellosPerSecond = 200.0;    ///< each costs a hash and a datagram of 64 bytes
constexpr double kOldHellosPerSecond = 10.0;  ///< of a peer whose clock was set back, or recorded
constexpr double kOpensPerSecond = 50.0;      ///< each costs two X25519 operations
constexpr double kRefusalsPerSecond = 5.0;
// Burst limits, so that the work does not all fall into one tick.
constexpr double kAtOnce = 10.0;
constexpr double kOpensAtOnce = 2.0;

secure::CookieSubject makeSubject(const HandshakeRoute& route) noexcept {
  return {static_cast<std::uint16_t>(route.sender), static_cast<std::uint16_t>(route.receiver),
          route.nonce};
}

void checkIds(PeerId self, const std::vector<PeerGroup::Peer>& peers) {
  const auto check = [](PeerId id) {
    const auto number = static_cast<std::uint32_t>(id);
    if (number < 1 || number > kMaxPeerId)
      throw std::invalid_argument("peer id " + std::to_string(number) + ": must be 1 to " +
                                  std::to_string(kMaxPeerId));
  };
  check(self);
  for (std::size_t i = 0; i < peers.size(); ++i) {
    check(peers[i].id);
    if (self < peers[i].id && !peers[i].address && !peers[i].is_relayed)
      throw std::invalid_argument("peer " +
                                  std::to_string(static_cast<std::uint32_t>(peers[i].id)) +
                                  " has no address; of two sites the lower one calls");
    bool is_twice = peers[i].id == self;
    for (std::size_t j = 0; j < i; ++j) is_twice |= peers[i].id == peers[j].id;
    if (is_twice)
      throw std::invalid_argument("peer id " +
                                  std::to_string(static_cast<std::uint32_t>(peers[i].id)) +
                                  " is there twice; every site has an id of its own");
  }
}

}  // namespace

/// The link of one pair, for a Site.
class PeerGroup::PeerLink final : public Link {
 public:
  PeerLink(PeerSession& session, Outlet& outlet) noexcept : session_(session), outlet_(outlet) {}
  void send(const StatePacket& packet, double now) noexcept override {
    session_.send(packet, now, outlet_);
  }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override {
    return session_.pop(from, until);
  }
  [[nodiscard]] bool hasLeft() const noexcept override { return session_.hasLeft(); }

 private:
  PeerSession& session_;
  Outlet& outlet_;
};

PeerGroup::PeerGroup(PeerId self, std::vector<Peer> peers, const PeerSession::Common& common,
                     Outlet& outlet)
    : self_(self),
      outlet_(outlet),
      known_{{kHellosPerSecond, kAtOnce}, {kOpensPerSecond, kOpensAtOnce}},
      strange_(known_),
      old_hellos_(kOldHellosPerSecond, kAtOnce),
      refusals_(kRefusalsPerSecond, kRefusalsPerSecond) {
  checkIds(self, peers);
  for (Peer& peer : peers) {
    const auto relayed =
        peer.is_relayed ? std::optional(makeRelayedAddress(peer.id)) : std::nullopt;
    sessions_.push_back(std::make_unique<PeerSession>(Pair{self, peer.id}, peer.address, relayed,
                                                      std::move(peer.key), common));
    links_.push_back(std::make_unique<PeerLink>(*sessions_.back(), outlet));
  }
}

PeerGroup::~PeerGroup() = default;

void PeerGroup::receive(ByteSpan datagram, const Address& from, double now) noexcept {
  const Outcome outcome = handle(datagram, from, now);
  counts_.add(outcome.refusal);
  if (outcome.refusal == Refusal::kForm) ++counts_.form[static_cast<std::size_t>(outcome.form)];
}

void PeerGroup::advance(double now) noexcept {
  for (auto& session : sessions_) session->advance(now, outlet_);
}

void PeerGroup::leave(ByeReason reason, double now) noexcept {
  for (auto& session : sessions_) session->leave(reason, now);
}

void PeerGroup::hearOf(PeerId peer, const Address& address) noexcept {
  if (PeerSession* session = find(peer)) session->hearOf(address);
}

Link& PeerGroup::link(PeerId peer) {
  for (std::size_t i = 0; i < sessions_.size(); ++i)
    if (sessions_[i]->pair().peer == peer) return *links_[i];
  throw std::invalid_argument("site " + std::to_string(static_cast<std::uint32_t>(peer)) +
                              " is no peer of this mesh");
}

PeerStatus PeerGroup::status(PeerId peer, double now) const {
  for (const auto& session : sessions_)
    if (session->pair().peer == peer) return session->status(now);
  return {};
}

PeerGroup::Limits& PeerGroup::limitsOf(const PeerSession& session, const Address& from) noexcept {
  return session.knows(from) ? known_ : strange_;
}

PeerSession* PeerGroup::find(PeerId peer) noexcept {
  for (auto& session : sessions_)
    if (session->pair().peer == peer) return session.get();
  return nullptr;
}

Outcome PeerGroup::handle(ByteSpan datagram, const Address& from, double now) noexcept {
  const ByteView bytes{datagram.data, datagram.size};
  const auto header = decodeHeader(bytes);
  if (!header) {
    if (header.refusal() == WireRefusal::kVersion) {
      std::array<std::uint8_t, kRefuseSize> answer;
      const std::size_t size = encodeVersionRefusal(bytes, {answer.data(), answer.size()});
      if (size > 0 && refusals_.take(now)) outlet_.send({answer.data(), size}, from);
    }
    return header.refusal();
  }
  if (isSealed(header->type)) return handleSealed(*header, datagram, from, now);
  if (header->type == MessageType::kHello) return handleHello(bytes, from, now);
  if (header->type == MessageType::kOpen) return handleOpen(bytes, from, now);
  PeerSession* session = find(header->sender);
  if (!session) return Refusal::kNotForMe;
  switch (header->type) {
    case MessageType::kCookie:
      return session->onCookie(bytes, now);
    case MessageType::kAccept:
      return session->onAccept(bytes, from, now);
    default:
      return session->onRefuse(bytes);
  }
}

Outcome PeerGroup::handleHello(ByteView datagram, const Address& from, double now) noexcept {
  const auto hello = decodeHello(datagram);
  if (!hello) return hello.refusal();
  PeerSession* session = hello->route.receiver == self_ ? find(hello->route.sender) : nullptr;
  if (!session) {
    refuse(hello->route, RefuseCode::kUnknownPeer, from, now);
    return Refusal::kNotForMe;
  }
  if (!isAuthentic(*hello, datagram, session->key())) {
    session->noteForeignKey();
    refuse(hello->route, RefuseCode::kKey, from, now);
    return Refusal::kKey;
  }
  if (!takeHello(*session, hello->route.nonce, from, now)) return Refusal::kTooMany;
  if (session->pair().isInitiator()) {
    session->onKnock(from, outlet_);
    return {};
  }
  std::array<std::uint8_t, kCookieSize> bytes;
  const std::size_t size = writeCookie({self_, hello->route.sender, hello->route.nonce},
                                       cookies_.make(makeSubject(hello->route), now),
                                       session->key(), {bytes.data(), bytes.size()});
  outlet_.send({bytes.data(), size}, from);
  return {};
}

/// Recorded HELLOs must not use up the answers of the newest, nor copies those of its first.
bool PeerGroup::takeHello(PeerSession& session, std::uint64_t nonce, const Address& from,
                          double now) noexcept {
  switch (session.noteHello(nonce)) {
    case NewestHello::Age::kNew:
      return true;
    case NewestHello::Age::kRepeated:
      return limitsOf(session, from).hellos.take(now);
    default:
      return old_hellos_.take(now);
  }
}

Outcome PeerGroup::handleOpen(ByteView datagram, const Address& from, double now) noexcept {
  const auto open = decodeOpen(datagram);
  if (!open) return open.refusal();
  PeerSession* session = open->route.receiver == self_ ? find(open->route.sender) : nullptr;
  if (!session) return Refusal::kNotForMe;
  if (!isAuthentic(*open, datagram, session->key())) {
    refuse(open->route, RefuseCode::kKey, from, now);
    return Refusal::kKey;
  }
  if (!cookies_.accepts(open->cookie, makeSubject(open->route), now)) {
    refuse(open->route, RefuseCode::kCookie, from, now);
    return Refusal::kCookie;
  }
  if (!takeOpen(*session, *open, from, now)) {
    refuse(open->route, RefuseCode::kBusy, from, now);
    return Refusal::kTooMany;
  }
  const Outcome outcome = session->onOpen(*open, from, now, outlet_);
  if (outcome.refusal == Refusal::kKey) refuse(open->route, RefuseCode::kKey, from, now);
  return outcome;
}

/// Copies must not use up what a new OPEN needs. Earlier ones get no answer and cost nothing.
bool PeerGroup::takeOpen(const PeerSession& session, const OpenMessage& open, const Address& from,
                         double now) noexcept {
  switch (session.findOpen(open)) {
    case Answerer::Seen::kNever:
      return limitsOf(session, from).opens.take(now);
    case Answerer::Seen::kLast:
      return limitsOf(session, from).hellos.take(now);
    default:
      return true;
  }
}

Outcome PeerGroup::handleSealed(const ClearHeader& header, ByteSpan datagram, const Address& from,
                                double now) noexcept {
  // Pairs choose session numbers independently, so two may be equal: the sender decides.
  PeerSession* session = find(header.sender);
  if (!session) return Refusal::kUnknownSession;
  return session->onSealed(header, datagram, from, now, outlet_);
}

void PeerGroup::refuse(const HandshakeRoute& asked, RefuseCode code, const Address& to,
                       double now) noexcept {
  if (!refusals_.take(now)) return;
  RefuseMessage message;
  message.route = {asked.receiver, asked.sender, asked.nonce};
  message.code = code;
  std::array<std::uint8_t, kRefuseSize> bytes;
  const std::size_t size = encodeRefuse(message, {bytes.data(), bytes.size()});
  if (size > 0) outlet_.send({bytes.data(), size}, to);
}

}  // namespace tandem::net
