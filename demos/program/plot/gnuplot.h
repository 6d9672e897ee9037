#pragma once

#include <filesystem>

#include "plot/figure.h"

namespace tandem::demos::plot {

/// Draws `figure` into `folder` as <name>.svg and <name>.png with the external program gnuplot; a
/// figure that is a finished SVG is only stored.
///
/// Throws Error when gnuplot is not installed (with the remedy) or refuses the figure.
void drawFigure(const Figure& figure, const std::filesystem::path& folder);

/// Throws Error with the remedy when gnuplot cannot be started; `folder` takes its messages.
void requireGnuplot(const std::filesystem::path& folder);

/// Stores `text` as a file. Throws Error naming the file.
void writeText(const std::filesystem::path& file, const std::string& text);

}  // namespace tandem::demos::plot
