#pragma once

namespace tandem::preload {

/// One line on stderr, after "tandem preload: "; never on stdout, which may be the host's data.
/// Keeps errno.
[[gnu::format(printf, 1, 2)]] void say(const char* format, ...) noexcept;

}  // namespace tandem::preload
