#pragma once

#include <filesystem>

#include "tandem/plugin/secret_key.h"

/// \file
/// Files of the key that one pair of sites shares: two lines of text, the first beginning with
/// "tandem-key-1", the second 64 hexadecimal digits. Not real-time safe; for set-up.
#pragma GCC visibility push(default)
namespace tandem {

/// Writes a new random key into a file that only its owner may read and write.
///
/// Throws std::invalid_argument if something of this name is there already (it is left alone) or
/// the name cannot be used, and tandem::Error if writing fails, with nothing left behind. The
/// message is one line and names the remedy.
void makeKeyFile(const std::filesystem::path& path);

/// The key in a file; symbolic links are followed. Throws std::invalid_argument, in one line with
/// the remedy, unless it is a regular file that group and others have no right to, of exactly the
/// form above.
[[nodiscard]] SecretKey readKeyFile(const std::filesystem::path& path);

}  // namespace tandem
#pragma GCC visibility pop
