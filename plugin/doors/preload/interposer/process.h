#pragma once

namespace tandem::preload {

/// Config file named by TANDEM_PRELOAD; null if there is none.
[[nodiscard]] const char* findConfig() noexcept;

/// Name of this process as in argv[0], without folders.
[[nodiscard]] const char* processName() noexcept;

/// True if the config wants this process. Every child inherits LD_PRELOAD, so a config may contain
/// `process = "name"`, on its own line before the first table. A config without that line, or an
/// unreadable one, wants every process.
[[nodiscard]] bool isWanted(const char* config) noexcept;

/// Reads the value of that line in a TOML text, at most `size` - 1 characters. Returns false if
/// there is none.
[[nodiscard]] bool findProcessKey(const char* text, char* name, unsigned long size) noexcept;

}  // namespace tandem::preload
