#pragma once

#include <optional>

#include "tandem/coordination/link.h"

namespace tandem::demos {

/// Lets two sites begin at the same moment, and go by a time that is 0 then.
///
/// A site's time is its clock minus the start. On the way, times are moved by kBefore, so that the
/// states of the countdown, when that time is still negative, can be told; time 0 on the way says
/// that no start is known yet. The site with the lower number chooses the start; the other learns
/// it from the states that it gets.
class StartLink final : public Link {
 public:
  static constexpr double kBefore = 1000.0;  ///< site time 0 on the way [s]

  /// `link` goes by the clock and must outlive this.
  explicit StartLink(Link& link) noexcept : link_(link) {}

  void setStart(double start) noexcept { start_ = start; }
  [[nodiscard]] std::optional<double> start() const noexcept { return start_; }
  /// The clock now: what is sent leaves now, whatever time its state belongs to.
  void setClock(double clock) noexcept { clock_ = clock; }

  /// Tells the state that the user holds until the start.
  void sendHeld(const PointState& user, PeerId self) noexcept;

  /// While there is no start: takes it from a state that has come in, `delay` [s] after it was
  /// sent.
  void listenForStart(double delay) noexcept;

  // Link, in the site's time.
  void send(const StatePacket& packet, double now) noexcept override;
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  void sendStamped(StatePacket packet, double time) noexcept;

  Link& link_;
  std::optional<double> start_;
  double clock_ = 0.0;
  std::uint64_t sequence_ = 0;
};

}  // namespace tandem::demos
