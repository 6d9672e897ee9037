#pragma once

#include <cstdio>
#include <string_view>

#include "tandem/coordination/types.h"

namespace tandem::demos {

/// What was printed must be out before a program says that all went well. Throws Error.
inline void finishOutput() {
  if (std::fflush(stdout) != 0)
    throw Error("cannot write to the standard output: is its disk full?");
}

/// For text longer than the buffer, which may fail at once. Throws Error.
inline void writeOutput(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
    throw Error("cannot write to the standard output: is its disk full?");
  finishOutput();
}

}  // namespace tandem::demos
