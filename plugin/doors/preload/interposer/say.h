#pragma once

namespace tandem::preload {

/// Prints one line on stderr after "tandem preload: ". stdout may carry the host's data. Keeps
/// errno.
[[gnu::format(printf, 1, 2)]] void say(const char* format, ...) noexcept;

}  // namespace tandem::preload
