// Clear and opened datagrams: each one that a decoder accepts, its encoder writes to the same
// bytes.
//
// Only STATE may differ: a quaternion is normalised, so a float's may change in its last bits. The
// encoder's bytes then decode to the same.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "coordination/src/wire/wire_agree.h"
#include "coordination/src/wire/wire_handshake.h"
#include "coordination/src/wire/wire_state.h"
#include "wire/opened_datagram.h"

namespace tandem {
namespace {

using Room = std::array<std::uint8_t, kMaxDatagramSize>;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Requires encode(room) to write exactly these bytes.
template <class Encode>
void requireSame(ByteView bytes, const Encode& encode) {
  Room room;
  require(encode(ByteSpan{room.data(), room.size()}) == bytes.size);
  require(std::memcmp(room.data(), bytes.data, bytes.size) == 0);
}

double computeDistance(const Quat& a, const Quat& b) {
  return (a.coeffs() - b.coeffs()).cwiseAbs().maxCoeff();
}

/// Requires equal messages except for the rounding of orientations.
void requireSame(const StateMessage& a, const StateMessage& b) {
  const double rounding = a.profile == WireProfile::kFloat32 ? 1e-6 : 0.0;
  require(a.packet.object_count == b.packet.object_count);
  require(a.packet.time == b.packet.time && a.packet.sequence == b.packet.sequence);
  require(a.packet.user.p_W == b.packet.user.p_W && a.packet.user.v_W == b.packet.user.v_W);
  require(a.packet.grip.has_value() == b.packet.grip.has_value());
  if (a.packet.grip) {
    const GripState &left = *a.packet.grip, &right = *b.packet.grip;
    require(left.epoch == right.epoch && left.object == right.object && left.age == right.age);
    require(left.p_BG == right.p_BG);
    require(computeDistance(left.q_BG, right.q_BG) <= rounding);
  }
  require(a.packet.roll.has_value() == b.packet.roll.has_value());
  if (a.packet.roll) {
    const RollCall &left = *a.packet.roll, &right = *b.packet.roll;
    require(left.heard == right.heard && left.members == right.members && left.age == right.age);
  }
  for (std::size_t i = 0; i < a.packet.object_count; ++i) {
    const ObjectState& left = a.packet.objects[i];
    const ObjectState& right = b.packet.objects[i];
    require(left.id == right.id && left.epoch == right.epoch);
    require(left.state.p_W == right.state.p_W);
    require(left.state.v_W == right.state.v_W && left.state.w_W == right.state.w_W);
    require(computeDistance(left.state.q_WB, right.state.q_WB) <= rounding);
  }
}

void checkState(ByteView payload, PeerId sender) {
  const auto message = decodeState(payload, sender);
  if (!message) return;
  require(isSane(message->packet));
  Room room;
  require(encodeState(*message, {room.data(), room.size()}) == payload.size);
  require(std::memcmp(payload.data, room.data(), kStateBlockSize) == 0);
  const auto again = decodeState({room.data(), payload.size}, sender);
  require(static_cast<bool>(again));
  requireSame(*message, *again);
}

void checkAgree(ByteView payload) {
  const auto part = decodeAgree(payload);
  if (!part) return;
  requireSame(payload, [&](ByteSpan out) { return encodeAgree(*part, out); });
  AgreeCollector collector;
  require(collector.add(*part));
  const AgreeAnswer answer = collector.answer({{"object.mass", "0.2"}});
  Room room;
  require(encodeAgreeAck(answer, {room.data(), room.size()}) > 0);
}

void checkSealedType(const ClearHeader& header, ByteView payload) {
  if (header.type == MessageType::kState) checkState(payload, header.sender);
  if (header.type == MessageType::kAgree) checkAgree(payload);
  if (header.type == MessageType::kAgreeAck) {
    if (const auto answer = decodeAgreeAck(payload))
      requireSame(payload, [&](ByteSpan out) { return encodeAgreeAck(*answer, out); });
  }
  if (header.type == MessageType::kPathChallenge || header.type == MessageType::kPathResponse) {
    if (const auto token = decodePath(payload))
      requireSame(payload, [&](ByteSpan out) { return encodePath(*token, out); });
  }
  if (header.type == MessageType::kBye) {
    if (const auto reason = decodeBye(payload))
      requireSame(payload, [&](ByteSpan out) { return encodeBye(*reason, out); });
  }
}

void checkHandshake(ByteView datagram) {
  if (const auto m = decodeHello(datagram))
    requireSame(datagram, [&](ByteSpan out) { return encodeHello(*m, out); });
  if (const auto m = decodeCookie(datagram))
    requireSame(datagram, [&](ByteSpan out) { return encodeCookie(*m, out); });
  if (const auto m = decodeOpen(datagram))
    requireSame(datagram, [&](ByteSpan out) { return encodeOpen(*m, out); });
  if (const auto m = decodeAccept(datagram))
    requireSame(datagram, [&](ByteSpan out) { return encodeAccept(*m, out); });
  if (const auto m = decodeRefuse(datagram))
    requireSame(datagram, [&](ByteSpan out) { return encodeRefuse(*m, out); });
  Room room;
  const std::size_t answer = encodeVersionRefusal(datagram, {room.data(), room.size()});
  require(answer == 0 || (answer < datagram.size && decodeRefuse({room.data(), answer})));
}

void check(ByteView datagram) {
  const WireRefusal refusal = test::findRefusal(datagram);
  require(std::strcmp(name(refusal), "unknown") != 0);
  checkHandshake(datagram);
  const auto header = decodeHeader(datagram);
  if (!header) return;
  requireSame({datagram.data, kHeaderSize},
              [&](ByteSpan out) { return encodeHeader(*header, out); });
  if (isSealed(header->type)) checkSealedType(*header, payloadOf(datagram));
}

}  // namespace
}  // namespace tandem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tandem::check({data, size});
  return 0;
}
