#pragma once

#include <cstdio>
#include <string_view>

#include "tandem/coordination/types.h"

namespace tandem::demos {

/// Flushes standard output; call it before reporting success. Throws Error.
inline void finishOutput() {
  if (std::fflush(stdout) != 0)
    throw Error("cannot write to the standard output: is its disk full?");
}

/// Writes text longer than the buffer, which may fail at once. Throws Error.
inline void writeOutput(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    throw Error("cannot write to the standard output: is its disk full?");
  finishOutput();
}

}  // namespace tandem::demos
