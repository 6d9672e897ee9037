#pragma once

#include <thread>

#include "device/live_device.h"
#include "scenario/scenario.h"
#include "session/pace.h"
#include "session/pair_record.h"
#include "session/session.h"
#include "session/site_pair.h"
#include "world/scene_places.h"

namespace tandem::view {

/// How a LiveSession begins. What it points to must outlive the session.
struct LiveStart {
  demos::BodyPlaces places = {};        ///< of bodies at rest; empty: where the scenario says
  Pace pace = {};                       ///< see LiveSession::setPace()
  SessionRecords* records = nullptr;    ///< for a record of both sites; null: none
  demos::LiveDevice* second = nullptr;  ///< user 2's, in real time only; null: simulated
};

/// Both sites of a scenario in one process. User 1 is at the device, user 2 at the second one, or
/// moves as the scenario says. A thread steps the worlds. In real time each site has a haptic
/// thread at the scenario's rate. At another pace, and with Bullet's own contact, which has no
/// haptic rate, the sites tick in the thread that steps the worlds.
class LiveSession final : public Session {
 public:
  /// `device` must outlive this. Throws as SiteWorld and HapticLoop do.
  LiveSession(const demos::Scenario& scenario, HapticDevice& device, const LiveStart& start = {});
  /// Fades the forces and ends all threads.
  ~LiveSession() override;

  /// True if sites of the scenario may tick in haptic threads. Others need a simulated device.
  [[nodiscard]] static bool hasHapticThreads(const demos::Scenario& scenario);

  /// Changes the network while hands touch.
  void setNetwork(const Impairments& network);
  /// Only with a simulated device, such as the mouse: a hand of flesh does not stop. See PacedTime.
  void setPace(const Pace& pace);
  /// While paused: time goes on by one host period.
  void step() noexcept { ++steps_; }
  /// Ends the session, stores its record, and tells where it was. Throws as PairRecord::store().
  demos::ScenePlaces end();

 private:
  void live(const std::stop_token& stop);
  void runThreads(const std::stop_token& stop);
  void runPaced(const std::stop_token& stop);
  void afterSteps(double time);
  void lookAtWorlds(double time);
  void startThreads();
  [[nodiscard]] Pace pace() const;
  [[nodiscard]] bool needsThreads() const { return has_threads_ && pace().isRealTime(); }

  SitePair pair_;
  demos::LiveDevice* second_;           ///< null: user 2 is simulated
  std::unique_ptr<PairRecord> record_;  ///< null: none is wanted, or it is stored
  demos::Scenario scenario_;            ///< with the network as it is now
  SceneLook scene_look_;
  bool may_hold_, has_threads_;
  std::atomic<int> steps_ = 0;  ///< that the user still wants

  mutable std::mutex mutex_;  // of the pace
  Pace pace_;
  std::jthread host_;  // the last: it ends before what it uses
};

}  // namespace tandem::view
