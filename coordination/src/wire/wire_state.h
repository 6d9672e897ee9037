#pragma once

#include <cstddef>
#include <cstdint>

#include "tandem/coordination/link.h"

#include "wire/wire.h"

/// \file
/// STATE (section 6): a state packet with its times, acknowledgements and energy.
#pragma GCC visibility push(default)
namespace tandem {

/// Bits of StateMessage::flags.
enum StateFlag : std::uint16_t {
  kStateIdle = 1,     ///< nothing moves at the sender, which sends at its keep-alive rate
  kStateLeaving = 2,  ///< the sender's user is about to leave
  kStateFading = 4,   ///< the sender fades, or has faded, its coupling to the receiver
  kStateAccount = 8,  ///< the sender keeps an account of energy: `energy` is valid
  kStateGrip = 16,    ///< a record of the user's grip follows the device: `packet.grip` is there
  kStateRoll = 32,    ///< a record of who takes part follows that: `packet.roll` is there
};

inline constexpr std::uint16_t kStateFlags =
    kStateIdle | kStateLeaving | kStateFading | kStateAccount | kStateGrip | kStateRoll;

/// Peers of these minor versions and later understand kStateGrip and kStateRoll.
inline constexpr std::uint8_t kGripMinor = 1, kRollMinor = 2;

/// Contents of one STATE. `packet.time` and `packet.grip->age` travel in whole microseconds, an age
/// of more than 4294.967295 s as that. `packet.roll->age` travels in whole milliseconds, rounded
/// down, up to 49 days.
struct StateMessage {
  StatePacket packet;
  std::int64_t send_time_us = 0;       ///< sender's monotonic clock when the datagram leaves
  std::int64_t echo_send_time_us = 0;  ///< send time of the receiver's newest STATE; 0: none yet
  std::uint32_t echo_hold_us = 0;      ///< time from that one's arrival to `send_time_us`
  std::uint32_t ack_bits = 0;          ///< bit i: the datagram 1 + i before that one arrived
  EnergyReport energy;                 ///< to the receiver
  std::uint16_t flags = 0;             ///< bits of StateFlag
  WireProfile profile = WireProfile::kFloat64;
  std::uint32_t config_hash = 0;  ///< hash of the sender's configuration
};

/// Inclusive bounds of sent and received values, per component. The defaults are the standard's; a
/// site may narrow them for what it receives.
struct WireLimits {
  double position = 1e3;          ///< [m]
  double velocity = 1e2;          ///< [m/s]
  double angular_velocity = 1e3;  ///< [rad/s]
  double energy = 1e9;            ///< [J]
};

inline constexpr std::size_t kStateBlockSize = 64;  ///< before the records [bytes]

/// Size of a payload [bytes].
[[nodiscard]] constexpr std::size_t computeStateSize(WireProfile profile, std::size_t object_count,
                                                     bool has_grip = false,
                                                     bool has_roll = false) noexcept {
  const std::size_t real = profile == WireProfile::kFloat32 ? 4 : 8;
  return kStateBlockSize + 6 * real + (has_grip ? 8 + 7 * real : 0) + (has_roll ? 20 : 0) +
         object_count * (8 + 13 * real);
}

inline constexpr std::size_t kMaxStateSize =
    computeStateSize(WireProfile::kFloat64, kMaxObjectsPerPacket, true, true);

/// Seconds as whole microseconds, rounded; negative if not finite or outside 0 to 2^50 us.
[[nodiscard]] std::int64_t toMicroseconds(double seconds) noexcept;

/// The flags of the records that a packet has.
[[nodiscard]] inline std::uint16_t flagRecords(const StatePacket& packet) noexcept {
  return static_cast<std::uint16_t>((packet.grip ? kStateGrip : 0) |
                                    (packet.roll ? kStateRoll : 0));
}

/// Writes the payload and returns its size; 0 if there is no room, the flags do not say which
/// records there are, or a receiver with these limits would refuse it. Non-finite and out-of-bounds
/// values, and quaternions not unit within 1e-6, are never sent. The header carries
/// `packet.sender`.
[[nodiscard]] std::size_t encodeState(const StateMessage& message, ByteSpan out,
                                      const WireLimits& limits = {}) noexcept;

/// Reads an opened payload; `sender` comes from the header. The result passes isSane() and the
/// checks of section 6; orientations have unit length.
[[nodiscard]] Decoded<StateMessage> decodeState(ByteView payload, PeerId sender,
                                                const WireLimits& limits = {}) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
