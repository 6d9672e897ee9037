#pragma once

#include <algorithm>
#include <optional>

#include "coordination/src/wire/replay_window.h"
#include "coordination/src/wire/wire.h"
#include "coordination/src/wire/wire_sealing.h"
#include "net/refusal.h"
#include "secure/handshake.h"
#include "secure/rekey_policy.h"
#include "secure/seal.h"

namespace tandem::net {

/// This site and one peer.
struct Pair {
  PeerId self{}, peer{};
  /// The site with the lower id starts the handshake.
  [[nodiscard]] bool isInitiator() const noexcept { return self < peer; }
};

/// Result of one handshake: a key for each direction, both sides' session numbers, and the window
/// of received datagrams. Real-time safe except for construction.
class SessionKeys {
 public:
  /// `theirs` are the peer's terms.
  SessionKeys(const Pair& pair, secure::TransportKeys keys, std::uint32_t mine,
              const SessionTerms& theirs, double now) noexcept
      : pair_(pair),
        sealer_(std::move(keys.send), computeNonceSalt(pair.self, theirs.key_epoch)),
        opener_(std::move(keys.receive), computeNonceSalt(pair.peer, theirs.key_epoch)),
        policy_(now),
        mine_(mine),
        theirs_(theirs.session),
        epoch_(theirs.key_epoch),
        minor_(std::min(theirs.minor, kMinorVersion)) {}

  [[nodiscard]] bool isFor(const ClearHeader& header) const noexcept {
    return header.session == mine_ && header.key_epoch == epoch_ && header.sender == pair_.peer;
  }
  [[nodiscard]] std::uint16_t epoch() const noexcept { return epoch_; }
  /// Highest minor version that both speak.
  [[nodiscard]] std::uint8_t minor() const noexcept { return minor_; }
  [[nodiscard]] secure::KeyAge age(double now) const noexcept {
    return policy_.age(now, sealer_.nextSequence());
  }

  /// Writes header and tag around the payload at `datagram.data + kHeaderSize`. Returns the whole
  /// size, 0 if the key is used up or there is no room.
  [[nodiscard]] std::size_t seal(MessageType type, std::size_t payload_size,
                                 ByteSpan datagram) noexcept;

  /// Opens a datagram of this session in place; each datagram only once.
  [[nodiscard]] Refusal open(const ClearHeader& header, ByteSpan datagram, double now) noexcept;

 private:
  Pair pair_;
  secure::Sealer sealer_;
  secure::Opener opener_;
  secure::RekeyPolicy policy_;
  ReplayWindow window_;
  std::uint32_t mine_, theirs_;
  std::uint16_t epoch_;
  std::uint8_t minor_;
};

}  // namespace tandem::net
