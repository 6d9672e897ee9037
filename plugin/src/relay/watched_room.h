#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "tandem/plugin/watcher.h"

#include "relay/relay_wire.h"
#include "relay/watch_wire.h"

namespace tandem::relay {

/// A spectator's knowledge of the sites of a room. The newest run of a site and its newest datagram
/// win; all others are refused. Real-time safe after construction.
class WatchedRoom {
 public:
  enum class Result { kTaken, kForm, kSender, kOld, kForged, kGate };
  static constexpr std::size_t kResults = 6;

  /// Takes 2.5 MB. Throws std::bad_alloc.
  explicit WatchedRoom(SecretKey watch_key) : key_(std::move(watch_key)), sites_(kMostMembers) {}

  /// Takes what a member said, by the relay's word; changes the bytes.
  Result take(std::uint16_t member, ByteSpan datagram, double now) noexcept;

  /// Null for one that was not heard.
  [[nodiscard]] const WatchedSite* site(PeerId id) const noexcept;
  [[nodiscard]] const ObjectState* object(PeerId site, ObjectId id) const noexcept;
  [[nodiscard]] std::uint64_t count(Result result) const noexcept {
    return counts_[static_cast<std::size_t>(result)];
  }

 private:
  struct Heard {
    WatchedSite site;  ///< `states` is 0 before the first one
    WatchRun run;
    std::uint64_t next_sequence = 0;
    std::array<ObjectState, kMaxSharedObjects> objects;
    std::bitset<kMaxSharedObjects> has;
  };

  [[nodiscard]] Result open(std::uint16_t member, ByteSpan datagram, double now) noexcept;
  [[nodiscard]] const Heard* find(PeerId site) const noexcept;

  SecretKey key_;
  std::vector<Heard> sites_;  ///< by id - 1
  std::array<std::uint64_t, kResults> counts_{};
};

}  // namespace tandem::relay
