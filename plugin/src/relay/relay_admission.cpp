// The admission of a member to a room.

#include <algorithm>

#include "relay/relay.h"

namespace tandem::relay {
namespace {

constexpr double kAlive = 5.0;  ///< a member heard within this time keeps its id [s]
/// A member may send so much at once: what waits while its thread is late.
constexpr double kBurst = 0.25;  // [s]
constexpr double kLeastBurst = 64.0;

}  // namespace

Result Relay::handleRequest(ByteView datagram, const Address& from, double now) noexcept {
  const auto request = decodeRequest(datagram);
  if (!request) return Result::kForm;
  if (!isTaggedLong(key_, datagram)) {
    refuse(request->caller, Code::kKey, from, now);
    return Result::kKey;
  }
  if (readType(datagram) == Type::kHello) return answerHello(*request, from, now);
  if (!cookies_.accepts(request->cookie, makeSubject(*request, from), now)) return Result::kCookie;
  return admit(*request, from, now);
}

/// A cookie is good for the address that asked for it alone, and for this room, member and attempt.
secure::CookieSubject Relay::makeSubject(const Request& request,
                                         const Address& from) const noexcept {
  std::array<std::uint8_t, sizeof(RoomName) + 8 + 16 + 2 + 4> text;
  wire::ByteWriter writer({text.data(), text.size()});
  writer.writeBytes(request.room);
  writer.write(request.caller.nonce);
  writer.writeBytes(from.ip);
  writer.write(from.port);
  writer.write(from.scope);
  std::array<std::uint8_t, 16> digest;
  crypto_generichash(digest.data(), digest.size(), text.data(), text.size(), address_key_.data(),
                     SecretKey::kSize);
  return {request.caller.member, 0, wire::loadLittleEndian<std::uint64_t>(digest.data())};
}

Result Relay::answerHello(const Request& hello, const Address& from, double now) noexcept {
  std::array<std::uint8_t, kCookieSize> answer;
  const ByteSpan out{answer.data(), answer.size()};
  encodeCookie(hello.caller, cookies_.make(makeSubject(hello, from), now), out);
  tagLong(key_, out);
  outlet_.send({answer.data(), answer.size()}, from);
  return Result::kTaken;
}

Result Relay::admit(const Request& join, const Address& from, double now) noexcept {
  Room* room = members_.find(join.room);
  if (!room) room = members_.openRoom(join.room);
  if (!room) {
    refuse(join.caller, Code::kRooms, from, now);
    return Result::kFull;
  }
  if (Member* earlier = members_.find(*room, join.caller.member)) {
    if (earlier->nonce == join.caller.nonce) {
      sendJoined(*earlier, from);
      return Result::kTaken;
    }
    if (now - earlier->heard_at < kAlive && earlier->paths.inUse() != from) {
      refuse(join.caller, Code::kTaken, from, now);
      return Result::kIdInUse;
    }
    if (join.caller.nonce < earlier->nonce) return Result::kOld;
    members_.remove(*earlier);
  }
  Member* member = members_.add(*room, join.caller.member, join.is_watcher);
  if (!member) {
    refuse(join.caller, Code::kMembers, from, now);
    return Result::kFull;
  }
  begin(*member, join, from, now);
  sendJoined(*member, from);
  return Result::kTaken;
}

void Relay::begin(Member& member, const Request& join, const Address& from, double now) noexcept {
  member.nonce = join.caller.nonce;
  member.key = computeSessionKey(key_, join, member.session);

  member.paths.note(from, now);
  member.heard_at = now;
  member.datagrams = {datagram_rate_, std::max(kLeastBurst, kBurst * datagram_rate_)};
  member.bytes = {byte_rate_, std::max(kLeastBurst * kMaxForward, kBurst * byte_rate_)};
}

void Relay::sendJoined(const Member& member, const Address& to) noexcept {
  std::array<std::uint8_t, kJoinedSize> answer;
  const ByteSpan out{answer.data(), answer.size()};
  encodeJoined({member.id, member.nonce}, member.session, out);
  tagLong(key_, out);
  outlet_.send({answer.data(), answer.size()}, to);
}

void Relay::refuse(const Caller& caller, Code code, const Address& to, double now) noexcept {
  if (!refusals_.take(now)) return;
  std::array<std::uint8_t, kRefuseSize> answer;
  encodeRefuse(caller, code, {answer.data(), answer.size()});
  outlet_.send({answer.data(), answer.size()}, to);
}

}  // namespace tandem::relay
