#pragma once

#include <cstddef>
#include <cstdint>

#include "tandem/coordination/datagram.h"
#include "tandem/coordination/types.h"

/// \file
/// Parts common to all datagrams: bytes, header, named refusals. Sections refer to
/// coordination/STANDARD.md, which defines the format. All functions of the wire are pure, check
/// every byte and never throw. They never allocate unless they say so. They may be called from any
/// thread and in the tick.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::uint8_t kWireVersion = 3;
inline constexpr std::size_t kHeaderSize = 20;  ///< [bytes]
inline constexpr std::size_t kTagSize = 16;     ///< tag behind a sealed payload [bytes]
inline constexpr std::size_t kMaxPayloadSize = kMaxDatagramSize - kHeaderSize - kTagSize;

/// Latest time on the wire [us], 35 years; a double in seconds still resolves each microsecond.
inline constexpr std::int64_t kMaxWireTimeUs = std::int64_t{1} << 50;

/// Reason why bytes are refused (section 10). A receiver drops them and counts each reason.
enum class WireRefusal : std::uint8_t {
  kNone,
  kTooShort,
  kTooLong,
  kWrongSize,
  kMagic,
  kVersion,
  kType,
  kSession,
  kSender,
  kKeyEpoch,
  kSequence,
  kReceiver,
  kRole,
  kZero,
  kCode,
  kTerms,
  kProfile,
  kObjectCount,
  kFlags,
  kTime,
  kEnergy,
  kObjectId,
  kObjectTwice,
  kObjectEpoch,
  kNotFinite,
  kPosition,
  kVelocity,
  kAngularVelocity,
  kOrientation,
  kPart,
  kParts,
  kKey,
  kValue,
  kOrder,
  kVerdict,
  kReason,
};

inline constexpr std::size_t kWireRefusals = static_cast<std::size_t>(WireRefusal::kReason) + 1;

/// The refusal's name in the standard, such as "too_short"; "none" for kNone.
[[nodiscard]] const char* name(WireRefusal refusal) noexcept;

/// A decoded value, or the reason why there is none. `*decoded` is valid only if `decoded`.
template <class T>
class Decoded {
 public:
  Decoded(WireRefusal refusal) noexcept : refusal_(refusal) {}  // NOLINT: `return kTooShort;`

  [[nodiscard]] explicit operator bool() const noexcept { return refusal_ == WireRefusal::kNone; }
  [[nodiscard]] WireRefusal refusal() const noexcept { return refusal_; }
  [[nodiscard]] const T& operator*() const noexcept { return value_; }
  [[nodiscard]] const T* operator->() const noexcept { return &value_; }
  [[nodiscard]] T& operator*() noexcept { return value_; }
  [[nodiscard]] T* operator->() noexcept { return &value_; }

  /// For decoders, which fill in the value first; kNone accepts it.
  void refuse(WireRefusal refusal) noexcept { refusal_ = refusal; }

 private:
  T value_{};
  WireRefusal refusal_;
};

enum class MessageType : std::uint8_t {
  kHello = 1,
  kCookie = 2,
  kOpen = 3,
  kAccept = 4,
  kRefuse = 5,
  kState = 16,
  kAgree = 17,
  kAgreeAck = 18,
  kBye = 19,
  kPathChallenge = 20,
  kPathResponse = 21,
};

/// True for types with a sealed payload, false for those of the handshake.
[[nodiscard]] constexpr bool isSealed(MessageType type) noexcept {
  return static_cast<std::uint8_t>(type) >= static_cast<std::uint8_t>(MessageType::kState);
}

/// The unencrypted header of every datagram (section 3).
struct ClearHeader {
  MessageType type = MessageType::kState;
  std::uint8_t version = kWireVersion;  ///< differs only in REFUSE
  std::uint32_t session = 0;            ///< chosen by the datagram's receiver; 0: none yet
  PeerId sender{};
  std::uint16_t key_epoch = 0;
  std::uint64_t sequence = 0;
};

/// Writes the header's kHeaderSize bytes and returns their number. Returns 0, with nothing written,
/// if there is no room or the header is outside the standard.
[[nodiscard]] std::size_t encodeHeader(const ClearHeader& header, ByteSpan out) noexcept;

/// Reads the header of a sealed or opened datagram. Checks steps 1 to 3 of section 5: the length
/// against 20 and 1200, magic, version, type, and the ranges of the other fields.
[[nodiscard]] Decoded<ClearHeader> decodeHeader(ByteView datagram) noexcept;

/// The bytes after the header, which the datagram must have.
[[nodiscard]] inline ByteView payloadOf(ByteView datagram) noexcept {
  return {datagram.data + kHeaderSize, datagram.size - kHeaderSize};
}

inline constexpr std::size_t kByeSize = 1;  ///< payload [bytes]

/// Writes the payload of BYE and returns its size; 0 if there is no room.
[[nodiscard]] std::size_t encodeBye(ByeReason reason, ByteSpan out) noexcept;
[[nodiscard]] Decoded<ByeReason> decodeBye(ByteView payload) noexcept;

/// Payload of PATH_CHALLENGE, which PATH_RESPONSE repeats.
using PathToken = std::uint64_t;
inline constexpr std::size_t kPathSize = 8;  ///< payload [bytes]

/// Writes the payload of either and returns its size; 0 if there is no room.
[[nodiscard]] std::size_t encodePath(PathToken token, ByteSpan out) noexcept;
[[nodiscard]] Decoded<PathToken> decodePath(ByteView payload) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
