#pragma once

#include <string>
#include <vector>

namespace tandem::demos {

/// Replaces this process by a program that is beside it, with `first` and then `arguments`, which
/// end with null. Throws Error if it cannot be started; `remedy` says what to do then.
[[noreturn]] void startProgram(const std::string& name, std::vector<std::string> first,
                               char** arguments, const std::string& remedy);

}  // namespace tandem::demos
