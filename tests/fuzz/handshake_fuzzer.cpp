// Bytes for the handshake, for sealed datagrams and for key files. The first byte selects which.
// Without the key no accepted bytes can be made: only the right bytes themselves are accepted.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "secure/handshake.h"
#include "secure/key_text.h"
#include "secure/seal.h"

namespace tandem::secure {
namespace {

constexpr std::string_view kPrologue = "tandem/1";

void require(bool holds) {
  if (!holds) std::abort();
}

ByteView prologue() {
  return {reinterpret_cast<const std::uint8_t*>(kPrologue.data()), kPrologue.size()};
}

/// Fixed keys, so that a seed of the corpus can hold the right bytes.
SecretKey makeKey(std::uint8_t value) {
  std::array<std::uint8_t, SecretKey::kSize> bytes;
  bytes.fill(value);
  return SecretKey::take(bytes);
}

Initiator makeInitiator() { return {makeKey(1), prologue(), makeKey(2)}; }
Responder makeResponder() { return {makeKey(1), prologue(), makeKey(3)}; }

/// The right messages, with empty payloads.
struct Right {
  std::array<std::uint8_t, kHandshakeOverhead> first, second;
  std::array<std::uint8_t, 8 + kTagSize> datagram{};

  Right() {
    Initiator initiator = makeInitiator();
    Responder responder = makeResponder();
    require(initiator.writeMessage({}, first) && responder.readMessage(first, {}) &&
            responder.writeMessage({}, second) && initiator.readMessage(second, {}));
    require(Sealer(makeKey(4), 5).seal(prologue(), datagram));
  }
};

bool isSame(ByteView one, ByteView other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end());
}

/// A side accepts only the right message, and still accepts it after a wrong one.
template <typename Side>
void readMessage(Side& side, ByteView message, ByteView right) {
  std::vector<std::uint8_t> payload(message.size());
  const bool is_read = side.readMessage(message, payload).has_value();
  require(is_read == isSame(message, right));
  require(is_read || side.readMessage(right, payload).has_value());
}

void openDatagram(ByteView sealed, ByteView right) {
  std::vector<std::uint8_t> datagram(sealed.begin(), sealed.end());
  require(Opener(makeKey(4), 5).open(0, prologue(), datagram) == isSame(sealed, right));
}

/// A text that reads as a key is written as digits that read as the same key.
void readKey(ByteView bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::array<std::uint8_t, kKeySize> key, again;
  key.fill(0xaa);
  if (readKeyText(text, key) != KeyTextFault::kNone) {
    require(std::all_of(key.begin(), key.end(), [](std::uint8_t byte) { return byte == 0; }));
    return;
  }
  std::array<char, kKeyTextSize> written;
  writeKeyText(key, written);
  require(readKeyText({written.data(), written.size()}, again) == KeyTextFault::kNone);
  require(key == again);
}

/// Any payload arrives unchanged.
void carryPayload(ByteView payload) {
  Initiator initiator = makeInitiator();
  std::vector<std::uint8_t> message(payload.size() + kHandshakeOverhead), read(payload.size());
  require(initiator.writeMessage(payload, message) == message.size());
  Responder responder = makeResponder();
  require(responder.readMessage(message, read) == payload.size());
  require(isSame(payload, read));
}

void run(std::uint8_t what, ByteView bytes) {
  static const Right right;
  switch (what % 5) {
    case 0: {
      Responder responder = makeResponder();
      return readMessage(responder, bytes, right.first);
    }
    case 1: {
      Initiator initiator = makeInitiator();
      std::array<std::uint8_t, kHandshakeOverhead> first;
      require(initiator.writeMessage({}, first).has_value());
      return readMessage(initiator, bytes, right.second);
    }
    case 2:
      return openDatagram(bytes, right.datagram);
    case 3:
      return readKey(bytes);
    default:
      return carryPayload(bytes);
  }
}

}  // namespace
}  // namespace tandem::secure

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) tandem::secure::run(data[0], {data + 1, size - 1});
  return 0;
}
