#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "run/virtual_run.h"

namespace tandem::demos {

/// summary.json of a finished run.
[[nodiscard]] nlohmann::json makeSummary(const Scenario& scenario, const VirtualRun& run);

/// Writes site1.csv, site2.csv, scene.csv and summary.json: all of them or, on an error, none.
/// summary.json comes last, so it marks a complete run. Throws tandem::Error or
/// std::filesystem::filesystem_error that names the file.
void writeRun(const std::filesystem::path& folder, const nlohmann::json& summary,
              const VirtualRun& run);

}  // namespace tandem::demos
