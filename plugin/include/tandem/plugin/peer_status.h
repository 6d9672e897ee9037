#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tandem/coordination/configuration.h"
#include "tandem/coordination/datagram.h"
#include "tandem/coordination/types.h"
#include "tandem/plugin/address.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Where the connection to a peer stands.
enum class PeerPhase {
  kCalling,    ///< no answer yet, or none for 5 s
  kAgreeing,   ///< there; configurations are being compared
  kDifferent,  ///< configurations differ: nothing is coupled
  kLive,       ///< states go both ways
  kLeft,       ///< the peer has said farewell
};

[[nodiscard]] const char* name(PeerPhase phase) noexcept;

/// Why a peer refuses, and what to do: "it has another key; give both sides the same key file".
[[nodiscard]] const char* explain(RefuseCode code) noexcept;

/// What a user may want to know of the connection to one peer.
struct PeerStatus {
  PeerId peer{};
  PeerPhase phase = PeerPhase::kCalling;
  std::optional<Address> address;  ///< where it was heard from last
  double silence = 0.0;            ///< since the last authentic datagram [s]
  double round_trip = 0.0;         ///< smoothed [s]
  double clock_offset = 0.0;       ///< peer's clock - own [s], if both ways take equally long
  double wait = 0.0;               ///< added by playout [s]
  double jitter = 0.0;             ///< that 99 % of the packets keep [s]
  double loss = 0.0;               ///< of the peer's packets, 0 to 1
  std::uint16_t key_epoch = 0;     ///< handshakes so far
  std::uint64_t states_sent = 0;
  std::uint64_t states_unsent = 0;    ///< outside what may be sent, such as beyond 1000 m
  std::uint64_t states_given = 0;     ///< to the site
  std::uint64_t states_stale = 0;     ///< overtaken: not given
  std::uint64_t states_too_late = 0;  ///< older than the rest by more than half a second
  std::optional<RefuseCode> refused;  ///< by the peer, or somebody who says so
  std::uint8_t refused_version = 0;   ///< that the refusing side speaks
  std::optional<ByeReason> left;      ///< why the peer has said farewell
  std::optional<ConfigurationDifference> difference;
};

}  // namespace tandem
#pragma GCC visibility pop
