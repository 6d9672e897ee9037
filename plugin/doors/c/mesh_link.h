#pragma once

#include <atomic>
#include <optional>

#include "tandem/coordination/link.h"
#include "tandem/plugin/link_queue.h"

// Connects a mesh, which uses the caller's clock, with a site, which uses its own time:
//
//   one thread       site  <------------------------>  MeshWay  <-->  mesh
//   with a loop      site  <-->  LinkQueue  <-- poll() -->  MeshWay  <-->  mesh

namespace tandem::c_door {

/// Link to the mesh, converted to the site's time.
class MeshWay final : public Link {
 public:
  explicit MeshWay(Link& way) noexcept : way_(way) {}

  /// Sets the caller's clock. Packets leave at this time, whatever the time of their state.
  void setClock(double clock) noexcept;
  /// Sets the site's time at that moment.
  void setSiteTime(double time) noexcept;
  [[nodiscard]] double siteTime() const noexcept { return clock_ - ahead_.value_or(0.0); }

  void send(const StatePacket& packet, double) noexcept override { way_.send(packet, clock_); }
  /// The first call after setClock() also sets the site's time.
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  Link& way_;
  double clock_ = 0.0;
  bool is_clock_new_ = false;
  std::optional<double> ahead_;  ///< caller's clock minus the site's time [s]
};

/// Link of a site to a mesh, with or without a loop.
class MeshLink final : public Link {
 public:
  explicit MeshLink(Link& way) noexcept : way_(way) {}

  /// Tells whether another thread than that of poll() ticks the site from now on.
  void setLive(bool is_live) noexcept;

  /// Call it after each poll of the mesh, from the same thread.
  void poll(double clock) noexcept;

  void send(const StatePacket& packet, double now) noexcept override;
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  MeshWay way_;
  LinkQueue queue_;
  bool is_live_ = false;
  std::atomic<double> site_time_{0.0};
  std::atomic<bool> has_ticked_{false};  ///< a tick has run since setLive()
};

}  // namespace tandem::c_door
