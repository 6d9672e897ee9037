#pragma once

#include <string>
#include <vector>

#include "command/command.h"

namespace tandem::demos {

/// A program that is made of commands.
struct Program {
  std::string name;     ///< as it is typed
  std::string summary;  ///< first line of its --help
  std::vector<CommandEntry> commands;
};

/// All commands of this program; the build makes it from the files <name>_command.cpp.
[[nodiscard]] std::vector<CommandEntry> listCommands();

/// Runs the command that the arguments name, and returns the program's exit status. Errors are
/// printed to stderr in one line.
[[nodiscard]] int runProgram(Program program, int argc, char** argv) noexcept;

}  // namespace tandem::demos
