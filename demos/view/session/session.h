#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "tandem/plugin/haptic_loop.h"

#include "session/scene_look.h"

namespace tandem::view {

/// A user of a session, as a spectator sees one.
struct UserLook {
  int user = 0;                       ///< from 0
  Vec3 hand_W = Vec3::Zero();         ///< [m]
  double age = 0.0;                   ///< since the newest state [s]
  bool is_live = false;               ///< that was a short while ago
  bool has_another_scenario = false;  ///< than the spectator: nothing of this user is shown
};

/// A session at one moment, for a picture and a panel.
struct SessionLook {
  double time = 0.0;                                  ///< of the sites [s]
  DrawList list;                                      ///< without the user's own hand
  Vec3 hip_W = Vec3::Zero(), force_W = Vec3::Zero();  ///< of the user's hand [m], [N]
  Vec3 object_W = Vec3::Zero();                       ///< of the first object [m]
  double apart = 0.0;                 ///< of its own copy and the farthest of the others' [m]
  LinkState link = LinkState::kLive;  ///< to the first other site that is not live
  std::uint32_t status = 0;           ///< bits of TickStatus since the start
  double energy = 0.0;                ///< that the hand may still get from the world [J]
  LoopReport loop;                    ///< of the user's own haptic thread
  bool is_waiting = false;            ///< the other site is not there yet
  std::vector<UserLook> users;        ///< all who were heard, for a spectator
  std::optional<int> followed;        ///< the one whose copies a spectator sees, from 0
};

/// A session runs behind a window, and makes looks in threads of its own. All calls are for any
/// thread.
class Session {
 public:
  virtual ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The newest look.
  [[nodiscard]] std::shared_ptr<const SessionLook> look() const;
  /// The user wants to hold the object, or not.
  void hold(bool wants) noexcept { wants_hold_ = wants; }
  /// Chooses what looks show besides bodies.
  void showDetails(const WorldDetails& details);
  /// Warnings, and rights that the haptic threads did not get, with the remedy.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// False once the session has ended. Throws what ended it early.
  [[nodiscard]] bool goesOn() const;

 protected:
  Session() = default;
  void publish(std::shared_ptr<const SessionLook> look);
  [[nodiscard]] WorldDetails details() const;
  [[nodiscard]] bool wantsHold() const noexcept { return wants_hold_; }
  /// From now on these are the notes.
  void tell(const std::vector<std::string>& notes);
  /// From now on these lines come before the notes.
  void warn(const std::vector<std::string>& warnings);
  // For the thread that steps the world:

  /// Runs `live`, the whole session. What it throws is for goesOn().
  void liveToTheEnd(const std::function<void()>& live);
  /// True if it is time for the next look at `time` [s], which is then counted as made.
  [[nodiscard]] bool isLookDue(double time) noexcept;
  /// Fills in what a site tells of itself. Gives the farthest copy of the first object, as another
  /// site last told it.
  static std::optional<RigidState> lookAt(Site& site, SessionLook& look);

 private:
  std::atomic<bool> wants_hold_ = false;
  double next_look_ = 0.0;    ///< [s]
  mutable std::mutex mutex_;  // of all below
  WorldDetails details_;
  std::vector<std::string> warnings_, notes_;
  std::exception_ptr problem_;
  bool has_ended_ = false;
  std::shared_ptr<const SessionLook> look_;  ///< shared with the window, which draws it meanwhile
};

}  // namespace tandem::view
