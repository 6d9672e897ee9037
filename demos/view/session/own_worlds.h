#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tandem::view {

/// Names of the worlds that come with Tandem, the paper's experiments too, in alphabetical order.
[[nodiscard]] std::vector<std::string> listWorlds();

/// The file of one of them. Empty if there is none of that name.
[[nodiscard]] std::optional<std::filesystem::path> findOwnWorld(const std::string& name);

}  // namespace tandem::view
