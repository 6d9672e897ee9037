#pragma once

#include <array>
#include <string>
#include <vector>

#include "session/session.h"

namespace tandem::view {

/// The user's choices on the panel in this frame.
struct PanelWishes {
  bool restarts = false;         ///< the world is to begin anew
  bool changes_scheme = false;   ///< the scheme or gains have changed; the world goes on
  bool changes_network = false;  ///< Scenario::network alone has changed
  bool takes_picture = false;
};

/// Settings and numbers of a session beside its picture. Needs Dear ImGui's frame.
class Panel {
 public:
  /// Shows the panel. Writes the user's settings into `scenario`, if it may be changed here: two
  /// sites on two machines have agreed on theirs.
  [[nodiscard]] PanelWishes show(demos::Scenario& scenario, const SessionLook& look,
                                 const std::vector<std::string>& notes, bool may_change);

  /// The parts of the world that the user wants to see besides bodies.
  [[nodiscard]] const WorldDetails& details() const noexcept { return details_; }

 private:
  static void showSettings(demos::Scenario& scenario, PanelWishes& wishes);
  void showForce(const SessionLook& look, double most);
  static void showState(const demos::Scenario& scenario, const SessionLook& look,
                        const std::vector<std::string>& notes);

  std::array<float, 240> forces_ = {};  ///< a ring of the last frames' [N]
  int next_ = 0;
  bool shows_help_ = false;
  WorldDetails details_;
};

}  // namespace tandem::view
