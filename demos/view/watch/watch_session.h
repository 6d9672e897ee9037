#pragma once

#include <array>
#include <atomic>
#include <thread>

#include "peer/watch_check.h"
#include "session/session.h"
#include "watch/room_look.h"

namespace tandem::view {

/// A session of others, which a spectator follows through a relay. It has no site and no hand, and
/// says nothing that a site opens.
class WatchSession final : public Session {
 public:
  /// Throws as WatchCheck, Watcher and RoomLook do. What sites that are heard lead to, goesOn()
  /// throws.
  WatchSession(const demos::Scenario& scenario, const demos::PeerLine& line);
  ~WatchSession() override;

  /// Shows the copies of a user, from 0, instead of the first who was heard. For any thread.
  void follow(int user) noexcept { wanted_ = user; }

 private:
  void live(const std::stop_token& stop);
  void takeStates();
  void lookAtRoom(double now);

  static constexpr int kNobody = -1;

  double begun_;  ///< [s]
  demos::WatchCheck check_;
  Watcher watcher_;
  RoomLook room_;
  std::atomic<int> wanted_ = kNobody;
  std::jthread thread_;  // the last: it ends before what it uses
};

}  // namespace tandem::view
