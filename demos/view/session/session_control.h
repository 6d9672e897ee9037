#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/falcon/mouse_device.h"

#include "device/live_device.h"
#include "session/live_session.h"
#include "session/peer_session.h"
#include "session/worker.h"

namespace tandem::view {

/// What the user wants of a session.
struct SessionWishes {
  demos::Scenario scenario;
  Pace pace;
  int steps = 0;                 ///< host periods that a paused world is to go on by
  bool restarts = false;         ///< the world is to begin anew
  bool changes_sites = false;    ///< scheme, contact or gains have changed; the world goes on
  bool changes_network = false;  ///< Scenario::network alone has changed
  std::string world;             ///< one of Tandem's own to go to; empty: stay
};

/// Devices at this machine, which must outlive the session.
struct UsersDevices {
  demos::LiveDevice* own = nullptr;     ///< null: a mouse
  demos::LiveDevice* second = nullptr;  ///< user 2's, if both sites are here; null: simulated
};

/// Gives the user of this machine, 0 or 1; 0 without a `line`, when both sites are here.
[[nodiscard]] inline int userOf(const std::optional<demos::PeerLine>& line) {
  return line ? line->site - 1 : 0;
}

/// The session behind a window, as its user changes it. Other sites need another session, which
/// goes on from where hands and bodies are. For the thread of the window.
class SessionControl {
 public:
  /// `line` leads to a friend's site; none: both sites are here. With `record`, a folder, each
  /// session is recorded. Throws UsageError if a device cannot feel the scenario, and as
  /// SessionRecords and sessions do.
  SessionControl(const demos::Scenario& scenario, const std::optional<demos::PeerLine>& line,
                 const UsersDevices& devices,
                 const std::optional<std::filesystem::path>& record = std::nullopt);

  [[nodiscard]] Session& session() noexcept { return *session_; }
  [[nodiscard]] const Session& session() const noexcept { return *session_; }
  /// Null with another device.
  [[nodiscard]] MouseDevice* mouse() noexcept { return mouse_.get(); }
  [[nodiscard]] const demos::Scenario& scenario() const noexcept { return scenario_; }
  [[nodiscard]] const Pace& pace() const noexcept { return pace_; }
  [[nodiscard]] bool hasBothSites() const noexcept { return both_ != nullptr; }
  /// Lines for the user: rights that are missing, and why the last wish is refused.
  [[nodiscard]] std::vector<std::string> notes() const;

  /// Does what can be done. Refuses the rest, with a note.
  void obey(const SessionWishes& wishes);
  /// Ends the session and stores its record, the last one. Throws as the sessions do.
  void end();

 private:
  void changeSites(const SessionWishes& wishes);
  void changeWorld(const std::string& name);
  void changePace(const SessionWishes& wishes);
  void followFriend();
  void checkHand(const demos::Scenario& scenario) const;
  void start(const std::optional<demos::ScenePlaces>& places);
  void makeSession(const std::optional<demos::ScenePlaces>& places);

  demos::Scenario scenario_;
  std::optional<demos::PeerLine> line_;
  UsersDevices devices_;
  Pace pace_;
  std::string refusal_;  ///< empty: none
  std::optional<SessionRecords> records_;
  Worker session_maker_;
  std::unique_ptr<MouseDevice> mouse_;
  std::unique_ptr<Session> session_;  // after the mouse, which outlives it
  LiveSession* both_ = nullptr;       ///< the session, if both sites are here
  PeerSession* friend_ = nullptr;     ///< the session, if the other site is elsewhere
  std::uint32_t changes_ = 0;         ///< of that session, which `scenario_` has
};

}  // namespace tandem::view
