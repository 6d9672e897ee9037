#include "net/session_keys.h"

namespace tandem::net {

std::size_t SessionKeys::seal(MessageType type, std::size_t payload_size,
                              ByteSpan datagram) noexcept {
  const std::size_t size = kHeaderSize + payload_size + secure::kTagSize;
  if (payload_size == 0 || size > datagram.size) return 0;
  ClearHeader header;
  header.type = type;
  header.session = theirs_;
  header.sender = pair_.self;
  header.key_epoch = epoch_;
  header.sequence = sealer_.nextSequence();
  if (encodeHeader(header, datagram) == 0) return 0;
  const AssociatedData associated = writeAssociatedData(datagram.data, pair_.self, pair_.peer);
  const secure::Bytes sealed(datagram.data + kHeaderSize, payload_size + secure::kTagSize);
  return sealer_.seal(associated, sealed) ? size : 0;
}

Refusal SessionKeys::open(const ClearHeader& header, ByteSpan datagram, double now) noexcept {
  if (datagram.size <= kHeaderSize + secure::kTagSize) return Refusal::kForged;
  if (age(now) == secure::KeyAge::kExpired) return Refusal::kExpired;
  if (!window_.check(header.sequence)) return Refusal::kReplayed;
  const AssociatedData associated = writeAssociatedData(datagram.data, pair_.peer, pair_.self);
  const secure::Bytes sealed(datagram.data + kHeaderSize, datagram.size - kHeaderSize);
  if (!opener_.open(header.sequence, associated, sealed)) return Refusal::kForged;
  return window_.commit(header.sequence) ? Refusal::kNone : Refusal::kReplayed;
}

}  // namespace tandem::net
