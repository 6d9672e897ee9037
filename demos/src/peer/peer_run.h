#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tandem/plugin/recording.h"
#include "tandem/plugin/udp_mesh.h"

#include "peer/live_clock.h"
#include "peer/start_link.h"
#include "scene.h"

namespace tandem::demos {

/// What a user may want to see once a second.
struct PeerReport {
  double time = 0.0;  ///< of the site [s]; negative: until the start; nothing is felt yet
  bool has_start = false;
  PeerStatus peer;
  LinkState link = LinkState::kLive;  ///< what share of the gains is in force
  double force = 0.0;                 ///< on the device, norm [N]
  double coherency = 0.0;  ///< own copy of the object against the other's as received [m]
};

/// Times of the loop.
struct LoopCounts {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;       ///< began more than half a period after their moment
  std::uint64_t stalls = 0;     ///< times the clock of the site was set back, being far behind
  double worst_lateness = 0.0;  ///< [s]
};

/// One site of a scenario, live against the clock, in one thread: haptic ticks at their absolute
/// moments, the socket before each, and the host's Bullet world as it comes due.
class PeerRun {
 public:
  /// `site` is 0 or 1. Throws as UdpMesh and SiteWorld do.
  PeerRun(const Scenario& scenario, int site, const UdpMeshSettings& settings, UdpPeer peer);

  /// Until the other site is there and both know the start. Throws UsageError if it has another
  /// configuration, tandem::Error if it does not answer within `patience` [s]. False if `stop`
  /// asked to end.
  bool waitForPeer(double patience, const std::function<bool()>& stop,
                   const std::function<void(const PeerReport&)>& report);

  /// Ticks until the scenario's duration is over or `stop` asks to end; then the force fades and
  /// the other site is told.
  void run(const std::function<bool()>& stop, const std::function<void(const PeerReport&)>& report);

  [[nodiscard]] const Recording& recording() const noexcept { return *recording_; }
  [[nodiscard]] const LoopCounts& loop() const noexcept { return loop_; }
  [[nodiscard]] const UdpMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] SiteWorld& world() noexcept { return *world_; }
  [[nodiscard]] double duration() const noexcept;
  [[nodiscard]] const Scenario& scenario() const noexcept { return scenario_; }
  [[nodiscard]] double receivedMean() const noexcept;
  [[nodiscard]] PeerStatus peerStatus() const { return mesh_.status(other_, clock_.now()); }

 private:
  void makeWorld();
  void joinLate(double now);
  void poll() noexcept;
  void checkAnswer(double waited, double patience) const;
  void leave(ByeReason reason) noexcept;
  void fadeForce() noexcept;
  [[nodiscard]] PeerReport makeReport(double time) const;
  [[nodiscard]] double computeCoherency() const noexcept;

  Scenario scenario_;
  int index_;
  PeerId self_, other_;
  LiveClock clock_;
  UdpMesh mesh_;
  StartLink link_;
  std::unique_ptr<SiteWorld> world_;
  std::unique_ptr<Recording> recording_;
  Vec3 object_start_W_ = Vec3::Zero();
  LoopCounts loop_;
  double coherency_sum_ = 0.0;
};

}  // namespace tandem::demos
