#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tandem/coordination/configuration.h"

#include "wire/wire.h"

/// \file
/// AGREE and AGREE_ACK (section 8): configurations in parts, and their answers. For set-up only:
/// these functions allocate.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kMaxAgreeParts = 32;

/// AGREE: one part of the sender's configuration.
struct AgreePart {
  std::uint32_t config_hash = 0;  ///< hash of the whole configuration
  std::uint8_t part = 0;
  std::uint8_t parts = 1;
  Configuration items;
};

enum class AgreeVerdict : std::uint8_t { kIncomplete, kEqual, kDifferent };

/// AGREE_ACK: the answer to a configuration.
struct AgreeAnswer {
  std::uint32_t config_hash = 0;     ///< hash of the configuration answered
  std::uint32_t parts_received = 0;  ///< bit i: part i has arrived
  AgreeVerdict verdict = AgreeVerdict::kIncomplete;
  std::string key;    ///< key of the first item that differs; else empty
  std::string value;  ///< the answering side's value of it; empty: none
};

/// Splits a configuration into at least one part. Throws std::invalid_argument if it needs more
/// than 32.
[[nodiscard]] std::vector<AgreePart> makeAgreeParts(const Configuration& configuration);

/// Collects the parts of one configuration of a peer, in any order.
class AgreeCollector {
 public:
  /// Adds a part. A part of another configuration restarts the collection. False if the part has an
  /// invalid number, or another count of parts than the rest.
  bool add(const AgreePart& part);

  [[nodiscard]] std::uint32_t partsReceived() const noexcept { return received_; }
  [[nodiscard]] bool complete() const noexcept;
  /// The items that arrived so far.
  [[nodiscard]] Configuration items() const;

  /// Compares the items so far with the configuration here and answers the peer. If all parts
  /// arrived but do not match their hash, they are dropped.
  [[nodiscard]] AgreeAnswer answer(const Configuration& here);

 private:
  std::uint32_t config_hash_ = 0;
  std::uint32_t received_ = 0;
  std::vector<Configuration> parts_;
};

/// Payloads. Encoders return the size; 0 if there is no room or a receiver would refuse it.
[[nodiscard]] std::size_t encodeAgree(const AgreePart& part, ByteSpan out);
[[nodiscard]] Decoded<AgreePart> decodeAgree(ByteView payload);
[[nodiscard]] std::size_t encodeAgreeAck(const AgreeAnswer& answer, ByteSpan out);
[[nodiscard]] Decoded<AgreeAnswer> decodeAgreeAck(ByteView payload);

}  // namespace tandem
#pragma GCC visibility pop
