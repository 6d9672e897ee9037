#pragma once

namespace tandem::preload {

/// The config file that TANDEM_PRELOAD names; null if it names none.
[[nodiscard]] const char* findConfig() noexcept;

/// This process's name, as argv[0] has it, without folders.
[[nodiscard]] const char* processName() noexcept;

/// Whether the config wants this process. LD_PRELOAD is inherited by every child, so a config may
/// say `process = "name"`, on a line of its own before the first table; one that does not, or
/// cannot be read, wants every process.
[[nodiscard]] bool isWanted(const char* config) noexcept;

/// The value of such a line in a TOML text; false if there is none. At most `size` - 1 characters.
[[nodiscard]] bool findProcessKey(const char* text, char* name, unsigned long size) noexcept;

}  // namespace tandem::preload
