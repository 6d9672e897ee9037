#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

#include "command/command.h"

namespace tandem::demos {
namespace {

constexpr const char* kProgram =
    TANDEM_BULLET_SCALAR_BYTES == 8 ? "tandem-bench" : "tandem-bench-float";

/// Replaces this process by the program of the benchmarks, which is beside this one.
[[noreturn]] void startBench(char** arguments) {
  std::error_code ignored;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", ignored);
  std::string program = own.parent_path() / kProgram;
  std::vector<char*> all = {program.data()};
  for (; *arguments; ++arguments) all.push_back(*arguments);
  all.push_back(nullptr);
  execv(program.c_str(), all.data());
  throw Error(fmt::format(
      "{}: cannot be started: {}; build the target {}, or install it beside this program", program,
      std::strerror(errno), kProgram));
}

}  // namespace

CommandEntry benchCommand() { return {"bench", "measure on this machine", 3, nullptr, startBench}; }

}  // namespace tandem::demos
