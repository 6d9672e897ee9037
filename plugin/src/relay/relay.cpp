#include "relay/relay.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "relay/session_wire.h"

namespace tandem::relay {
namespace {

constexpr double kRefusalsPerSecond = 50.0;  ///< each is shorter than its question
constexpr double kGone = 10.0;               ///< a silent member is removed after this [s]
constexpr double kLookPeriod = 0.01;         // [s]

std::size_t checkRange(const char* what, int value, int least, int most) {
  if (value >= least && value <= most) return static_cast<std::size_t>(value);
  throw std::invalid_argument(std::string(what) + " = " + std::to_string(value) + ": must be " +
                              std::to_string(least) + " to " + std::to_string(most));
}

void checkRate(const char* what, double value) {
  if (!(value > 0.0 && std::isfinite(value)))
    throw std::invalid_argument(std::string(what) + " = " + std::to_string(value) +
                                ": must be above 0 and finite");
}

Members makeMembers(const RelaySettings& settings) {
  constexpr std::size_t kMost = 65535;
  const std::size_t rooms = checkRange("rooms", settings.rooms, 1, 10'000);
  const std::size_t members = checkRange("members", settings.members, 2, kMostMembers);
  checkRate("datagram_rate", settings.datagram_rate);
  checkRate("byte_rate", settings.byte_rate);
  if (rooms * members > kMost)
    throw std::invalid_argument("rooms * members = " + std::to_string(rooms * members) +
                                ": must be at most 65535; lower one of them");
  return {rooms, members};
}

}  // namespace

Relay::Relay(const RelaySettings& settings, SecretKey key, net::Outlet& outlet)
    : key_(std::move(key)),
      address_key_(SecretKey::generate()),
      outlet_(outlet),
      members_(makeMembers(settings)),
      datagram_rate_(settings.datagram_rate),
      byte_rate_(settings.byte_rate),
      refusals_(kRefusalsPerSecond, kRefusalsPerSecond) {}

void Relay::receive(ByteSpan datagram, const Address& from, double now) noexcept {
  const Result result = handle(datagram, from, now);
  ++counts_.results[static_cast<std::size_t>(result)];
}

Result Relay::handle(ByteSpan datagram, const Address& from, double now) noexcept {
  const ByteView bytes{datagram.data, datagram.size};
  const auto type = readType(bytes);
  if (!type) {
    if (isHelloOfAnotherVersion(bytes)) refuse(peekCaller(bytes), Code::kVersion, from, now);
    return Result::kForm;
  }
  switch (*type) {
    case Type::kHello:
    case Type::kJoin:
      return handleRequest(bytes, from, now);
    case Type::kForward:
    case Type::kKeep:
    case Type::kLeave:
    case Type::kResponse:
      return handleSession(*type, datagram, from, now);
    default:
      return Result::kForm;
  }
}

Result Relay::handleSession(Type type, ByteSpan datagram, const Address& from,
                            double now) noexcept {
  const ByteView bytes{datagram.data, datagram.size};
  const SessionHead head = readHead(bytes);
  Member* member = members_.find(head.session);
  if (!member) {
    refuse({0, head.session}, Code::kSession, from, now);
    return Result::kSession;
  }
  // A forged datagram never moves the window.
  if (!member->window.check(head.number)) return Result::kReplayed;
  if (!isTaggedShort(member->key, bytes)) return Result::kForged;
  (void)member->window.commit(head.number);
  member->heard_at = now;
  if (head.number >= member->newest) {
    member->newest = head.number;
    member->paths.note(from, now);
  }
  return type == Type::kForward ? forward(*member, datagram, now)
                                : handleOwn(*member, bytes, head.number, now);
}

Result Relay::handleOwn(Member& member, ByteView datagram, std::uint64_t number,
                        double now) noexcept {
  if (const auto asked = decodeKeep(datagram)) {
    answerKeep(member, number, *asked);
  } else if (const auto token = decodeResponse(datagram)) {
    member.paths.onResponse(*token, now);
  } else if (isLeave(datagram)) {
    members_.remove(member);
  } else {
    return Result::kForm;
  }
  return Result::kTaken;
}

Result Relay::forward(Member& member, ByteSpan datagram, double now) noexcept {
  const auto to = decodeForward({datagram.data, datagram.size});
  if (!to) return Result::kForm;
  if (member.is_watcher) return Result::kWatcher;
  Room& room = members_.roomOf(member);
  if (!member.datagrams.take(now) || !member.bytes.take(now, static_cast<double>(datagram.size))) {
    ++room.too_many;
    return Result::kTooMany;
  }
  const std::size_t size = turnForward(member.id, datagram);
  return deliver(room, *to, {datagram.data, size}) ? Result::kTaken : Result::kNoReceiver;
}

/// Sends to the receiver, or to all watchers. False if there is none.
bool Relay::deliver(Room& room, std::uint16_t to, ByteView datagram) noexcept {
  const auto send = [&](const Member& receiver) {
    outlet_.send(datagram, *receiver.paths.inUse());
    ++counts_.forwarded;
    counts_.forwarded_bytes += datagram.size;
    ++room.forwarded;
    room.forwarded_bytes += datagram.size;
  };
  if (to != kAllWatchers) {
    const Member* receiver = members_.find(room, to);
    if (receiver) send(*receiver);
    return receiver != nullptr;
  }
  if (room.watchers == 0) return false;
  for (std::uint16_t id = 1; id <= kMostMembers; ++id)
    if (const Member* one = members_.find(room, id); one && one->is_watcher) send(*one);
  return true;
}

/// The answer goes to the address in use: another one may be a listener's.
void Relay::answerKeep(Member& member, std::uint64_t number, std::uint16_t asked) noexcept {
  const Room& room = members_.roomOf(member);
  Kept kept{asked, std::nullopt, room.present.bits()};
  if (const Member* other = asked == 0 ? nullptr : members_.find(room, asked)) {
    // A link-local address means nothing elsewhere.
    const std::optional<Address>& address = other->paths.inUse();
    if (address->scope == 0) kept.address = address;
  }
  std::array<std::uint8_t, kKeptSize> answer;
  const ByteSpan out{answer.data(), answer.size()};
  encodeKept({member.session, number}, kept, out);
  tagShort(member.key, out);
  outlet_.send({answer.data(), answer.size()}, *member.paths.inUse());
}

void Relay::advance(double now) noexcept {
  if (now < next_look_) return;
  next_look_ = now + kLookPeriod;
  for (Member& member : members_.all()) {
    if (member.session == 0) continue;
    if (now - member.heard_at > kGone)
      members_.remove(member);
    else
      challenge(member, now);
  }
}

void Relay::challenge(Member& member, double now) noexcept {
  constexpr double kUnknownTrip = 0.0;
  for (const auto& due : member.paths.advance(now, kUnknownTrip)) {
    if (!due) continue;
    std::array<std::uint8_t, kChallengeSize> datagram;
    const ByteSpan out{datagram.data(), datagram.size()};
    encodeChallenge(member.session, due->token, out);
    tagShort(member.key, out);
    outlet_.send({datagram.data(), datagram.size()}, due->to);
  }
}

}  // namespace tandem::relay
