#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/plugin/secret_key.h"

#include "coordination/src/wire/wire_state.h"

/// \file
/// WATCH, the datagram of a player to all spectators of a room; docs/relay.md defines the format.
/// All functions check every byte, and neither throw nor allocate unless they say so.
namespace tandem::relay {

inline constexpr std::size_t kWatchHeader = 32;  ///< clear, before the sealed STATE payload [bytes]
inline constexpr std::size_t kWatchTag = 16;     ///< [bytes]
inline constexpr std::size_t kMaxWatch = kWatchHeader + kMaxStateSize + kWatchTag;

/// One run of a player's program.
struct WatchRun {
  std::uint64_t begun = 0;   ///< above those of all earlier runs: drawFirstNonce()
  std::uint64_t random = 0;  ///< no two runs have one key, whatever the clock says
};

/// A WATCH says this in the clear.
struct WatchHeader {
  std::uint16_t sender = 0;
  WatchRun run;
  std::uint64_t sequence = 0;  ///< from 0 in each run
};

void encodeWatchHeader(const WatchHeader& header, ByteSpan out) noexcept;
/// Empty if the bytes are no WATCH by form.
[[nodiscard]] std::optional<WatchHeader> decodeWatchHeader(ByteView datagram) noexcept;

/// The key of a run: BLAKE2b-256 under the watch key. `out` has SecretKey::kSize bytes.
void deriveRunKey(const SecretKey& watch_key, std::uint16_t sender, const WatchRun& run,
                  std::uint8_t* out) noexcept;
/// The same in memory of its own. Allocates.
[[nodiscard]] SecretKey makeRunKey(const SecretKey& watch_key, std::uint16_t sender,
                                   const WatchRun& run);

/// Opens a WATCH with this header in place. Returns the payload of STATE; empty if a byte is wrong.
[[nodiscard]] std::optional<ByteView> openWatch(const SecretKey& watch_key,
                                                const WatchHeader& header,
                                                ByteSpan datagram) noexcept;

}  // namespace tandem::relay
