#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "tandem/plugin/secret_key.h"

#include "secure/bytes.h"
#include "secure/locked_memory.h"
#include "secure/symmetric_state.h"

/// \file
/// The handshake Noise_NNpsk0_25519_ChaChaPoly_BLAKE2b (Noise specification, revision 34): two
/// sites that hold the same key agree on two fresh ones, which nobody learns who gets the key
/// later.
///
///     initiator                                           responder
///     writeMessage --- e, sealed payload ---------------> readMessage
///     readMessage  <-- e, sealed payload under e·e ------ writeMessage
///     split                                               split
///
/// Making one and split() take locked memory and may throw std::bad_alloc: not real-time safe. What
/// reads bytes from the network does not throw: bytes that do not fit, were not made with the same
/// key and prologue, or bring a point of low order are refused, and leave everything as it was, so
/// that forged bytes cannot end a handshake that is under way.
namespace tandem::secure {

/// A handshake message is its payload and this much more [bytes].
inline constexpr std::size_t kHandshakeOverhead = crypto_scalarmult_BYTES + kTagSize;

/// Keys of one direction each, for this side.
struct TransportKeys {
  SecretKey send;
  SecretKey receive;
};

/// What both sides do alike: one ephemeral key pair, and a message in each direction.
class HandshakeState {
 public:
  /// Mixes in the prologue and the shared key, which is not kept.
  HandshakeState(const SecretKey& shared, ByteView prologue, SecretKey ephemeral);

  /// Whether a message also mixes in what both ephemeral keys give (token `ee`), or its sender's
  /// public key only (token `e`).
  enum class Tokens { kE, kEAndEe };

  [[nodiscard]] std::optional<std::size_t> write(Tokens tokens, ByteView payload,
                                                 Bytes message) noexcept;
  [[nodiscard]] std::optional<std::size_t> read(Tokens tokens, ByteView message,
                                                Bytes payload) noexcept;

  /// Wipes what no later message needs.
  void forgetEphemeral() noexcept;

  [[nodiscard]] const std::array<std::uint8_t, kHashSize>& hash() const noexcept {
    return both_->current.hash;
  }

  /// Keys from initiator to responder and back; the state is wiped but for its hash.
  [[nodiscard]] std::array<SecretKey, 2> split();

 private:
  struct State : SymmetricState {
    std::array<std::uint8_t, crypto_scalarmult_BYTES> remote;  ///< the other side's public key
  };
  /// A message works on the trial, which becomes the current state when all of it is right.
  struct Both {
    State current, trial;
  };

  [[nodiscard]] bool mixTokens(Tokens tokens, ByteView sender) noexcept;
  void forgetTrial() noexcept;

  LockedBox<Both> both_;
  SecretKey ephemeral_;
};

/// The side that speaks first. Each function is for its turn and gives nothing out of turn.
class Initiator {
 public:
  /// `prologue`: what both sides must agree on beforehand. `ephemeral` is given by tests only.
  /// Throws std::invalid_argument if a key was moved away.
  Initiator(const SecretKey& shared, ByteView prologue,
            SecretKey ephemeral = SecretKey::generate());

  /// Writes message 1, once; to send it again keep the bytes. Gives its size; nothing if `message`
  /// is too small for `payload` and kHandshakeOverhead. They must not overlap.
  [[nodiscard]] std::optional<std::size_t> writeMessage(ByteView payload, Bytes message) noexcept;

  /// Reads message 2 and gives the size of its payload; nothing if it is refused or `payload` is
  /// too small. A refused message leaves `payload` as it was, or wiped.
  [[nodiscard]] std::optional<std::size_t> readMessage(ByteView message, Bytes payload) noexcept;

  /// Once message 2 was read, and once only; nothing else.
  [[nodiscard]] std::optional<TransportKeys> split();

  [[nodiscard]] bool isComplete() const noexcept { return turn_ == Turn::kComplete; }

  /// Hash of all that was said, the same at both sides when complete; not secret.
  [[nodiscard]] const std::array<std::uint8_t, kHashSize>& hash() const noexcept {
    return state_.hash();
  }

 private:
  enum class Turn { kWrite, kRead, kComplete, kSplit };

  HandshakeState state_;
  Turn turn_ = Turn::kWrite;
};

/// The side that answers; see Initiator. A refused message 1 costs no X25519, and the responder is
/// as new: one that was made beforehand may stand ready for whatever arrives.
class Responder {
 public:
  Responder(const SecretKey& shared, ByteView prologue,
            SecretKey ephemeral = SecretKey::generate());

  /// Reads message 1.
  [[nodiscard]] std::optional<std::size_t> readMessage(ByteView message, Bytes payload) noexcept;

  /// Writes message 2, once. Nothing also if message 1 brought a point of low order.
  [[nodiscard]] std::optional<std::size_t> writeMessage(ByteView payload, Bytes message) noexcept;

  /// Once message 2 was written, and once only. That the initiator has the keys, too, is known when
  /// the first datagram opens under `receive`.
  [[nodiscard]] std::optional<TransportKeys> split();

  [[nodiscard]] bool isComplete() const noexcept { return turn_ == Turn::kComplete; }
  [[nodiscard]] const std::array<std::uint8_t, kHashSize>& hash() const noexcept {
    return state_.hash();
  }

 private:
  enum class Turn { kRead, kWrite, kComplete, kSplit };

  HandshakeState state_;
  Turn turn_ = Turn::kRead;
};

}  // namespace tandem::secure
