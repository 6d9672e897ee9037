#pragma once

#include <nlohmann/json.hpp>

#include "scenario/toml_input.h"

namespace tandem::demos {

/// The TOML table of a described scenario, without the values that equal `defaults`: some of them,
/// such as no waypoints, cannot be written in a file. Throws UsageError with `name` if it nests too
/// deep, is no table, or has a null.
[[nodiscard]] toml::table makeToml(const nlohmann::json& described, const nlohmann::json& defaults,
                                   const std::string& name);

}  // namespace tandem::demos
