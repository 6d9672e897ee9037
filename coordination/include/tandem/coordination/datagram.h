#pragma once

#include <cstddef>
#include <cstdint>

/// \file
/// Wire types that users of the network need; sections refer to coordination/STANDARD.md.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kMaxDatagramSize = 1200;  ///< [bytes], with tag

/// Read-only bytes; their owner must outlive the view.
struct ByteView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Writable bytes; their owner must outlive the view.
struct ByteSpan {
  std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Width of the real numbers in wire records.
enum class WireProfile : std::uint8_t { kFloat32, kFloat64 };

/// Reason why a peer refuses a handshake (section 4).
enum class RefuseCode : std::uint8_t {
  kVersion = 1,
  kUnknownPeer = 2,
  kCookie = 3,
  kKey = 4,
  kBusy = 5,
};

/// Reason why the sender leaves (section 9).
enum class ByeReason : std::uint8_t { kUserLeaves, kProgramEnds, kFault, kConfigurationsDiffer };

}  // namespace tandem
#pragma GCC visibility pop
