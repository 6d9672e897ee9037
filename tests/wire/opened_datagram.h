#pragma once

#include "coordination/src/wire/wire_agree.h"
#include "coordination/src/wire/wire_handshake.h"
#include "coordination/src/wire/wire_state.h"

/// \file
/// One function for all decoders.
namespace tandem::test {

/// Reason why the decoder of its type refuses a clear or opened datagram.
inline WireRefusal findRefusal(ByteView datagram) {
  const auto header = decodeHeader(datagram);
  if (!header) return header.refusal();
  const ByteView payload = payloadOf(datagram);
  switch (header->type) {
    case MessageType::kHello:
      return decodeHello(datagram).refusal();
    case MessageType::kCookie:
      return decodeCookie(datagram).refusal();
    case MessageType::kOpen:
      return decodeOpen(datagram).refusal();
    case MessageType::kAccept:
      return decodeAccept(datagram).refusal();
    case MessageType::kRefuse:
      return decodeRefuse(datagram).refusal();
    case MessageType::kState:
      return decodeState(payload, header->sender).refusal();
    case MessageType::kAgree:
      return decodeAgree(payload).refusal();
    case MessageType::kAgreeAck:
      return decodeAgreeAck(payload).refusal();
    case MessageType::kBye:
      return decodeBye(payload).refusal();
    case MessageType::kPathChallenge:
    case MessageType::kPathResponse:
      return decodePath(payload).refusal();
  }
  return WireRefusal::kType;
}

}  // namespace tandem::test
