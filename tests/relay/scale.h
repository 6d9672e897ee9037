#pragma once

#include <cstddef>

#include "coordination/src/wire/wire.h"
#include "coordination/src/wire/wire_state.h"
#include "relay/relay_wire.h"

namespace tandem::test {

/// What sessions cost on paper: rooms of `users`, of whom each tells each other its state `rate`
/// times a second, with one object, in the narrow profile. Bytes are with headers of IPv4 and UDP.
struct RoomsOnPaper {
  double rooms = 1.0, users = 2.0, rate = 128.0;

  static constexpr double kIpAndUdp = 28.0;
  static constexpr double kInner =
      static_cast<double>(kHeaderSize + kTagSize + computeStateSize(WireProfile::kFloat32, 1));
  static constexpr double kDirect = kIpAndUdp + kInner;
  static constexpr double kUp =
      kDirect + static_cast<double>(relay::kForwardHeader + relay::kShortTag);
  static constexpr double kDown = kDirect + static_cast<double>(relay::kForwardHeader);

  /// States that a user sends, and gets, a second.
  [[nodiscard]] double statesOfUser() const { return (users - 1.0) * rate; }
  /// Datagrams that relays forward a second, of all rooms.
  [[nodiscard]] double forwarded() const { return rooms * users * statesOfUser(); }
  /// [bit/s]
  [[nodiscard]] double directOfUser() const { return 8.0 * statesOfUser() * kDirect; }
  [[nodiscard]] double upOfUser() const { return 8.0 * statesOfUser() * kUp; }
  [[nodiscard]] double downOfUser() const { return 8.0 * statesOfUser() * kDown; }
  [[nodiscard]] double ofRelays() const { return rooms * users * (upOfUser() + downOfUser()); }
};

}  // namespace tandem::test
