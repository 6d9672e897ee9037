#include "command/start_program.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

#include "files/own_folder.h"

namespace tandem::demos {

void startProgram(const std::string& name, std::vector<std::string> first, char** arguments,
                  const std::string& remedy) {
  std::string program = findOwnFolder() / name;
  std::vector<char*> all = {program.data()};
  for (std::string& argument : first) all.push_back(argument.data());
  for (; *arguments; ++arguments) all.push_back(*arguments);
  all.push_back(nullptr);
  execv(program.c_str(), all.data());
  throw Error(fmt::format("{}: cannot be started: {}; {}", program, std::strerror(errno), remedy));
}

}  // namespace tandem::demos
