#include "relay/admission_wire.h"

#include <algorithm>

#include "relay/wire_start.h"

namespace tandem::relay {
namespace {

using wire::ByteReader;
using wire::ByteWriter;

/// Offset of the first byte that follows the type.
constexpr std::size_t kCallerOffset = kTypeOffset + 1;
constexpr std::size_t kRoleOffset = kCallerOffset + 2;

void writeCaller(ByteWriter& writer, Type type, const Caller& caller, std::uint8_t code) noexcept {
  writeStart(writer, type);
  writer.write(caller.member);
  writer.write(code);
  writer.write(std::uint8_t{0});
  writer.write(caller.nonce);
}

/// Reads the rest of the caller's 16 bytes. The byte between is at most `most`.
std::optional<Caller> readCaller(ByteReader& reader, std::uint16_t most = 0) noexcept {
  Caller caller;
  caller.member = reader.read<std::uint16_t>();
  const auto between = reader.read<std::uint16_t>();
  caller.nonce = reader.read<std::uint64_t>();
  if (!isMember(caller.member) || between > most) return std::nullopt;
  return caller;
}

}  // namespace

std::size_t encodeRequest(Type type, const Request& request, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeCaller(writer, type, request.caller, request.is_watcher ? 1 : 0);
  writer.writeBytes(request.room);
  writer.writeBytes(request.cookie);
  writer.writeZeros(kHelloSize - kLongTag - writer.size());
  return kHelloSize;
}

Caller peekCaller(ByteView hello) noexcept {
  ByteReader reader({hello.data + kCallerOffset, hello.size - kCallerOffset});
  Caller caller;
  caller.member = reader.read<std::uint16_t>();
  (void)reader.read<std::uint16_t>();
  caller.nonce = reader.read<std::uint64_t>();
  return caller;
}

std::optional<Request> decodeRequest(ByteView datagram) noexcept {
  const auto type = readType(datagram);
  if (type != Type::kHello && type != Type::kJoin) return std::nullopt;
  auto reader = open(datagram, *type, kHelloSize, kCallerOffset, kLongTag);
  if (!reader) return std::nullopt;
  const auto caller = readCaller(*reader, 1);
  if (!caller) return std::nullopt;
  Request request;
  request.caller = *caller;
  request.is_watcher = datagram.data[kRoleOffset] != 0;
  const std::string_view name = reader->readText(request.room.size());
  std::copy(name.begin(), name.end(), request.room.begin());
  reader->readInto(request.cookie);
  const bool has_cookie = request.cookie != CookieBytes{};
  if (!isRoomName(request.room) || has_cookie != (type == Type::kJoin) || !reader->hasOnlyZeros())
    return std::nullopt;
  return request;
}

std::size_t encodeCookie(const Caller& caller, const CookieBytes& cookie, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeCaller(writer, Type::kCookie, caller, 0);
  writer.writeBytes(cookie);
  return kCookieSize;
}

std::optional<CookieAnswer> decodeCookieAnswer(ByteView datagram) noexcept {
  auto reader = open(datagram, Type::kCookie, kCookieSize, kCallerOffset, kLongTag);
  const auto caller = reader ? readCaller(*reader) : std::nullopt;
  if (!caller) return std::nullopt;
  CookieAnswer answer{*caller, {}};
  reader->readInto(answer.cookie);
  return answer;
}

std::size_t encodeJoined(const Caller& caller, std::uint32_t session, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeCaller(writer, Type::kJoined, caller, 0);
  writer.write(session);
  writer.write(std::uint32_t{0});
  return kJoinedSize;
}

std::optional<JoinedAnswer> decodeJoinedAnswer(ByteView datagram) noexcept {
  auto reader = open(datagram, Type::kJoined, kJoinedSize, kCallerOffset, kLongTag);
  const auto caller = reader ? readCaller(*reader) : std::nullopt;
  if (!caller) return std::nullopt;
  const JoinedAnswer answer{*caller, reader->read<std::uint32_t>()};
  if (answer.session == 0 || reader->read<std::uint32_t>() != 0) return std::nullopt;
  return answer;
}

std::size_t encodeRefuse(const Caller& caller, Code code, ByteSpan out) noexcept {
  ByteWriter writer(out);
  writeCaller(writer, Type::kRefuse, caller, static_cast<std::uint8_t>(code));
  return kRefuseSize;
}

std::optional<RefuseAnswer> decodeRefuseAnswer(ByteView datagram) noexcept {
  ByteReader reader(datagram);
  if (datagram.size != kRefuseSize || reader.read<std::uint16_t>() != kMagic) return std::nullopt;
  RefuseAnswer answer;
  answer.version = reader.read<std::uint8_t>();
  const auto type = static_cast<Type>(reader.read<std::uint8_t>());
  answer.caller.member = reader.read<std::uint16_t>();
  answer.code = static_cast<Code>(reader.read<std::uint8_t>());
  const auto zero = reader.read<std::uint8_t>();
  answer.caller.nonce = reader.read<std::uint64_t>();
  const bool is_code = answer.code >= Code::kVersion && answer.code <= Code::kSession;
  const bool is_version = answer.version == kRelayVersion || answer.code == Code::kVersion;
  if (type != Type::kRefuse || zero != 0 || !is_code || !is_version) return std::nullopt;
  return answer;
}

}  // namespace tandem::relay
