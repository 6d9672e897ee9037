#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace tandem::demos {

/// Runs `import` in a child process first, as readers of other projects crash on some damaged
/// files. Returns if the child came to its end, whatever it threw. Throws UsageError that names the
/// file and the format if it crashed, or did not end within 20 s of processor time.
void tryInChild(const std::filesystem::path& file, const std::string& format,
                const std::function<void()>& import);

}  // namespace tandem::demos
