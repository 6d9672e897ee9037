#pragma once

#include <cstddef>
#include <cstdint>

/// \file
/// Words of the wire that users of the network need; sections are those of coordination/STANDARD.md.
#pragma GCC visibility push(default)
namespace tandem {

inline constexpr std::size_t kMaxDatagramSize = 1200;  ///< [bytes], with tag

/// Bytes to read; whoever owns them must outlive the view.
struct ByteView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Room to write to.
struct ByteSpan {
  std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// How wide the reals of the records are on the wire.
enum class WireProfile : std::uint8_t { kFloat32, kFloat64 };

/// Why a peer refuses a handshake (section 4).
enum class RefuseCode : std::uint8_t {
  kVersion = 1,
  kUnknownPeer = 2,
  kCookie = 3,
  kKey = 4,
  kBusy = 5,
};

/// Why the sender leaves (section 9).
enum class ByeReason : std::uint8_t { kUserLeaves, kProgramEnds, kFault, kConfigurationsDiffer };

}  // namespace tandem
#pragma GCC visibility pop
