#pragma once

#include "session/session_control.h"

namespace tandem::view {

/// The part of the panel that changes the session. Writes the user's wishes; keys count as well.
/// Needs Dear ImGui's frame.
void showSettings(const SessionControl& control, SessionWishes& wishes);

}  // namespace tandem::view
