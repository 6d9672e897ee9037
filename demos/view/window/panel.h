#pragma once

#include <array>

#include "session/session_control.h"

namespace tandem::view {

/// The user's choices on the panel in this frame.
struct PanelWishes {
  SessionWishes session;
  bool takes_picture = false;
};

/// Settings and numbers of a session beside its picture. Needs Dear ImGui's frame.
class Panel {
 public:
  /// Shows the panel.
  [[nodiscard]] PanelWishes show(const SessionControl& control, const SessionLook& look);

  /// The parts of the world that the user wants to see besides bodies.
  [[nodiscard]] const WorldDetails& details() const noexcept { return details_; }

 private:
  void showButtons(const SessionControl& control, PanelWishes& wishes);
  void showForce(const SessionLook& look, double most);
  static void showState(const SessionControl& control, const SessionLook& look);

  std::array<float, 240> forces_ = {};  ///< a ring of the last frames' [N]
  int next_ = 0;
  bool shows_help_ = false;
  WorldDetails details_;
};

}  // namespace tandem::view
