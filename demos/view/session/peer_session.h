#pragma once

#include <optional>
#include <thread>

#include "peer/peer_meeting.h"
#include "session/session.h"
#include "session/session_records.h"

namespace tandem::view {

/// One site of a scenario, live over UDP, with another user at another machine: what `tandem peer`
/// does. It waits for the other site. Should that one leave, it may come again. Changes of scheme
/// and gains by either user are followed by the other.
class PeerSession final : public Session {
 public:
  /// `device` must outlive this. With `records`, which must outlive this, the own site is recorded.
  /// Throws as PeerRun does.
  PeerSession(const demos::Scenario& scenario, const demos::PeerLine& line, HapticDevice& device,
              SessionRecords* records = nullptr);
  /// Fades the force and leaves.
  ~PeerSession() override;

  /// Leaves, and stores the record. Throws what ended the session early.
  void end();
  /// As PeerMeeting::propose().
  void propose(const demos::Scenario& wanted) { meeting_.propose(wanted); }
  /// What is in force, and by how many changes.
  [[nodiscard]] demos::ChangedScenario scenario() const { return meeting_.scenario(); }

 private:
  void live(const std::stop_token& stop);
  void storeRecord();
  void lookAtWorld(double time, const HapticLoop* loop);

  int site_;  ///< 1 or 2
  SessionRecords* records_;
  demos::PeerMeeting meeting_;
  std::optional<SceneLook> scene_look_;  ///< of the run's world, once that is final
  std::jthread thread_;                  // the last: it ends before what it uses
};

}  // namespace tandem::view
