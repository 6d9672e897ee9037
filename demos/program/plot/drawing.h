#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// \file
/// Figures and reports. The Python package `plot` draws them, in a process of its own.
namespace tandem::demos {

/// Throws Error with the remedy if figures cannot be drawn here.
void requireDrawing();

/// Turns run folders into figures and one self-contained report: the program's `plot` command.
///
/// Writes `report.html` into the first folder and the figures, SVG and PNG, into its sub-folder
/// `figures`, which belongs to this command. Prints the report's path to stdout. Returns the exit
/// status of the program: if it is not 0, stderr has a line with the reason.
[[nodiscard]] int plotRuns(const std::vector<std::string>& folders);

/// Draws the figures of a bench's JSON file beside it. Throws Error.
void drawBench(const std::filesystem::path& json);

/// Draws the figures of an analysis beside its stability.json. Throws Error.
void drawAnalysis(const std::filesystem::path& json);

}  // namespace tandem::demos
