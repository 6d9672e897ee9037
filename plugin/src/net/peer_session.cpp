#include "net/peer_session.h"

#include <algorithm>
#include <array>

#include "net/random.h"
#include "net/tagged_datagrams.h"

namespace tandem::net {
namespace {

constexpr double kSilence = 1.0;       ///< a silent peer is called again after this [s]
constexpr double kDoubt = 0.1;         ///< states of a peer at rest come each 1/16 s [s]
constexpr double kPreviousKeys = 2.0;  ///< replaced keys still open datagrams for this long [s]
constexpr double kAgreePeriod = 0.25;  // [s]
constexpr double kByePeriod = 0.01;    // [s]
constexpr int kByes = 10;

/// Space for a whole datagram, and for its payload in place.
struct Room {
  std::array<std::uint8_t, kMaxDatagramSize> bytes;
  [[nodiscard]] ByteSpan datagram() noexcept { return {bytes.data(), bytes.size()}; }
  [[nodiscard]] ByteSpan payload() noexcept {
    return {bytes.data() + kHeaderSize, bytes.size() - kHeaderSize - secure::kTagSize};
  }
};

}  // namespace

PeerSession::PeerSession(const Pair& pair, const std::optional<Address>& address,
                         const std::optional<Address>& relayed, SecretKey key, const Common& common)
    : pair_(pair),
      paths_(address, relayed),
      key_(std::move(key)),
      caller_(pair, key_, common.first_nonce),
      knock_nonces_(common.first_nonce),
      answerer_(pair, key_),
      agreement_(common.configuration),
      stream_(common.playout, common.profile, agreement_.hash()),
      epoch_(drawNumber<std::uint16_t>()) {}

void PeerSession::advance(double now, Outlet& outlet) noexcept {
  dropOldKeys(now);
  if (bye_reason_) {
    sayBye(now, outlet);
    return;
  }
  if (pair_.isInitiator())
    callIfNeeded(now, outlet);
  else
    knockIfNeeded(now, outlet);
  tellConfiguration(now, outlet);
  checkPaths(now, outlet);
}

void PeerSession::dropOldKeys(double now) noexcept {
  // Until a datagram opens under the present keys, the peer may still use the previous ones.
  const bool is_replaced = has_heard_present_ && now >= previous_until_;
  if (previous_ && (is_replaced || previous_->age(now) == secure::KeyAge::kExpired))
    previous_.reset();
  if (coming_ && coming_->age(now) == secure::KeyAge::kExpired) {
    coming_.reset();
    answerer_.forget();
  }
  // Silence alone keeps the keys, so that the first datagram after an outage is accepted.
  if (!keys_ || keys_->age(now) != secure::KeyAge::kExpired) return;
  keys_.reset();
  previous_.reset();
}

void PeerSession::forgetKeys() noexcept {
  keys_.reset();
  coming_.reset();
  previous_.reset();
  answerer_.forget();
}

void PeerSession::callIfNeeded(double now, Outlet& outlet) noexcept {
  if (!paths_.inUse()) return;
  // Nothing can come under new keys before a round trip is over.
  const double silence = has_heard_present_ ? kSilence : kSilence + caller_.took();
  const bool is_needed =
      !keys_ || keys_->age(now) == secure::KeyAge::kDue || now - heard_at_ > silence;
  if (is_needed && !caller_.isActive()) {
    epoch_ = static_cast<std::uint16_t>(epoch_ == 65535 ? 1 : epoch_ + 1);
    caller_.start(epoch_, now);
  }
  // The peer was silent for a while, and still has the same keys.
  if (!is_needed) caller_.stop();
  // A peer at a new address may have restarted at its configured one: call both.
  caller_.advance(now, paths_.calls(), outlet);
}

/// The initiator may not know where this site is now.
void PeerSession::knockIfNeeded(double now, Outlet& outlet) noexcept {
  if (!paths_.inUse()) return;
  if (keys_ && now - heard_at_ <= kSilence) {
    knock_nonce_ = 0;
    return;
  }
  if (knock_nonce_ == 0) {
    knock_nonce_ = knock_nonces_.next();
    knocks_.start(now);
  }
  if (!knocks_.isDue(now)) return;
  Room room;
  const std::size_t size =
      writeHello({pair_.self, pair_.peer, knock_nonce_}, key_, room.datagram());
  for (const auto& to : paths_.calls())
    if (to) outlet.send({room.bytes.data(), size}, *to);
}

void PeerSession::tellConfiguration(double now, Outlet& outlet) noexcept {
  if (!keys_ || !agreement_.hasMoreToSay() || now < agree_at_) return;
  agree_at_ = now + kAgreePeriod;
  try {
    for (;;) {
      Room room;
      const std::size_t size = agreement_.nextPart(room.payload());
      if (size == 0) return;
      (void)sendSealed(MessageType::kAgree, size, room.datagram(), outlet);
    }
  } catch (const std::bad_alloc&) {
    // Retry at the next period.
  }
}

void PeerSession::checkPaths(double now, Outlet& outlet) noexcept {
  if (!keys_) return;
  if (stream_.unheardFor(now) > kSilence + stream_.trip().trip()) paths_.check(now);
  for (const auto& challenge : paths_.advance(now, stream_.trip().trip())) {
    if (!challenge) continue;
    Room room;
    (void)sendSealedTo(challenge->to, MessageType::kPathChallenge,
                       encodePath(challenge->token, room.payload()), room.datagram(), outlet);
  }
}

/// Answers there as well where the peer was before: a listener's copy of the challenge may have
/// come first.
void PeerSession::answerChallenge(PathToken token, const Address& from, Outlet& outlet) noexcept {
  const std::optional<Address> usual = paths_.inUse();
  for (const Address& to : {from, usual.value_or(from)}) {
    Room room;
    (void)sendSealedTo(to, MessageType::kPathResponse, encodePath(token, room.payload()),
                       room.datagram(), outlet);
    if (usual == from) break;
  }
}

void PeerSession::leave(ByeReason reason, double now) noexcept {
  if (bye_reason_) return;
  bye_reason_ = reason;
  byes_left_ = kByes;
  bye_at_ = now;
}

void PeerSession::sayBye(double now, Outlet& outlet) noexcept {
  if (byes_left_ == 0 || now < bye_at_) return;
  Room room;
  if (keys_)
    (void)sendSealed(MessageType::kBye, encodeBye(*bye_reason_, room.payload()), room.datagram(),
                     outlet);
  bye_at_ = now + kByePeriod;
  if (--byes_left_ == 0) forgetKeys();
}

Outcome PeerSession::onCookie(ByteView datagram, double now) noexcept {
  return caller_.onCookie(datagram, now);
}

Outcome PeerSession::onAccept(ByteView datagram, const Address& from, double now) noexcept {
  Outcome outcome;
  auto keys = caller_.onAccept(datagram, now, outcome);
  if (!keys) return outcome;
  install(std::move(*keys), now);
  paths_.note(from, now);
  return {};
}

Outcome PeerSession::onRefuse(ByteView datagram) noexcept { return caller_.onRefuse(datagram); }

Outcome PeerSession::onOpen(const OpenMessage& message, const Address& from, double now,
                            Outlet& outlet) noexcept {
  if (bye_reason_) return Refusal::kAfterBye;
  Outcome outcome;
  auto keys = answerer_.onOpen(message, from, now, outlet, outcome);
  if (keys) coming_ = std::move(keys);
  if (outcome.refusal == Refusal::kNone) paths_.hear(from);
  return outcome;
}

void PeerSession::install(SessionKeys keys, double now) noexcept {
  if (keys_) previous_ = std::move(keys_);
  keys_ = std::move(keys);
  epoch_ = keys_->epoch();
  heard_at_ = now;
  has_heard_present_ = false;
  newest_sequence_ = 0;
  left_.reset();
  is_called_with_another_key_ = false;
  stream_.startKeys();
  agreement_.restart();
  agree_at_ = now;
  paths_.check(now);
}

Outcome PeerSession::onSealed(const ClearHeader& header, ByteSpan datagram, const Address& from,
                              double now, Outlet& outlet) noexcept {
  const bool is_coming = coming_ && coming_->isFor(header);
  const bool is_current = keys_ && keys_->isFor(header);
  std::optional<SessionKeys>& keys = is_coming ? coming_ : is_current ? keys_ : previous_;
  if (!keys || !keys->isFor(header)) return Refusal::kUnknownSession;
  const Refusal refusal = keys->open(header, datagram, now);
  if (refusal == Refusal::kReplayed) paths_.hear(from);
  if (refusal != Refusal::kNone) return refusal;
  if (is_coming) {
    // The initiator has the keys, too.
    install(std::move(*coming_), now);
    coming_.reset();
  }
  std::optional<std::uint64_t> sequence;  // empty unless sealed under the present keys
  if (is_coming || is_current) {
    heard_at_ = now;
    if (!has_heard_present_) previous_until_ = now + kPreviousKeys;
    has_heard_present_ = true;
    sequence = header.sequence;
    stream_.note(*sequence);
    if (*sequence >= newest_sequence_) {
      newest_sequence_ = *sequence;
      paths_.note(from, now);
    }
  }
  const ByteView payload{datagram.data + kHeaderSize,
                         datagram.size - kHeaderSize - secure::kTagSize};
  try {
    return handle(header.type, sequence, payload, from, now, outlet);
  } catch (const std::bad_alloc&) {
    return Refusal::kTooMany;  // no memory for a configuration: it comes again
  }
}

Outcome PeerSession::handle(MessageType type, std::optional<std::uint64_t> sequence,
                            ByteView payload, const Address& from, double now, Outlet& outlet) {
  if (bye_reason_) return Refusal::kAfterBye;
  // Messages from before a peer's restart are ignored.
  const bool is_past = !sequence && (type != MessageType::kBye || has_heard_present_);
  if (is_past && type != MessageType::kState) return Refusal::kExpired;
  Room room;
  switch (type) {
    case MessageType::kState:
      return stream_.read(payload, pair_.peer, sequence, agreement_.isEqual(), now);
    case MessageType::kAgree: {
      const auto part = decodeAgree(payload);
      if (!part) return part.refusal();
      const std::size_t size = agreement_.onAgree(*part, room.payload());
      if (size > 0) (void)sendSealed(MessageType::kAgreeAck, size, room.datagram(), outlet);
      return {};
    }
    case MessageType::kAgreeAck: {
      const auto answer = decodeAgreeAck(payload);
      if (!answer) return answer.refusal();
      agreement_.onAnswer(*answer);
      return {};
    }
    case MessageType::kBye: {
      const auto reason = decodeBye(payload);
      if (!reason) return reason.refusal();
      left_ = *reason;
      forgetKeys();
      return {};
    }
    case MessageType::kPathChallenge: {
      const auto token = decodePath(payload);
      if (!token) return token.refusal();
      answerChallenge(*token, from, outlet);
      return {};
    }
    case MessageType::kPathResponse: {
      const auto token = decodePath(payload);
      if (!token) return token.refusal();
      paths_.onResponse(*token, now);
      return {};
    }
    default:
      return Refusal::kOutOfTurn;
  }
}

void PeerSession::send(const StatePacket& packet, double now, Outlet& outlet) noexcept {
  if (!keys_ || bye_reason_) return;
  Room room;
  const std::size_t size = stream_.write(packet, keys_->minor(), now, room.payload());
  const std::size_t sent =
      size > 0 ? sendSealed(MessageType::kState, size, room.datagram(), outlet) : 0;
  ++(sent > 0 ? states_sent_ : states_unsent_);
  // The peer seems not to hear: while another way is looked for, a spare one carries the state,
  // too.
  const std::optional<Address> spare = paths_.spare(now);
  if (sent > 0 && spare && stream_.unheardFor(now) > kDoubt + stream_.trip().trip())
    outlet.send({room.bytes.data(), sent}, *spare);
}

std::size_t PeerSession::sendSealed(MessageType type, std::size_t payload_size, ByteSpan datagram,
                                    Outlet& outlet) noexcept {
  if (!paths_.inUse()) return 0;
  return sendSealedTo(*paths_.inUse(), type, payload_size, datagram, outlet);
}

std::size_t PeerSession::sendSealedTo(const Address& to, MessageType type, std::size_t payload_size,
                                      ByteSpan datagram, Outlet& outlet) noexcept {
  const std::size_t size = keys_ ? keys_->seal(type, payload_size, datagram) : 0;
  if (size > 0) outlet.send({datagram.data, size}, to);
  return size;
}

}  // namespace tandem::net
