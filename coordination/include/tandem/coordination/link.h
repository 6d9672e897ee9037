#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tandem/coordination/site_set.h"
#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Shared objects in one packet. With eight, the longest datagram has 1128 bytes, below one MTU.
inline constexpr int kMaxObjectsPerPacket = 8;

/// Shared objects of a site. If they exceed one packet, they take turns.
inline constexpr int kMaxSharedObjects = 256;

/// Packet period of a sender that reports itself idle [s].
inline constexpr double kIdlePacketPeriod = 1.0 / 16.0;

/// Names the time since an object was last put elsewhere: by a teleport, a reset, a restored state.
/// Copies of different epochs do not pull at each other.
struct ObjectEpoch {
  std::uint32_t count = 0;  ///< 0: never put elsewhere; then the author is 0
  PeerId author{};          ///< site that began it

  [[nodiscard]] friend bool operator==(const ObjectEpoch& a, const ObjectEpoch& b) noexcept {
    return a.count == b.count && a.author == b.author;
  }
  [[nodiscard]] friend bool operator!=(const ObjectEpoch& a, const ObjectEpoch& b) noexcept {
    return !(a == b);
  }
};

/// True if `a` replaces `b`. Sites that begin epochs at the same time agree: of equal counts the
/// higher author wins. Counts wrap. Pure; real-time safe.
[[nodiscard]] inline bool isNewer(const ObjectEpoch& a, const ObjectEpoch& b) noexcept {
  if (a.count == b.count) return a.author > b.author;
  if (a.count == 0 || b.count == 0) return b.count == 0;
  return a.count - b.count < 0x80000000u;
}

/// The epoch that `author` begins when `newest` is the newest that it knows. Pure; real-time safe.
[[nodiscard]] inline ObjectEpoch beginEpoch(const ObjectEpoch& newest, PeerId author) noexcept {
  const std::uint32_t next = newest.count + 1;
  return {next == 0 ? 1 : next, author};
}

/// One shared object's copy at the sender.
struct ObjectState {
  ObjectId id = 0;
  RigidState state;
  ObjectEpoch epoch = {};  ///< of this copy
};

/// The sender's part of the energy ledger with the receiver (EnergyLedger). Both may be negative.
struct EnergyReport {
  double granted = 0.0;   ///< energy that the sender granted to the receiver so far [J]
  double holdings = 0.0;  ///< energy that the sender's hand may still get, without what the
                          ///< receiver granted to it [J]
};

/// An object that the sender's user holds in a grip. It is told as state in every packet, so a lost
/// packet loses no grab and no release.
struct GripState {
  std::uint16_t epoch = 0;         ///< counts grabs and releases, modulo 2^16
  std::optional<ObjectId> object;  ///< empty: the hand holds nothing, and the rest means nothing
  Vec3 p_BG = Vec3::Zero();        ///< place on the object, from its centre of mass, in B [m]
  Quat q_BG = Quat::Identity();    ///< of W in B, once the object is turned as the hand wants it
  double age = 0.0;                ///< time from the last grab or release to the packet's [s]
};

/// State that a peer sends to the others `network.rate` times a second: kinematics, never forces.
/// Each receiver computes its own forces with its own gains. The latest state wins, separately for
/// the user and each object; nothing is sent again. If the objects exceed one packet, those that
/// the receiver needs most go first, and the others take turns.
struct StatePacket {
  PeerId sender{};
  std::uint64_t sequence = 0;  ///< counts the sender's packets from 0
  double time = 0.0;           ///< sender's time of the state below [s]
  PointState user;             ///< the sender's haptic interface point
  /// Packets come at kIdlePacketPeriod: nothing moves at the sender, or nothing near the receiver.
  bool is_idle = false;
  std::optional<EnergyReport> energy;  ///< empty: the sender keeps no account
  std::optional<GripState> grip;       ///< empty: the user has held nothing yet
  std::optional<RollCall> roll;        ///< empty: the number of sites is fixed
  std::uint32_t object_count = 0;
  std::array<ObjectState, kMaxObjectsPerPacket> objects;
};

/// False if a value is not finite, a quaternion is not unit within 1e-6, an age is below 0, or
/// there are more objects than fit. Entries from `object_count` on are not part of the packet. A
/// receiver drops and counts a packet that is not sane.
[[nodiscard]] bool isSane(const StatePacket& packet) noexcept;

/// A packet and its time of arrival.
struct Arrival {
  StatePacket packet;
  double time = 0.0;  ///< receiver's time [s]
};

/// One end of a link to one other peer. Unreliable and unordered, like UDP.
///
/// All functions are called from the thread that ticks the site, never block and never allocate.
class Link {
 public:
  virtual ~Link() = default;

  /// Sends one packet whose state belongs to time `now` [s].
  virtual void send(const StatePacket& packet, double now) noexcept = 0;

  /// The next packet, in order of arrival, that arrives before `until` [s] and was sent before
  /// `from` [s]; nothing if there is none. A tick asks for [from, until) = its own period.
  ///
  /// A simulated link knows the future of the period and gives arrivals inside it. Virtual time
  /// therefore applies them at their exact moment. A live link gives the packets it holds, stamped
  /// `from`.
  [[nodiscard]] virtual std::optional<Arrival> receive(double from, double until) noexcept = 0;

  /// True once the peer has said farewell, until it comes again.
  [[nodiscard]] virtual bool hasLeft() const noexcept { return false; }
};

}  // namespace tandem
#pragma GCC visibility pop
