#pragma once

#include <string>
#include <vector>

#include "command/command.h"

namespace tandem::demos {

/// A program with commands.
struct Program {
  std::string name;     ///< name as typed
  std::string summary;  ///< first line of its --help
  std::vector<CommandEntry> commands;
};

/// All commands of this program. The build generates it from the files <name>_command.cpp.
[[nodiscard]] std::vector<CommandEntry> listCommands();

/// Runs the command named by the arguments, and returns the program's exit status. Prints errors to
/// stderr in one line.
[[nodiscard]] int runProgram(Program program, int argc, char** argv) noexcept;

}  // namespace tandem::demos
