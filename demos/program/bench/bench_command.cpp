#include <fmt/format.h>

#include "command/command.h"
#include "command/start_program.h"

namespace tandem::demos {
namespace {

constexpr const char* kProgram =
    TANDEM_BULLET_SCALAR_BYTES == 8 ? "tandem-bench" : "tandem-bench-float";

/// The program of the benchmarks.
[[noreturn]] void startBench(char** arguments) {
  startProgram(kProgram, {}, arguments,
               fmt::format("build the target {}, or install it beside this program", kProgram));
}

}  // namespace

CommandEntry benchCommand() { return {"bench", "measure on this machine", 3, nullptr, startBench}; }

}  // namespace tandem::demos
