#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Shared objects in one packet: with eight the longest datagram has 1004 bytes, below one MTU.
inline constexpr int kMaxObjectsPerPacket = 8;

/// Shared objects of a site. Where there are more than fit one packet, they take turns.
inline constexpr int kMaxSharedObjects = 256;

/// Time between the packets of a sender that says it is idle [s].
inline constexpr double kIdlePacketPeriod = 1.0 / 16.0;

/// One shared object's copy at the sender.
struct ObjectState {
  ObjectId id = 0;
  RigidState state;
};

/// What a peer tells the others `network.rate` times a second: kinematic state, never forces. Every
/// receiver computes its own forces from its own gains. Latest wins, for the user and for each
/// object by itself; nothing is sent again. A peer with more objects than fit sends those first
/// that have moved since they were sent last, and the others in turn.
struct StatePacket {
  PeerId sender{};
  std::uint64_t sequence = 0;         ///< counts the sender's packets from 0
  double time = 0.0;                  ///< sender's time of the state below [s]
  PointState user;                    ///< the sender's haptic interface point
  bool is_idle = false;               ///< nothing moves there: packets come at kIdlePacketPeriod
  std::optional<double> port_energy;  ///< that the sender's side has put in so far [J], see
                                      ///< PassivityObserver; nothing: it keeps no account
  std::uint32_t object_count = 0;
  std::array<ObjectState, kMaxObjectsPerPacket> objects;
};

/// False if anything in the packet is not finite, a quaternion is not of unit length within 1e-6,
/// or there are more objects than fit. Entries from `object_count` on are no part of the packet.
/// Bytes from the network are never trusted: a receiver drops and counts such a packet.
[[nodiscard]] bool isSane(const StatePacket& packet) noexcept;

/// A packet and the moment at which it came in.
struct Arrival {
  StatePacket packet;
  double time = 0.0;  ///< receiver's time [s]
};

/// One end of the way to one other peer. Unreliable and unordered, as UDP is.
///
/// All functions are called from the thread that ticks the site, never block and never allocate.
class Link {
 public:
  virtual ~Link() = default;

  /// Sends one packet whose state belongs to time `now` [s].
  virtual void send(const StatePacket& packet, double now) noexcept = 0;

  /// The next packet, in order of arrival, that has come in before `until` [s] and was on its way
  /// before `from` [s]; nothing if there is none. A tick asks for [from, until) = its own period.
  ///
  /// A simulated link knows the future of the period and gives arrivals inside it, so that virtual
  /// time takes them in at their exact moment; a live link gives what is there and stamps it
  /// `from`.
  [[nodiscard]] virtual std::optional<Arrival> receive(double from, double until) noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
