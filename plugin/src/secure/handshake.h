#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "tandem/plugin/secret_key.h"

#include "secure/bytes.h"
#include "secure/locked_memory.h"
#include "secure/symmetric_state.h"

/// \file
/// The handshake Noise_NNpsk0_25519_ChaChaPoly_BLAKE2b (Noise specification, revision 34). Two
/// sites with the same key agree on two fresh keys. Forward secrecy: a key leaked later does not
/// reveal them.
///
///     initiator                                           responder
///     writeMessage --- e, sealed payload ---------------> readMessage
///     readMessage  <-- e, sealed payload under e·e ------ writeMessage
///     split                                               split
///
/// Construction and split() take locked memory and may throw std::bad_alloc: not real-time safe.
/// Functions that read network bytes do not throw. They refuse bytes of a wrong size, of another
/// key or prologue, and with a point of low order. A refusal changes nothing, so forged bytes
/// cannot end a running handshake.
namespace tandem::secure {

/// Size of a handshake message beyond its payload [bytes].
inline constexpr std::size_t kHandshakeOverhead = crypto_scalarmult_BYTES + kTagSize;

/// This side's keys, one for each direction.
struct TransportKeys {
  SecretKey send;
  SecretKey receive;
};

/// Common part of both sides: one ephemeral key pair, and a message in each direction.
class HandshakeState {
 public:
  /// Mixes in the prologue and the shared key. Does not keep the shared key.
  HandshakeState(const SecretKey& shared, ByteView prologue, SecretKey ephemeral);

  /// Tokens of a message: the sender's public key (`e`), and also the shared secret of both
  /// ephemeral keys (`ee`).
  enum class Tokens { kE, kEAndEe };

  [[nodiscard]] std::optional<std::size_t> write(Tokens tokens, ByteView payload,
                                                 Bytes message) noexcept;
  [[nodiscard]] std::optional<std::size_t> read(Tokens tokens, ByteView message,
                                                Bytes payload) noexcept;

  /// Wipes the ephemeral key once no later message needs it.
  void forgetEphemeral() noexcept;

  [[nodiscard]] const std::array<std::uint8_t, kHashSize>& hash() const noexcept {
    return both_->current.hash;
  }

  /// Returns the keys from initiator to responder and back. Wipes the state except its hash.
  [[nodiscard]] std::array<SecretKey, 2> split();

 private:
  struct State : SymmetricState {
    std::array<std::uint8_t, crypto_scalarmult_BYTES> remote;  ///< the other side's public key
  };
  /// A message works on the trial, which replaces the current state only if all of it is valid.
  struct Both {
    State current, trial;
  };

  [[nodiscard]] bool mixTokens(Tokens tokens, ByteView sender) noexcept;
  void forgetTrial() noexcept;

  LockedBox<Both> both_;
  SecretKey ephemeral_;
};

/// The side that sends first. A function called out of turn returns nothing.
class Initiator {
 public:
  /// `prologue` must be equal at both sides. Only tests give `ephemeral`. Throws
  /// std::invalid_argument if a key was moved away.
  Initiator(const SecretKey& shared, ByteView prologue,
            SecretKey ephemeral = SecretKey::generate());

  /// Writes message 1, once; keep the bytes to send it again. Returns its size, nothing if
  /// `message` has no room for `payload` and kHandshakeOverhead. The two must not overlap.
  [[nodiscard]] std::optional<std::size_t> writeMessage(ByteView payload, Bytes message) noexcept;

  /// Reads message 2 and returns the size of its payload. Returns nothing if it is refused or
  /// `payload` is too small; `payload` is then unchanged or wiped.
  [[nodiscard]] std::optional<std::size_t> readMessage(ByteView message, Bytes payload) noexcept;

  /// Returns the keys once, after message 2 was read; otherwise nothing.
  [[nodiscard]] std::optional<TransportKeys> split();

  [[nodiscard]] bool isComplete() const noexcept { return turn_ == Turn::kComplete; }

  /// Hash of the whole handshake, equal at both sides when complete; not secret.
  [[nodiscard]] const std::array<std::uint8_t, kHashSize>& hash() const noexcept {
    return state_.hash();
  }

 private:
  enum class Turn { kWrite, kRead, kComplete, kSplit };

  HandshakeState state_;
  Turn turn_ = Turn::kWrite;
};

/// The side that answers; see Initiator. A refused message 1 costs no X25519 operation and leaves
/// the responder as new. One made in advance can thus wait for any message.
class Responder {
 public:
  Responder(const SecretKey& shared, ByteView prologue,
            SecretKey ephemeral = SecretKey::generate());

  /// Reads message 1.
  [[nodiscard]] std::optional<std::size_t> readMessage(ByteView message, Bytes payload) noexcept;

  /// Writes message 2, once. Returns nothing also if message 1 had a point of low order.
  [[nodiscard]] std::optional<std::size_t> writeMessage(ByteView payload, Bytes message) noexcept;

  /// Returns the keys once, after message 2 was written. The initiator has its keys when the first
  /// datagram opens under `receive`.
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
