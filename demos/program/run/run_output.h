#pragma once

#include <nlohmann/json_fwd.hpp>

#include "files/output_folder.h"
#include "run/virtual_run.h"

namespace tandem::demos {

/// summary.json of a finished run.
[[nodiscard]] nlohmann::json makeSummary(const Scenario& scenario, const VirtualRun& run);

/// Publishes site1.csv and the others', scene.csv and summary.json: all of them or, on an error,
/// none. Throws tandem::Error or std::filesystem::filesystem_error that names the file.
void writeRun(const OutputFolder& folder, const nlohmann::json& summary, const VirtualRun& run);

}  // namespace tandem::demos
