#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tandem/coordination/configuration.h"

#include "wire/wire.h"

/// \file
/// AGREE and AGREE_ACK (section 8): configurations in parts, and the answers. For set-up: these
/// functions allocate.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kMaxAgreeParts = 32;

/// One AGREE: a part of the sender's configuration.
struct AgreePart {
  std::uint32_t config_hash = 0;  ///< of the whole configuration
  std::uint8_t part = 0;
  std::uint8_t parts = 1;
  Configuration items;
};

enum class AgreeVerdict : std::uint8_t { kIncomplete, kEqual, kDifferent };

/// One AGREE_ACK.
struct AgreeAnswer {
  std::uint32_t config_hash = 0;     ///< of the configuration that is answered
  std::uint32_t parts_received = 0;  ///< bit i: part i is here
  AgreeVerdict verdict = AgreeVerdict::kIncomplete;
  std::string key;    ///< of the first item that is different; else empty
  std::string value;  ///< the answering side's value of it; empty: it has none
};

/// The parts that carry a configuration, at least one. Throws std::invalid_argument if it takes
/// more than 32 of them.
[[nodiscard]] std::vector<AgreePart> makeAgreeParts(const Configuration& configuration);

/// Collects the parts of one configuration of a peer, in whatever order they come in.
class AgreeCollector {
 public:
  /// Takes a part in. A part of another configuration than before begins anew. False if `parts` is
  /// not that of the others.
  bool add(const AgreePart& part);

  [[nodiscard]] std::uint32_t partsReceived() const noexcept { return received_; }
  [[nodiscard]] bool complete() const noexcept;
  /// What came in so far.
  [[nodiscard]] Configuration items() const;

  /// The answer to the peer, with what came in so far compared with the configuration here. Parts
  /// that do not make the hash which they carry are no configuration: all are forgotten.
  [[nodiscard]] AgreeAnswer answer(const Configuration& here);

 private:
  std::uint32_t config_hash_ = 0;
  std::uint32_t received_ = 0;
  std::vector<Configuration> parts_;
};

/// Payloads. An encoder gives the size; 0 if there is no room or a receiver would refuse it.
[[nodiscard]] std::size_t encodeAgree(const AgreePart& part, ByteSpan out);
[[nodiscard]] Decoded<AgreePart> decodeAgree(ByteView payload);
[[nodiscard]] std::size_t encodeAgreeAck(const AgreeAnswer& answer, ByteSpan out);
[[nodiscard]] Decoded<AgreeAnswer> decodeAgreeAck(ByteView payload);

}  // namespace tandem
#pragma GCC visibility pop
