#pragma once

#include <filesystem>
#include <string>

namespace tandem::demos {

/// Folder of the running program; empty if the system does not tell it.
[[nodiscard]] std::filesystem::path findOwnFolder();

/// A file or folder that comes with Tandem, such as "worlds": beside the program in a build folder,
/// and below share/ in an installation. Empty if it is in neither.
[[nodiscard]] std::filesystem::path findOwnData(const std::string& name);

}  // namespace tandem::demos
