#include "wire/wire_handshake.h"

#include <algorithm>

#include "wire/byte_reader.h"
#include "wire/byte_writer.h"

// Layout: 20 receiver u16 | code u8 | zero u8 | nonce u64 | fields of the type
namespace tandem {
namespace {

constexpr std::size_t kRouteEnd = 32;

/// Fields common to all five types.
struct Envelope {
  ClearHeader header;
  PeerId receiver{};
  std::uint8_t code = 0;
  std::uint64_t nonce = 0;

  [[nodiscard]] HandshakeRoute route() const noexcept { return {header.sender, receiver, nonce}; }
};

constexpr std::size_t sizeOf(MessageType type) noexcept {
  switch (type) {
    case MessageType::kHello:
      return kHelloSize;
    case MessageType::kCookie:
      return kCookieSize;
    case MessageType::kOpen:
      return kOpenSize;
    case MessageType::kAccept:
      return kAcceptSize;
    default:
      return kRefuseSize;
  }
}

/// HELLO goes both ways, REFUSE too.
bool isOfRole(MessageType type, bool is_initiator) noexcept {
  if (type == MessageType::kHello) return true;
  return is_initiator == (type == MessageType::kOpen);
}

/// Checks the route and the code, in the order of section 4.
WireRefusal findFault(const Envelope& envelope) noexcept {
  const MessageType type = envelope.header.type;
  const auto sender = static_cast<std::uint32_t>(envelope.header.sender);
  const auto receiver = static_cast<std::uint32_t>(envelope.receiver);
  if (receiver < 1 || receiver > kMaxPeerId || receiver == sender) return WireRefusal::kReceiver;
  if (type == MessageType::kRefuse) {
    const bool known = envelope.code >= static_cast<std::uint8_t>(RefuseCode::kVersion) &&
                       envelope.code <= static_cast<std::uint8_t>(RefuseCode::kBusy);
    return known ? WireRefusal::kNone : WireRefusal::kCode;
  }
  if (!isOfRole(type, sender < receiver)) return WireRefusal::kRole;
  return envelope.code == 0 ? WireRefusal::kNone : WireRefusal::kZero;
}

ClearHeader makeHeader(MessageType type, const HandshakeRoute& route) noexcept {
  ClearHeader header;
  header.type = type;
  header.sender = route.sender;
  return header;
}

/// Writes header and route. False, with nothing written, if there is no room or the message is
/// outside the standard.
bool writeEnvelope(const ClearHeader& header, const HandshakeRoute& route, std::uint8_t code,
                   ByteSpan out) noexcept {
  const Envelope envelope{header, route.receiver, code, route.nonce};
  if (out.size < sizeOf(header.type) || findFault(envelope) != WireRefusal::kNone) return false;
  if (encodeHeader(header, out) == 0) return false;
  wire::ByteWriter writer({out.data + kHeaderSize, out.size - kHeaderSize});
  writer.write(static_cast<std::uint16_t>(route.receiver));
  writer.write(code);
  writer.writeZeros(1);
  writer.write(route.nonce);
  return true;
}

wire::ByteWriter makeBodyWriter(ByteSpan out) noexcept {
  return wire::ByteWriter({out.data + kRouteEnd, out.size - kRouteEnd});
}

wire::ByteReader makeBodyReader(ByteView datagram) noexcept {
  return wire::ByteReader({datagram.data + kRouteEnd, datagram.size - kRouteEnd});
}

Decoded<Envelope> decodeEnvelope(ByteView datagram, MessageType type) noexcept {
  const Decoded<ClearHeader> header = decodeHeader(datagram);
  if (!header) return header.refusal();
  if (header->type != type) return WireRefusal::kType;
  if (datagram.size != sizeOf(type)) return WireRefusal::kWrongSize;

  wire::ByteReader reader(payloadOf(datagram));
  Decoded<Envelope> envelope(WireRefusal::kNone);
  envelope->header = *header;
  envelope->receiver = PeerId{reader.read<std::uint16_t>()};
  envelope->code = reader.read<std::uint8_t>();
  const bool zero = reader.read<std::uint8_t>() == 0;
  envelope->nonce = reader.read<std::uint64_t>();
  const WireRefusal fault = findFault(*envelope);
  if (fault != WireRefusal::kNone) return fault;
  if (!zero) return WireRefusal::kZero;
  return envelope;
}

}  // namespace

std::size_t encodeHello(const HelloMessage& message, ByteSpan out) noexcept {
  const ClearHeader header = makeHeader(MessageType::kHello, message.route);
  if (!writeEnvelope(header, message.route, 0, out)) return 0;
  wire::ByteWriter writer = makeBodyWriter(out);
  writer.writeBytes(message.tag);
  writer.writeZeros(kHelloSize - kHelloTagOffset - message.tag.size());
  return kHelloSize;
}

std::size_t encodeCookie(const CookieMessage& message, ByteSpan out) noexcept {
  const ClearHeader header = makeHeader(MessageType::kCookie, message.route);
  if (!writeEnvelope(header, message.route, 0, out)) return 0;
  wire::ByteWriter writer = makeBodyWriter(out);
  writer.writeBytes(message.cookie);
  writer.writeBytes(message.tag);
  return kCookieSize;
}

std::size_t encodeOpen(const OpenMessage& message, ByteSpan out) noexcept {
  ClearHeader header = makeHeader(MessageType::kOpen, message.route);
  header.key_epoch = message.key_epoch;
  if (!writeEnvelope(header, message.route, 0, out)) return 0;
  wire::ByteWriter writer = makeBodyWriter(out);
  writer.writeBytes(message.cookie);
  writer.writeBytes(message.noise);
  writer.writeBytes(message.tag);
  return kOpenSize;
}

std::size_t encodeAccept(const AcceptMessage& message, ByteSpan out) noexcept {
  ClearHeader header = makeHeader(MessageType::kAccept, message.route);
  header.session = message.session;
  header.key_epoch = message.key_epoch;
  if (!writeEnvelope(header, message.route, 0, out)) return 0;
  makeBodyWriter(out).writeBytes(message.noise);
  return kAcceptSize;
}

std::size_t encodeRefuse(const RefuseMessage& message, ByteSpan out) noexcept {
  ClearHeader header = makeHeader(MessageType::kRefuse, message.route);
  header.version = message.version;
  const auto code = static_cast<std::uint8_t>(message.code);
  return writeEnvelope(header, message.route, code, out) ? kRefuseSize : 0;
}

Decoded<HelloMessage> decodeHello(ByteView datagram) noexcept {
  const auto envelope = decodeEnvelope(datagram, MessageType::kHello);
  if (!envelope) return envelope.refusal();
  Decoded<HelloMessage> message(WireRefusal::kNone);
  message->route = envelope->route();
  wire::ByteReader reader = makeBodyReader(datagram);
  reader.readInto(message->tag);
  if (!reader.hasOnlyZeros()) return WireRefusal::kZero;
  return message;
}

Decoded<CookieMessage> decodeCookie(ByteView datagram) noexcept {
  const auto envelope = decodeEnvelope(datagram, MessageType::kCookie);
  if (!envelope) return envelope.refusal();
  Decoded<CookieMessage> message(WireRefusal::kNone);
  message->route = envelope->route();
  wire::ByteReader reader = makeBodyReader(datagram);
  reader.readInto(message->cookie);
  reader.readInto(message->tag);
  return message;
}

Decoded<OpenMessage> decodeOpen(ByteView datagram) noexcept {
  const auto envelope = decodeEnvelope(datagram, MessageType::kOpen);
  if (!envelope) return envelope.refusal();
  Decoded<OpenMessage> message(WireRefusal::kNone);
  message->route = envelope->route();
  message->key_epoch = envelope->header.key_epoch;
  wire::ByteReader reader = makeBodyReader(datagram);
  reader.readInto(message->cookie);
  reader.readInto(message->noise);
  reader.readInto(message->tag);
  return message;
}

Decoded<AcceptMessage> decodeAccept(ByteView datagram) noexcept {
  const auto envelope = decodeEnvelope(datagram, MessageType::kAccept);
  if (!envelope) return envelope.refusal();
  Decoded<AcceptMessage> message(WireRefusal::kNone);
  message->route = envelope->route();
  message->session = envelope->header.session;
  message->key_epoch = envelope->header.key_epoch;
  makeBodyReader(datagram).readInto(message->noise);
  return message;
}

Decoded<RefuseMessage> decodeRefuse(ByteView datagram) noexcept {
  const auto envelope = decodeEnvelope(datagram, MessageType::kRefuse);
  if (!envelope) return envelope.refusal();
  Decoded<RefuseMessage> message(WireRefusal::kNone);
  message->route = envelope->route();
  message->code = static_cast<RefuseCode>(envelope->code);
  message->version = envelope->header.version;
  return message;
}

std::size_t encodeVersionRefusal(ByteView hello, ByteSpan out) noexcept {
  constexpr std::size_t kVersionOffset = 2;
  if (hello.size != kHelloSize || hello.data[kVersionOffset] == kWireVersion) return 0;
  std::array<std::uint8_t, kHelloSize> as_ours{};
  std::copy(hello.data, hello.data + hello.size, as_ours.begin());
  as_ours[kVersionOffset] = kWireVersion;
  const auto message = decodeHello({as_ours.data(), as_ours.size()});
  if (!message) return 0;
  const HandshakeRoute& asked = message->route;
  return encodeRefuse({{asked.receiver, asked.sender, asked.nonce}, RefuseCode::kVersion}, out);
}

}  // namespace tandem
