#include "wire/wire_sealing.h"

#include <string_view>

#include "wire/byte_reader.h"
#include "wire/byte_writer.h"

namespace tandem {
namespace {

constexpr std::string_view kLabel = "tandem/1";

void writeId(PeerId peer, wire::ByteWriter& writer) noexcept {
  writer.write(static_cast<std::uint16_t>(peer));
}

}  // namespace

NoisePrologue writeNoisePrologue(PeerId initiator, PeerId responder,
                                 const CookieBytes& cookie) noexcept {
  NoisePrologue prologue{};
  wire::ByteWriter writer({prologue.data(), prologue.size()});
  writer.writeBytes(kLabel);
  writeId(initiator, writer);
  writeId(responder, writer);
  writer.write(kWireVersion);
  writer.writeBytes(cookie);
  return prologue;
}

SessionTermsBytes writeSessionTerms(const SessionTerms& terms) noexcept {
  SessionTermsBytes bytes{};
  wire::ByteWriter writer({bytes.data(), bytes.size()});
  writer.write(terms.session);
  writer.write(terms.key_epoch);
  writer.write(terms.minor);
  return bytes;
}

Decoded<SessionTerms> readSessionTerms(const SessionTermsBytes& bytes) noexcept {
  wire::ByteReader reader({bytes.data(), bytes.size()});
  Decoded<SessionTerms> terms(WireRefusal::kNone);
  terms->session = reader.read<std::uint32_t>();
  terms->key_epoch = reader.read<std::uint16_t>();
  terms->minor = reader.read<std::uint8_t>();
  if (terms->session == 0 || terms->key_epoch == 0) return WireRefusal::kTerms;
  if (!reader.hasOnlyZeros()) return WireRefusal::kZero;
  return terms;
}

AssociatedData writeAssociatedData(const std::uint8_t* header, PeerId from, PeerId to) noexcept {
  AssociatedData data{};
  wire::ByteWriter writer({data.data(), data.size()});
  writer.writeBytes(kLabel);
  writer.writeBytes(std::string_view(reinterpret_cast<const char*>(header), kHeaderSize));
  writeId(from, writer);
  writeId(to, writer);
  return data;
}

SealNonce writeNonce(std::uint32_t salt, std::uint64_t sequence) noexcept {
  SealNonce nonce{};
  wire::ByteWriter writer({nonce.data(), nonce.size()});
  writer.write(salt);
  writer.write(sequence);
  return nonce;
}

}  // namespace tandem
