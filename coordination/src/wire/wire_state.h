#pragma once

#include <cstddef>
#include <cstdint>

#include "tandem/coordination/link.h"

#include "wire/wire.h"

/// \file
/// STATE (section 6): a state packet with the times, acknowledgements and energy that go with it.
#pragma GCC visibility push(default)
namespace tandem {

/// Bits of StateMessage::flags.
enum StateFlag : std::uint16_t {
  kStateIdle = 1,     ///< nothing moves at the sender, which now sends at its keep-alive rate
  kStateLeaving = 2,  ///< the sender's user is about to leave
  kStateFading = 4,   ///< the sender has faded, or is fading, its coupling to the receiver
  kStateAccount = 8,  ///< the sender keeps an account of energy: `port_energy` means something
};

inline constexpr std::uint16_t kStateFlags =
    kStateIdle | kStateLeaving | kStateFading | kStateAccount;

/// What one STATE says. `packet.time` travels in whole microseconds.
struct StateMessage {
  StatePacket packet;
  std::int64_t send_time_us = 0;       ///< sender's monotonic clock as the datagram leaves
  std::int64_t echo_send_time_us = 0;  ///< of the newest STATE from the receiver; 0: none yet
  std::uint32_t echo_hold_us = 0;      ///< how long before `send_time_us` that one came in
  std::uint32_t ack_bits = 0;          ///< bit i: the datagram 1 + i before that one came in
  double port_energy = 0.0;            ///< put into the connection by the sender's side so far [J]
  std::uint16_t flags = 0;             ///< of StateFlag
  WireProfile profile = WireProfile::kFloat64;
  std::uint32_t config_hash = 0;  ///< of the sender's configuration
};

/// Bounds on what is taken and sent, inclusive, for each component. The defaults are the
/// standard's; a site may set narrower ones for what it takes.
struct WireLimits {
  double position = 1e3;          ///< [m]
  double velocity = 1e2;          ///< [m/s]
  double angular_velocity = 1e3;  ///< [rad/s]
  double energy = 1e9;            ///< [J]
};

inline constexpr std::size_t kStateBlockSize = 56;  ///< [bytes] before the records

/// Size of a payload [bytes].
[[nodiscard]] constexpr std::size_t computeStateSize(WireProfile profile,
                                                     std::size_t object_count) noexcept {
  const std::size_t real = profile == WireProfile::kFloat32 ? 4 : 8;
  return kStateBlockSize + 6 * real + object_count * (4 + 13 * real);
}

inline constexpr std::size_t kMaxStateSize =
    computeStateSize(WireProfile::kFloat64, kMaxObjectsPerPacket);

/// Seconds in whole microseconds, rounded; negative if they are not finite or outside 0 to 2^50 us.
[[nodiscard]] std::int64_t toMicroseconds(double seconds) noexcept;

/// Writes the payload and gives its size; 0 if there is no room or a receiver with these limits
/// would refuse it: what is not finite, out of bounds, or not a unit quaternion within 1e-6 never
/// leaves. `packet.sender` is no part of it, but of the header.
[[nodiscard]] std::size_t encodeState(const StateMessage& message, ByteSpan out,
                                      const WireLimits& limits = {}) noexcept;

/// Reads an opened payload; `sender` is the header's. What comes out passes isSane(): the gate of
/// section 6 is closed before anything is used, and orientations have unit length.
[[nodiscard]] Decoded<StateMessage> decodeState(ByteView payload, PeerId sender,
                                                const WireLimits& limits = {}) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
