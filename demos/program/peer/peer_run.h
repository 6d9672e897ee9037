#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/live_peers.h"

#include "run/site_record.h"
#include "world/scene.h"
#include "world/scene_places.h"

namespace tandem::demos {

/// Values shown to the user once a second.
struct PeerReport {
  double time = 0.0;  ///< site time [s]; negative before the start, when no force is felt
  bool has_start = false;
  PeerStatus peer;
  std::optional<RelayConnection> relay;  ///< empty without a relay
  LinkState link = LinkState::kLive;     ///< decides the share of the gains
  double force = 0.0;                    ///< norm of the force on the device [N]
  double coherency = 0.0;                ///< own object copy against the other's as received [m]
};

/// Tells whether a PeerRun leaves something behind, and when it ends.
enum class PeerPurpose {
  kResults,          ///< a record; it ends with the scenario's duration
  kSession,          ///< nothing; it goes on until somebody stops it
  kRecordedSession,  ///< a record of at most kLongestRecord; it goes on until somebody stops it
};

/// One site of a scenario, live in real time. A haptic thread ticks at absolute moments, and
/// another thread owns the socket. The caller of run() steps the host's Bullet world when due.
/// Until the start one thread does all.
class PeerRun {
 public:
  /// `site` is 0 or 1. `device` is the user's, and must outlive this; null means simulated, by the
  /// scenario. `wants_grip`: the user wants to hold the cube; empty: the scenario says when. Bodies
  /// begin at rest at `places`, or where the scenario says. Throws like LivePeers and SiteWorld.
  PeerRun(const Scenario& scenario, int site, const UdpMeshSettings& settings, UdpPeer peer,
          HapticDevice* device = nullptr, std::function<bool()> wants_grip = {},
          PeerPurpose purpose = PeerPurpose::kResults, const BodyPlaces& places = {},
          std::optional<RelayAccess> relay = std::nullopt);

  /// Waits until the other site is there and both know the start. Throws UsageError if it has
  /// another configuration, or does not agree to a change within 5 s. Throws tandem::Error if it
  /// does not answer within `patience` [s], counts down for longer, or leaves before the start.
  /// Returns false if `stop` asked to end.
  bool waitForPeer(double patience, const std::function<bool()>& stop,
                   const std::function<void(const PeerReport&)>& report);

  /// Runs until the scenario's duration is over or `stop` asks to end. Then the force fades and the
  /// other site gets a BYE. Calls `note` with one line for each right that the system refuses the
  /// haptic thread, and `after_step` after each host step with its time [s] and the loop.
  void run(const std::function<bool()>& stop, const std::function<void(const PeerReport&)>& report,
           const std::function<void(const std::string&)>& note,
           const std::function<void(double, const HapticLoop&)>& after_step = {});

  /// Not with PeerPurpose::kSession.
  [[nodiscard]] const SiteRecord& record() const noexcept { return *record_; }
  [[nodiscard]] const LoopReport& loop() const noexcept { return loop_; }
  [[nodiscard]] const LivePeers& peers() const noexcept { return peers_; }
  [[nodiscard]] SiteWorld& world() noexcept { return *world_; }
  [[nodiscard]] double duration() const noexcept;
  [[nodiscard]] const Scenario& scenario() const noexcept { return scenario_; }
  [[nodiscard]] PeerStatus peerStatus() const;
  /// The places of hands and bodies now. For the thread of run(), or after it.
  [[nodiscard]] ScenePlaces places();

 private:
  void makeWorld();
  void joinLate(double now);
  [[nodiscard]] PeerReport makeReport(double time);
  [[nodiscard]] double computeCoherency() const noexcept;

  Scenario scenario_;
  int index_;
  HapticDevice* device_;
  std::function<bool()> wants_grip_;
  PeerPurpose purpose_;
  BodyPlaces places_;
  PeerId other_;
  LivePeers peers_;
  std::unique_ptr<SiteWorld> world_;
  std::unique_ptr<SiteRecord> record_;
  Vec3 object_start_W_ = Vec3::Zero();
  LoopReport loop_;
};

}  // namespace tandem::demos
