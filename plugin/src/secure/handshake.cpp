#include "secure/handshake.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace tandem::secure {
namespace {

constexpr std::string_view kProtocol = "Noise_NNpsk0_25519_ChaChaPoly_BLAKE2b";
constexpr std::size_t kPublicSize = crypto_scalarmult_BYTES;
constexpr std::size_t kLargestMessage = 65535;  // limit of the Noise specification

static_assert(kProtocol.size() <= kHashSize);
static_assert(SecretKey::kSize == kKeySize && SecretKey::kSize == crypto_scalarmult_SCALARBYTES);

ByteView bytesOf(std::string_view text) noexcept {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

ByteView bytesOf(const SecretKey& key) noexcept { return {key.data(), SecretKey::kSize}; }

}  // namespace

HandshakeState::HandshakeState(const SecretKey& shared, ByteView prologue, SecretKey ephemeral)
    : ephemeral_(std::move(ephemeral)) {
  if (shared.isEmpty() || ephemeral_.isEmpty())
    throw std::invalid_argument("a key of the handshake was moved away; give one that holds bytes");
  State& state = both_->current;
  state.start(bytesOf(kProtocol));
  state.mixHash(prologue);
  state.mixKeyAndHash(bytesOf(shared));
}

/// Mixes in the tokens of a message whose sender has this public key. Returns false for a point of
/// low order.
bool HandshakeState::mixTokens(Tokens tokens, ByteView sender) noexcept {
  State& state = both_->trial;
  // With a pre-shared key, e is mixed into the key, too (section 9.2).
  state.mixHash(sender);
  state.mixKey(sender);
  if (tokens == Tokens::kE) return true;
  WipedBytes<crypto_scalarmult_BYTES> exchanged;
  if (crypto_scalarmult(exchanged.data(), ephemeral_.data(), state.remote.data()) != 0)
    return false;
  state.mixKey(exchanged);
  return true;
}

std::optional<std::size_t> HandshakeState::write(Tokens tokens, ByteView payload,
                                                 Bytes message) noexcept {
  const std::size_t size = payload.size() + kHandshakeOverhead;
  if (message.size() < size || size > kLargestMessage) return std::nullopt;
  both_->trial = both_->current;

  WipedBytes<kPublicSize> own;
  crypto_scalarmult_base(own.data(), ephemeral_.data());
  if (!mixTokens(tokens, own)) {
    forgetTrial();
    return std::nullopt;
  }
  std::copy(own.begin(), own.end(), message.begin());
  both_->trial.encryptAndHash(payload, message.subspan(kPublicSize, payload.size() + kTagSize));
  both_->current = both_->trial;
  forgetTrial();
  return size;
}

std::optional<std::size_t> HandshakeState::read(Tokens tokens, ByteView message,
                                                Bytes payload) noexcept {
  if (message.size() < kHandshakeOverhead || message.size() > kLargestMessage) return std::nullopt;
  const std::size_t size = message.size() - kHandshakeOverhead;
  if (payload.size() < size) return std::nullopt;
  both_->trial = both_->current;

  const ByteView sender = message.first(kPublicSize);
  std::copy(sender.begin(), sender.end(), both_->trial.remote.begin());
  const bool is_right =
      mixTokens(tokens, sender) &&
      both_->trial.decryptAndHash(message.subspan(kPublicSize), payload.first(size));
  if (is_right) both_->current = both_->trial;
  forgetTrial();
  return is_right ? std::optional(size) : std::nullopt;
}

void HandshakeState::forgetEphemeral() noexcept {
  const SecretKey wiped_at_the_end = std::move(ephemeral_);
}

void HandshakeState::forgetTrial() noexcept { sodium_memzero(&both_->trial, sizeof(State)); }

std::array<SecretKey, 2> HandshakeState::split() {
  State& state = both_->current;
  std::array<std::uint8_t, kKeySize> to_responder, to_initiator;
  {
    WipedBytes<kHashSize> first, second;
    computeHkdf(state.chaining_key, {}, first, second);
    std::copy_n(first.begin(), kKeySize, to_responder.begin());
    std::copy_n(second.begin(), kKeySize, to_initiator.begin());
  }
  sodium_memzero(state.chaining_key.data(), kHashSize);
  sodium_memzero(state.key.data(), kKeySize);
  SecretKey there = SecretKey::take(to_responder);
  return {std::move(there), SecretKey::take(to_initiator)};
}

Initiator::Initiator(const SecretKey& shared, ByteView prologue, SecretKey ephemeral)
    : state_(shared, prologue, std::move(ephemeral)) {}

std::optional<std::size_t> Initiator::writeMessage(ByteView payload, Bytes message) noexcept {
  if (turn_ != Turn::kWrite) return std::nullopt;
  const auto size = state_.write(HandshakeState::Tokens::kE, payload, message);
  if (size) turn_ = Turn::kRead;
  return size;
}

std::optional<std::size_t> Initiator::readMessage(ByteView message, Bytes payload) noexcept {
  if (turn_ != Turn::kRead) return std::nullopt;
  const auto size = state_.read(HandshakeState::Tokens::kEAndEe, message, payload);
  if (!size) return std::nullopt;
  state_.forgetEphemeral();
  turn_ = Turn::kComplete;
  return size;
}

std::optional<TransportKeys> Initiator::split() {
  if (turn_ != Turn::kComplete) return std::nullopt;
  turn_ = Turn::kSplit;
  auto [to_responder, to_initiator] = state_.split();
  return TransportKeys{std::move(to_responder), std::move(to_initiator)};
}

Responder::Responder(const SecretKey& shared, ByteView prologue, SecretKey ephemeral)
    : state_(shared, prologue, std::move(ephemeral)) {}

std::optional<std::size_t> Responder::readMessage(ByteView message, Bytes payload) noexcept {
  if (turn_ != Turn::kRead) return std::nullopt;
  const auto size = state_.read(HandshakeState::Tokens::kE, message, payload);
  if (size) turn_ = Turn::kWrite;
  return size;
}

std::optional<std::size_t> Responder::writeMessage(ByteView payload, Bytes message) noexcept {
  if (turn_ != Turn::kWrite) return std::nullopt;
  const auto size = state_.write(HandshakeState::Tokens::kEAndEe, payload, message);
  if (!size) return std::nullopt;
  state_.forgetEphemeral();
  turn_ = Turn::kComplete;
  return size;
}

std::optional<TransportKeys> Responder::split() {
  if (turn_ != Turn::kComplete) return std::nullopt;
  turn_ = Turn::kSplit;
  auto [to_responder, to_initiator] = state_.split();
  return TransportKeys{std::move(to_initiator), std::move(to_responder)};
}

}  // namespace tandem::secure
