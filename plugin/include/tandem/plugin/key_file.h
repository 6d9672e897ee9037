#pragma once

#include <filesystem>

#include "tandem/plugin/secret_key.h"

/// \file
/// Files with the key that a pair of sites shares. A file has two lines of text: the first begins
/// with "tandem-key-1", the second has 64 hexadecimal digits. Not real-time safe; for set-up.
#pragma GCC visibility push(default)
namespace tandem {

/// Writes a new random key to a file that only its owner may read and write.
///
/// Throws std::invalid_argument if the name exists already (the file is left alone) or cannot be
/// used. Throws tandem::Error if writing fails, and leaves nothing behind. The message is one line
/// with the remedy.
void makeKeyFile(const std::filesystem::path& path);

/// Reads the key in a file; follows symbolic links. The file must be regular, closed to group and
/// others, and of exactly the form above. Throws std::invalid_argument otherwise, in one line with
/// the remedy.
[[nodiscard]] SecretKey readKeyFile(const std::filesystem::path& path);

}  // namespace tandem
#pragma GCC visibility pop
