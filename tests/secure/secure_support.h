#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tandem/plugin/secret_key.h"

#include "secure/handshake.h"

namespace tandem::test {

using ByteVector = std::vector<std::uint8_t>;

inline ByteVector bytesOf(std::string_view text) { return {text.begin(), text.end()}; }

inline std::string toHex(secure::ByteView bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

inline ByteVector fromHex(std::string_view text) {
  ByteVector bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(text.substr(i, 2)), nullptr, 16)));
  return bytes;
}

inline SecretKey keyOf(secure::ByteView bytes) {
  if (bytes.size() != SecretKey::kSize) throw std::logic_error("a key has 32 bytes");
  std::array<std::uint8_t, SecretKey::kSize> copy{};
  std::copy(bytes.begin(), bytes.end(), copy.begin());
  return SecretKey::take(copy);
}

inline SecretKey copyOf(const SecretKey& key) { return keyOf({key.data(), SecretKey::kSize}); }

inline std::string toHex(const SecretKey& key) { return toHex({key.data(), SecretKey::kSize}); }

/// Random draws for property tests; equal everywhere for the same seed.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t number() { return engine_(); }
  std::size_t below(std::size_t end) { return static_cast<std::size_t>(engine_() % end); }
  ByteVector bytes(std::size_t size) {
    ByteVector drawn(size);
    for (std::uint8_t& byte : drawn) byte = static_cast<std::uint8_t>(engine_());
    return drawn;
  }
  SecretKey key() { return keyOf(bytes(SecretKey::kSize)); }

  /// A change that an attacker without the key may make to a datagram; never the datagram itself.
  ByteVector forge(const ByteVector& right) {
    ByteVector wrong = right;
    do {
      switch (below(5)) {
        case 0:  // one bit flipped
          if (!wrong.empty())
            wrong[below(wrong.size())] ^= static_cast<std::uint8_t>(1U << below(8));
          break;
        case 1:  // some bytes changed
          for (std::size_t i = below(8) + 1; i > 0 && !wrong.empty(); --i)
            wrong[below(wrong.size())] = static_cast<std::uint8_t>(engine_());
          break;
        case 2:  // truncated
          wrong.resize(below(right.size()));
          break;
        case 3:  // extended
          wrong.resize(right.size() + below(40) + 1, static_cast<std::uint8_t>(engine_()));
          break;
        default:  // all new
          wrong = bytes(below(2 * right.size()));
      }
    } while (wrong == right);
    return wrong;
  }

 private:
  std::mt19937_64 engine_;
};

/// Two sides of a handshake, from drawn or given keys.
struct Pair {
  secure::Initiator initiator;
  secure::Responder responder;

  Pair(const SecretKey& shared, secure::ByteView prologue)
      : initiator(shared, prologue), responder(shared, prologue) {}
  Pair(const SecretKey& shared, secure::ByteView prologue, SecretKey e1, SecretKey e2)
      : initiator(shared, prologue, std::move(e1)), responder(shared, prologue, std::move(e2)) {}
};

/// Writes a message with this payload; empty if the side refuses.
template <typename Side>
ByteVector write(Side& side, secure::ByteView payload = {}) {
  ByteVector message(payload.size() + secure::kHandshakeOverhead);
  if (side.writeMessage(payload, message) != message.size()) message.clear();
  return message;
}

/// Reads the payload of a message; empty if the side refuses.
template <typename Side>
std::optional<ByteVector> read(Side& side, secure::ByteView message) {
  ByteVector payload(message.size());
  const auto size = side.readMessage(message, payload);
  if (!size) return std::nullopt;
  payload.resize(*size);
  return payload;
}

}  // namespace tandem::test
