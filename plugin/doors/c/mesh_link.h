#pragma once

#include <atomic>
#include <optional>

#include "tandem/coordination/link.h"
#include "tandem/plugin/link_queue.h"

// Between a mesh, which goes by the caller's clock, and a site, which goes by its own time:
//
//   one thread       site  <------------------------>  MeshWay  <-->  mesh
//   with a loop      site  <-->  LinkQueue  <-- poll() -->  MeshWay  <-->  mesh

namespace tandem::c_door {

/// The mesh's end, in the site's time.
class MeshWay final : public Link {
 public:
  explicit MeshWay(Link& way) noexcept : way_(way) {}

  /// The caller's clock now: what is sent leaves now, whatever time its state belongs to.
  void setClock(double clock) noexcept;
  /// The site's time at that moment.
  void setSiteTime(double time) noexcept;
  [[nodiscard]] double siteTime() const noexcept { return clock_ - ahead_.value_or(0.0); }

  void send(const StatePacket& packet, double) noexcept override { way_.send(packet, clock_); }
  /// The first time after setClock() says what the site's time is, too.
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  Link& way_;
  double clock_ = 0.0;
  bool is_clock_new_ = false;
  std::optional<double> ahead_;  ///< the clock, of the site's time [s]
};

/// What a site is connected to.
class MeshLink final : public Link {
 public:
  explicit MeshLink(Link& way) noexcept : way_(way) {}

  /// From here on the site is ticked by another thread than that of poll(), or is not any more.
  void setLive(bool is_live) noexcept;

  /// After each poll of the mesh, by the same thread.
  void poll(double clock) noexcept;

  void send(const StatePacket& packet, double now) noexcept override;
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  MeshWay way_;
  LinkQueue queue_;
  bool is_live_ = false;
  std::atomic<double> site_time_{0.0};
  std::atomic<bool> has_ticked_{false};  ///< since it is live
};

}  // namespace tandem::c_door
