#pragma once

#include <map>
#include <optional>
#include <vector>

#include "session/scene_look.h"
#include "session/session.h"
#include "watch/watched_track.h"

namespace tandem::view {

/// The users of a room and what they share, as a spectator sees them. Nothing is simulated: shared
/// bodies are where one site has its copies, all others where the scenario begins. For one thread.
class RoomLook {
 public:
  /// Throws as SceneWorld does.
  explicit RoomLook(const demos::Scenario& scenario);

  /// Takes the newest state of a user, from 0. If it does not fit the scenario, nothing of this
  /// user is shown.
  void take(int user, const WatchedSite& site, bool fits);

  /// The picture at `now` by the spectator's clock [s]: the copies of the user `wanted`, or of the
  /// first who was heard; the edges of others' copies that are elsewhere; a hand for each user.
  /// What belongs to a silent user is faded.
  [[nodiscard]] SessionLook look(double now, std::optional<int> wanted,
                                 const WorldDetails& details = {});

 private:
  struct User {
    WatchedTrack track;
    bool fits = true;
  };
  [[nodiscard]] std::optional<int> chooseFollowed(std::optional<int> wanted) const;
  void placeObjects(const WatchedTrack& track, double now);
  void fadeObjects(DrawList& list) const;
  [[nodiscard]] double addCopies(DrawList& list, int user, double now) const;
  void addHands(SessionLook& look, double now) const;

  demos::SceneWorld scene_;
  std::vector<demos::PlacedBody> shared_;  ///< by ObjectId
  SceneLook scene_look_;
  std::shared_ptr<const ShapeMesh> ball_;
  std::map<int, User> users_;
};

}  // namespace tandem::view
