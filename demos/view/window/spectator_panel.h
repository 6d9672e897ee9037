#pragma once

#include <optional>

#include "gl/projection.h"
#include "scenario/scenario.h"
#include "session/session.h"

namespace tandem::view {

/// A spectator's choices in this frame.
struct SpectatorWishes {
  std::optional<int> followed;  ///< user, from 0, whose copies are to be shown
  bool shows_all = false;       ///< all users are to be in the picture
  bool takes_picture = false;
};

/// The users of a room and what is chosen of them, beside their picture. Needs Dear ImGui's frame.
class SpectatorPanel {
 public:
  [[nodiscard]] SpectatorWishes show(const demos::Scenario& scenario, const SessionLook& look,
                                     const std::vector<std::string>& notes);

  /// The parts of the world that the spectator wants to see besides bodies.
  [[nodiscard]] const WorldDetails& details() const noexcept { return details_; }

 private:
  bool shows_help_ = false;
  WorldDetails details_;
};

/// Writes the number of each user that is shown beside the hand.
void labelHands(const SessionLook& look, const Eye& eye);

}  // namespace tandem::view
