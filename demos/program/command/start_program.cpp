#include "command/start_program.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

namespace tandem::demos {

void startProgram(const std::string& name, std::vector<std::string> first, char** arguments,
                  const std::string& remedy) {
  std::error_code ignored;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", ignored);
  std::string program = own.parent_path() / name;
  std::vector<char*> all = {program.data()};
  for (std::string& argument : first) all.push_back(argument.data());
  for (; *arguments; ++arguments) all.push_back(*arguments);
  all.push_back(nullptr);
  execv(program.c_str(), all.data());
  throw Error(fmt::format("{}: cannot be started: {}; {}", program, std::strerror(errno), remedy));
}

}  // namespace tandem::demos
