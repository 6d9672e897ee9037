#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tandem/plugin/udp_mesh.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A longer countdown to a start is refused, whatever a site allows [s] (STANDARD.md, section 6).
inline constexpr double kLongestCountdown = 60.0;

/// A countdown that is not followed.
struct RefusedCountdown {
  PeerId peer{};        ///< site that counts down
  double length = 0.0;  ///< [s]
};

/// The remote sites of a live site: one UDP socket, its thread, and a link in the site's own time
/// for each of them.
///
///   tandem::LivePeers peers(settings, {{tandem::PeerId{2}, address, key}});
///   site.connect(tandem::PeerId{2}, peers.link(tandem::PeerId{2}), start_W);
///   peers.startThread();            // from here on it has the socket
///   tandem::HapticLoop loop(site);
///   ...                             // the host steps its world
///   loop.stop();
///   peers.sayFarewell();
///
/// The connection goes by a clock, a site by its own time. They are matched in one of three ways:
/// by default the site's ticks show its time, a little late; poll() may be told it exactly; or all
/// sites agree on a moment at which their time is 0: agreeOnStart().
///
/// | thread                          | may call                                                  |
/// |---------------------------------|-----------------------------------------------------------|
/// | the site's, with a loop its own | functions of the links: no lock, no allocation            |
/// | its own, or else the caller's   | poll(), wait()                                            |
/// | any one other                   | all besides; status() and start() wait for a poll at most |
class LivePeers {
 public:
  /// The countdown ends so long before an agreed start: time to make the threads [s].
  static constexpr double kGetReady = 0.05;

  /// Throws as UdpMesh does.
  LivePeers(const UdpMeshSettings& settings, std::vector<UdpPeer> peers,
            std::optional<RelayAccess> relay = std::nullopt);
  /// Stops the thread as stopThread() does. Says no farewell.
  ~LivePeers();
  LivePeers(const LivePeers&) = delete;
  LivePeers& operator=(const LivePeers&) = delete;

  /// The way to a peer, for Site::connect(); lives as long as this. Throws std::invalid_argument
  /// for an id that is no peer.
  [[nodiscard]] Link& link(PeerId peer);

  // --- With a thread of its own

  /// Starts a thread that polls 4000 times a second by readMonotonicClock(). A state waits for it
  /// 0.25 ms at most. `priority`: SCHED_FIFO, below that of the HapticLoop, if the system grants
  /// it; 0: as the process has it. Throws std::invalid_argument for a priority out of range or if
  /// the thread runs, tandem::Error if there is no thread to be had.
  void startThread(int priority = 0);
  /// After all loops of connected sites have stopped.
  void stopThread() noexcept;

  // --- Without one: the caller polls

  /// Takes in what is there and says what is due. Before each tick or host step; with a HapticLoop
  /// about 1000 times a second. `now` [s] is a clock that does not run back. Never blocks.
  void poll(double now) noexcept;
  /// The same by a host whose step begins now, at `site_time` [s]. The ticks of a step run in one
  /// go; their states are stamped as if the host ran in real time.
  void poll(double now, double site_time) noexcept;
  /// Waits until something comes in or so many seconds have passed.
  void wait(double seconds) const noexcept;
  /// From here on a HapticLoop ticks the site of this peer, or none does any more. Not needed with
  /// startThread(). Throws std::invalid_argument for an id that is no peer.
  void setHapticThread(PeerId peer, bool has_one);

  // --- Start

  /// From here on polls look for a moment at which all sites begin, and tell the peers `rate` times
  /// a second [1/s] that the user holds the state `held`. All sites must do so. The one with the
  /// lowest number chooses, a second ahead at the least, once all peers are live. If the two ways
  /// of a pair differ, its sites start half the difference apart. Throws std::invalid_argument for
  /// a rate that is not above 0 and finite.
  ///
  /// A countdown of more than `longest` [s] is not followed: see refusedCountdown(). It must be
  /// above 0, and at most kLongestCountdown counts.
  void agreeOnStart(const PointState& held, double rate, double longest = kLongestCountdown);
  /// A countdown that was too long to be followed.
  [[nodiscard]] std::optional<RefusedCountdown> refusedCountdown() const noexcept;
  /// The clock at site time 0 [s], once it is known: HapticLoopSettings::begin.
  [[nodiscard]] std::optional<double> start() const noexcept;
  /// Sets it without asking: a site that joins others late. Throws std::invalid_argument for one
  /// that is not finite.
  void setStart(double start);

  // --- End

  /// Stops the thread, tells all peers, and waits until they have been told: 0.15 s. For those who
  /// poll by readMonotonicClock(); others call leave() and poll on for 0.1 s.
  void sayFarewell(ByeReason reason = ByeReason::kUserLeaves) noexcept;
  void leave(double now, ByeReason reason = ByeReason::kUserLeaves) noexcept;

  // --- State

  /// Empty without a relay.
  [[nodiscard]] std::optional<RelayConnection> relay(double now) const;
  [[nodiscard]] PeerStatus status(PeerId peer, double now) const;
  /// States that found no room on the way to or from a haptic thread.
  [[nodiscard]] std::uint64_t lost() const noexcept;
  [[nodiscard]] std::uint64_t received() const noexcept;
  /// Reasons that occurred.
  [[nodiscard]] std::vector<RefusedDatagrams> refused() const;
  /// Address to which the socket is bound.
  [[nodiscard]] Address bound() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
