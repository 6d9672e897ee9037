#include "relay/relay_member.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "net/relayed_address.h"

namespace tandem::relay {
namespace {

constexpr double kKeepPeriod = 1.0;       // [s]
constexpr double kFirstKeepPeriod = 0.1;  ///< while members are being found [s]
constexpr double kFirstKeeps = 2.0;       ///< so long after JOINED [s]
constexpr double kSilent = 3.0;           ///< a relay that is silent for longer is joined again [s]
constexpr double kJoinFor = 8.5;          ///< a cookie is valid for at least 10 s
constexpr double kAttemptPeriod = 1.0;    ///< attempts start at most this often [s]
constexpr int kLeaves = 3;
constexpr double kNewShare = 0.2;  ///< of a new round trip in the smoothed one

}  // namespace

RelayMember::RelayMember(const Address& relay, SecretKey key, const RoomName& room, PeerId self,
                         std::uint64_t first_nonce, net::Outlet& socket, bool is_watcher)
    : relay_(relay), key_(std::move(key)), socket_(socket), nonces_(first_nonce) {
  const auto id = static_cast<std::uint32_t>(self);
  if (id < 1 || id > kMostMembers)
    throw std::invalid_argument("peer id " + std::to_string(id) + ": must be 1 to " +
                                std::to_string(kMostMembers) + " in a relay's room");
  request_.caller.member = static_cast<std::uint16_t>(id);
  request_.room = room;
  request_.is_watcher = is_watcher;
}

void RelayMember::send(ByteView datagram, const Address& to) noexcept {
  const auto peer = net::relayedPeer(to);
  if (!peer) {
    socket_.send(datagram, to);
    return;
  }
  if (!isIn() || datagram.size > kMaxDatagramSize) return;  // lost, as on any network
  std::array<std::uint8_t, kMaxForward> room;
  const std::size_t size =
      encodeForward({session_, next_sequence_++}, static_cast<std::uint16_t>(*peer), datagram.size,
                    {room.data(), room.size()});
  std::copy_n(datagram.data, datagram.size, room.data() + kForwardHeader);
  sendTagged({room.data(), size});
}

void RelayMember::sendTagged(ByteSpan datagram) noexcept {
  tagShort(session_key_, datagram);
  socket_.send({datagram.data, datagram.size}, relay_);
}

// --- Admission

void RelayMember::advance(double now) noexcept {
  const bool is_needed = !isIn() || now - heard_at_ > kSilent;
  if (is_needed && stage_ == Stage::kIdle && now >= next_attempt_) startAttempt(now);
  if (stage_ == Stage::kJoin && now - joining_since_ > kJoinFor) startAttempt(now);
  if (stage_ != Stage::kIdle && retry_.isDue(now)) sendRequest();
  if (isIn() && now >= next_keep_) sendKeep(now);
}

void RelayMember::callAs(PeerId self) noexcept {
  request_.caller.member = static_cast<std::uint16_t>(self);
  refused_.reset();
  stage_ = Stage::kIdle;
}

void RelayMember::startAttempt(double now) noexcept {
  stage_ = Stage::kHello;
  request_.caller.nonce = nonces_.next();
  request_.cookie = {};
  next_attempt_ = now + kAttemptPeriod;
  retry_.start(now);
}

void RelayMember::sendRequest() noexcept {
  std::array<std::uint8_t, kHelloSize> datagram;
  const ByteSpan out{datagram.data(), datagram.size()};
  encodeRequest(stage_ == Stage::kHello ? Type::kHello : Type::kJoin, request_, out);
  tagLong(key_, out);
  socket_.send({out.data, out.size}, relay_);
}

std::optional<Forwarded> RelayMember::receive(ByteSpan datagram, double now) noexcept {
  const ByteView bytes{datagram.data, datagram.size};
  switch (readType(bytes).value_or(Type::kRefuse)) {
    case Type::kForwarded:
      return decodeForwarded(datagram);
    case Type::kCookie:
      onCookie(bytes, now);
      break;
    case Type::kJoined:
      onJoined(bytes, now);
      break;
    case Type::kKept:
      onKept(bytes, now);
      break;
    case Type::kChallenge:
      onChallenge(bytes);
      break;
    default:  // a REFUSE may have another version
      onRefuse(bytes, now);
  }
  return std::nullopt;
}

void RelayMember::onCookie(ByteView datagram, double now) noexcept {
  const auto answer = decodeCookieAnswer(datagram);
  if (!answer || stage_ != Stage::kHello || answer->caller.nonce != request_.caller.nonce ||
      !isTaggedLong(key_, datagram))
    return;
  request_.cookie = answer->cookie;
  stage_ = Stage::kJoin;
  joining_since_ = now;
  retry_.start(now);
}

void RelayMember::onJoined(ByteView datagram, double now) noexcept {
  const auto answer = decodeJoinedAnswer(datagram);
  if (!answer || stage_ != Stage::kJoin || answer->caller.nonce != request_.caller.nonce ||
      !isTaggedLong(key_, datagram))
    return;
  stage_ = Stage::kIdle;
  refused_.reset();
  session_ = answer->session;
  session_key_ = computeSessionKey(key_, request_, session_);
  next_sequence_ = next_kept_ = 0;
  joined_at_ = heard_at_ = next_keep_ = now;
}

void RelayMember::onRefuse(ByteView datagram, double now) noexcept {
  const auto answer = decodeRefuseAnswer(datagram);
  if (!answer) return;
  // The relay has restarted, or somebody says so: a new session takes over only once it is there.
  const bool is_session = answer->code == Code::kSession && answer->caller.nonce == session_;
  if (is_session && stage_ == Stage::kIdle && now >= next_attempt_) startAttempt(now);
  if (stage_ != Stage::kIdle && answer->caller.nonce == request_.caller.nonce) refused_ = *answer;
}

// --- Session

void RelayMember::sendKeep(double now) noexcept {
  next_keep_ = now + (now - joined_at_ < kFirstKeeps ? kFirstKeepPeriod : kKeepPeriod);
  keep_ = {session_, next_sequence_++};
  kept_since_ = now;
  std::array<std::uint8_t, kKeepSize> datagram;
  encodeKeep(keep_, nextAsked(), {datagram.data(), datagram.size()});
  sendTagged({datagram.data(), datagram.size()});
}

/// The next member that is there; 0 if there is no other.
std::uint16_t RelayMember::nextAsked() noexcept {
  for (std::uint16_t tries = 0; tries < kMostMembers; ++tries) {
    asked_ = static_cast<std::uint16_t>(asked_ % kMostMembers + 1);
    const bool is_there = (members_ >> (asked_ - 1) & 1U) != 0;
    if (is_there && asked_ != request_.caller.member) return asked_;
  }
  return 0;
}

bool RelayMember::isOfSession(ByteView datagram) const noexcept {
  return isIn() && readHead(datagram).session == session_ && isTaggedShort(session_key_, datagram);
}

void RelayMember::onKept(ByteView datagram, double now) noexcept {
  const auto kept = decodeKept(datagram);
  if (!kept || !isOfSession(datagram)) return;
  // None counts twice, so that copies do not hide a relay's silence.
  const std::uint64_t number = readHead(datagram).number;
  if (number < next_kept_ || number >= next_sequence_) return;
  next_kept_ = number + 1;
  heard_at_ = now;
  members_ = kept->members;
  if (number == keep_.number) {
    const double trip = now - kept_since_;
    round_trip_ = round_trip_ == 0.0 ? trip : round_trip_ + kNewShare * (trip - round_trip_);
  }
  if (kept->address) seen_ = Seen{PeerId{kept->asked}, *kept->address};
}

void RelayMember::onChallenge(ByteView datagram) noexcept {
  if (!isChallenge(datagram) || !isOfSession(datagram)) return;
  std::array<std::uint8_t, kResponseSize> answer;
  encodeResponse({session_, next_sequence_++}, readHead(datagram).number,
                 {answer.data(), answer.size()});
  sendTagged({answer.data(), answer.size()});
}

std::optional<RelayMember::Seen> RelayMember::takeSeen() noexcept {
  return std::exchange(seen_, std::nullopt);
}

void RelayMember::leave() noexcept {
  for (int i = 0; isIn() && i < kLeaves; ++i) {
    std::array<std::uint8_t, kLeaveSize> datagram;
    encodeLeave({session_, next_sequence_++}, {datagram.data(), datagram.size()});
    sendTagged({datagram.data(), datagram.size()});
  }
  session_ = 0;
}

}  // namespace tandem::relay
