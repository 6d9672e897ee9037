#pragma once

#include <span>

#include "gl/projection.h"
#include "scenario/scenario.h"

// Parts of panels that all windows share. They need Dear ImGui's frame.

namespace tandem::view {

/// The size of the window's content.
[[nodiscard]] PictureSize shownSize();

/// Begins the panel at the upper left, with the scenario's title. ImGui::End() ends it.
void beginPanel(const demos::Scenario& scenario);

/// A line with a name and a value.
void describe(const char* name, const char* value);

/// A button that asks for a picture, and its key. True if the user used one of them.
[[nodiscard]] bool askForPicture();

/// A line of the help.
struct HelpLine {
  const char* input;
  const char* meaning;
};

/// A button for the help, and its key; the help itself at the upper right while `is_shown`.
void showHelp(bool& is_shown, std::span<const HelpLine> help);

}  // namespace tandem::view
