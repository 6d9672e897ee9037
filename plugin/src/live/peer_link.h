#pragma once

#include <atomic>
#include <optional>

#include "tandem/coordination/link.h"
#include "tandem/plugin/link_queue.h"

#include "live/site_clock.h"

// clang-format off
// Two clocks meet here: the site goes by its own time, the connection by the clock of who polls it.
//
//   one thread          site <-----------------------------------> TimeBridge <--> connection
//   a haptic thread     site <--> LinkQueue <--- exchange() -----> TimeBridge <--> connection
// clang-format on

namespace tandem {

/// The connection to a peer, in the site's time. One thread.
///
/// Sites that agree on a start shift the times in their states by kBefore, so that a state of the
/// countdown has a time above 0. Time 0 says that its sender knows no start yet.
class TimeBridge final : public Link {
 public:
  static constexpr double kBefore = 1000.0;  ///< site time 0 in states of an agreed start [s]

  /// `way` goes by the clock and must outlive this.
  explicit TimeBridge(Link& way) noexcept : way_(way) {}

  /// The clock now: states are stamped with it.
  void setClock(double clock) noexcept;
  /// The site's time at that moment, as well as its thread can tell.
  void noteSiteTime(double time) noexcept;
  /// The same exactly, by a host whose step begins now. Its ticks run in one go, so states are
  /// stamped as if the host ran in real time from here on.
  void setSiteTime(double time) noexcept;
  [[nodiscard]] bool knowsSiteTime() const noexcept { return times_.isKnown(); }
  /// It was set and is not estimated.
  [[nodiscard]] bool isSiteTimeSet() const noexcept { return times_.isSet(); }
  [[nodiscard]] double siteTime() const noexcept { return times_.toSite(clock_); }

  /// From here on times are shifted, and nothing goes through until there is a start.
  void awaitStart() noexcept;
  /// The site's time is 0 when the clock shows `start`.
  void setStart(double start) noexcept { times_.set(start); }
  /// Tells the peer the state that the user holds until the start.
  void sendHeld(const PointState& user, PeerId self) noexcept;
  /// A start that a peer tells of, by the clock here.
  struct ToldStart {
    double start = 0.0;      ///< [s]
    double countdown = 0.0;  ///< from when its state was sent; below 0: the peer runs [s]
  };
  /// Drops what has come in; gives the first start that it tells of, if states take `delay` [s].
  [[nodiscard]] std::optional<ToldStart> listenForStart(double delay) noexcept;

  // Link, in the site's time.
  void send(const StatePacket& packet, double now) noexcept override;
  /// The first time after setClock() tells the site's time, too.
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;
  [[nodiscard]] bool hasLeft() const noexcept override { return way_.hasLeft(); }

 private:
  void sendNumbered(StatePacket packet, double stamp) noexcept;
  [[nodiscard]] bool isHeld(const StatePacket& packet) const noexcept {
    return shift_ > 0.0 && packet.time < shift_;
  }

  Link& way_;
  SiteClock times_;
  double clock_ = 0.0, clock_before_ = 0.0;  ///< now, and at the poll before [s]
  bool is_clock_new_ = false;
  bool stamps_by_site_time_ = false;
  double shift_ = 0.0;          ///< of times in states [s]
  std::uint64_t sequence_ = 0;  ///< a site that begins anew goes on with it
};

/// Link that a site is connected to. Another thread than that which polls may tick the site.
class PeerLink final : public Link {
 public:
  explicit PeerLink(Link& way) noexcept : bridge_(way) {}

  [[nodiscard]] TimeBridge& bridge() noexcept { return bridge_; }

  /// From here on another thread ticks the site, or none does any more.
  void setHapticThread(bool has_one) noexcept;

  /// For the thread that polls, after the clock was set: lets states through to and from the haptic
  /// thread, up to those that are due in `ahead` [s].
  void exchange(double ahead) noexcept;

  /// States that found no room on the way to or from the haptic thread.
  [[nodiscard]] std::uint64_t lost() const noexcept { return queue_.lost(); }

  // Link, by the thread that ticks the site. Real-time safe.
  void send(const StatePacket& packet, double now) noexcept override;
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;
  [[nodiscard]] bool hasLeft() const noexcept override;

 private:
  TimeBridge bridge_;
  LinkQueue queue_;
  bool has_haptic_thread_ = false;
  std::atomic<double> site_time_{0.0};
  std::atomic<bool> has_ticked_{false};  ///< since the haptic thread is there
};

}  // namespace tandem
