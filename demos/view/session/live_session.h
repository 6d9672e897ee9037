#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tandem/plugin/haptic_loop.h"

#include "session/live_network.h"
#include "session/scene_look.h"

namespace tandem::view {

/// What a picture and a panel show of a session at one moment.
struct SessionLook {
  double time = 0.0;                                  ///< of both sites [s]
  DrawList list;                                      ///< without the user's own hand
  Vec3 hip_W = Vec3::Zero(), force_W = Vec3::Zero();  ///< of the user's hand [m], [N]
  Vec3 object_W = Vec3::Zero();                       ///< of the first object [m]
  double apart = 0.0;                                 ///< of the two copies [m]
  LinkState link = LinkState::kLive;
  std::uint32_t status = 0;  ///< bits of TickStatus since the start
  LoopReport loop;           ///< of the user's own haptic thread
};

/// Both sites of a scenario live in one process: two Bullet worlds, two haptic threads at the
/// scenario's rate, a network between them, and a thread that steps the worlds. User 1 is at the
/// device, user 2 moves as the scenario says.
class LiveSession {
 public:
  /// `device` must outlive this. Throws as SiteWorld and HapticLoop do.
  LiveSession(const demos::Scenario& scenario, HapticDevice& device);
  /// Fades the forces and ends all threads.
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  /// The newest look; null before the first host step. For any thread.
  [[nodiscard]] std::shared_ptr<const SessionLook> look() const;
  /// Changes the network while hands touch. For any thread.
  void setNetwork(const Impairments& network) { network_.change(network); }
  /// The user wants to hold the object, or not. For any thread.
  void hold(bool wants) noexcept { wants_hold_ = wants; }
  /// Chooses what looks show besides bodies. For any thread.
  void showDetails(const WorldDetails& details);
  /// Rights that the haptic threads did not get, with the remedy.
  [[nodiscard]] const std::vector<std::string>& notes() const { return loops_[0]->notes(); }

 private:
  void stepWorlds(const std::stop_token& stop);
  void publish(double time);
  [[nodiscard]] WorldDetails details() const;

  LiveNetwork network_;
  demos::SiteWorld own_, other_;
  SceneLook scene_look_;
  double host_rate_;
  bool may_hold_;
  double begin_ = 0.0;  ///< on the monotonic clock [s]
  std::atomic<bool> wants_hold_ = false;
  mutable std::mutex mutex_;  // of the two below
  WorldDetails details_;
  std::shared_ptr<const SessionLook> look_;  ///< shared with the window, which draws it meanwhile
  std::array<std::unique_ptr<HapticLoop>, 2> loops_;
  std::jthread host_;  // the last: it ends before what it uses
};

}  // namespace tandem::view
