#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "tandem/plugin/datagram_carrier.h"

#include "peer/peer_line.h"
#include "peer/peer_run.h"

namespace tandem::demos {

/// The user of a site, and the purpose of being there.
struct PeerUser {
  HapticDevice* device = nullptr;    ///< must outlive the meeting; null: simulated
  std::function<bool()> wants_grip;  ///< empty: the scenario says when
  PeerPurpose purpose = PeerPurpose::kResults;
  bool may_follow = true;  ///< false: a change by another user ends the meeting with an Error
};

/// A meeting calls these in the thread of PeerMeeting::live(). `stop` asks to end.
struct PeerWatch {
  std::function<bool()> stop;
  std::function<void(const PeerReport&)> report;
  std::function<void(const std::string&)> note;  ///< for the user: missing rights, changes
  std::function<void()> has_world = [] {};       ///< PeerMeeting::run() has another world
  std::function<void(double, const HapticLoop&)> after_step = {};  ///< as of PeerRun::run()
  std::function<void()> after_run = [] {};  ///< PeerMeeting::run() is over, with its record
};

/// A site's meeting with other users: PeerRuns one after the other, with the same socket's
/// address. Another one begins after a change of scheme or gains by any user, and goes on from
/// where hands and bodies are. At most three changes a second are followed.
class PeerMeeting {
 public:
  /// Throws as PeerRun does.
  PeerMeeting(const Scenario& scenario, const PeerLine& line, PeerUser user);

  /// Waits for the other sites and runs, over all changes. False if `stop` asked to end before a
  /// start. Throws as PeerRun does.
  bool live(const PeerWatch& watch);
  /// For the thread of live().
  [[nodiscard]] PeerRun& run() noexcept { return *run_; }

  // For any thread.

  /// The user wants another scheme or other gains. Throws UsageError for another wish; then nothing
  /// changes. If another site does not follow, what was before is back after 5 s.
  void propose(const Scenario& wanted);
  /// The scenario in force, and the number of changes that led to it.
  [[nodiscard]] ChangedScenario scenario() const;

 private:
  void makeRun(const ScenePlaces* places);
  bool meetOnce(const PeerWatch& watch);
  [[nodiscard]] bool wantsNext(const PeerWatch& watch);
  [[nodiscard]] bool takesProposal();
  [[nodiscard]] bool takesFollowing(const PeerWatch& watch, const PeerStatus& status);
  void goOn(const PeerWatch& watch);

  PeerLine line_;
  PeerUser user_;
  std::unique_ptr<DatagramCarrier> carrier_;  ///< null: UDP
  std::unique_ptr<PeerRun> run_;
  std::optional<ChangedScenario> next_;    ///< of the next run
  std::optional<ChangedScenario> before_;  ///< the own change, if others may not follow it yet
  bool is_running_ = false;
  double next_look_ = 0.0, followed_at_ = 0.0;  ///< [s]
  std::string refusal_;                         ///< of another's newest change; empty: none

  mutable std::mutex mutex_;  // of the two below
  ChangedScenario scenario_;
  std::optional<ChangedScenario> proposal_;
};

}  // namespace tandem::demos
