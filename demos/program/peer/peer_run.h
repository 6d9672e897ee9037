#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/live_peers.h"

#include "analyse/growth_watch.h"
#include "peer/answer_check.h"
#include "run/site_record.h"
#include "world/scene.h"
#include "world/scene_places.h"

namespace tandem::demos {

/// The way to another site, and its use.
struct OtherSite {
  PeerStatus peer;
  LinkState link = LinkState::kLive;  ///< decides the share of the gains
};

/// Values shown to the user once a second.
struct PeerReport {
  double time = 0.0;  ///< site time [s]; negative before the start, when no force is felt
  int members = 0;    ///< sites that share the object; 0: as many as the scenario has
  bool has_start = false;
  std::vector<OtherSite> others;         ///< in the order of their numbers, at least one
  std::optional<RelayConnection> relay;  ///< empty without a relay
  double force = 0.0;                    ///< norm of the force on the device [N]
  double coherency = 0.0;  ///< own object copy against the farthest of the others', as received [m]
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
  /// `site` counts from 0; `peers` are all others, in the order of their numbers. `device` is the
  /// user's, and must outlive this; null means simulated, by the scenario. `wants_grip`: the user
  /// wants to hold the cube; empty: the scenario says when. Bodies begin at rest at `places`, or
  /// where the scenario says. Throws like LivePeers and SiteWorld.
  PeerRun(const Scenario& scenario, int site, const UdpMeshSettings& settings,
          std::vector<UdpPeer> peers, HapticDevice* device = nullptr,
          std::function<bool()> wants_grip = {}, PeerPurpose purpose = PeerPurpose::kResults,
          const BodyPlaces& places = {}, std::optional<RelayAccess> relay = std::nullopt);

  /// Waits until all other sites are there and know the start, or until one runs already. With
  /// `coordination.follows_users` it waits for nobody. Throws DisagreementError if one has another
  /// configuration, or does not agree to a change within 5 s. Throws tandem::Error if one does not
  /// answer within `patience` [s], counts down for longer, or leaves before the start. Returns
  /// false if `stop` asked to end.
  bool waitForPeers(double patience, const std::function<bool()>& stop,
                    const std::function<void(const PeerReport&)>& report);

  /// Runs until the scenario's duration is over or `stop` asks to end. Then the force fades and the
  /// other sites get a BYE. Calls `note` with one line for each right that the system refuses the
  /// haptic thread, and when gains do not fit the measured delay; and `after_step` after each host
  /// step with its time [s] and the loop.
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
  /// The states of all connections, in the order of the other sites' numbers.
  [[nodiscard]] std::vector<PeerStatus> statuses() const;
  /// The places of hands and bodies now. For the thread of run(), or after it.
  [[nodiscard]] ScenePlaces places();

 private:
  void makeWorld();
  void checkAnswers(std::vector<AnswerCheck>& answers, double waited);
  void joinLate(double now);
  [[nodiscard]] PeerReport makeReport(double time);
  void noteDifferences(const std::function<void(const std::string&)>& note);
  void noteGrowth(double time, const std::function<void(const std::string&)>& note);
  [[nodiscard]] double computeCoherency() const noexcept;

  Scenario scenario_;
  int index_;
  HapticDevice* device_;
  std::function<bool()> wants_grip_;
  PeerPurpose purpose_;
  BodyPlaces places_;
  std::vector<PeerId> others_;
  LivePeers peers_;
  std::unique_ptr<SiteWorld> world_;
  std::unique_ptr<SiteRecord> record_;
  LoopReport loop_;
  GrowthWatch growth_;
  std::vector<PeerId> noted_;  ///< sites of which the user knows that they have another scenario
};

}  // namespace tandem::demos
