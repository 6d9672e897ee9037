#pragma once

#include <memory>
#include <string>

#include "command/arguments.h"

namespace tandem::demos {

/// Exit statuses of the programs.
enum ExitStatus : int { kDone = 0, kFailed = 1, kBadUse = 2, kCheckFailed = 3 };

/// One command of a program, such as `tandem run`.
class Command {
 public:
  virtual ~Command() = default;

  /// Declares the arguments of the command.
  virtual void declare(Arguments& arguments) = 0;

  /// Runs with the parsed arguments. Throws UsageError or std::invalid_argument for bad use, and
  /// any other std::exception for other failures. Each has one line with the remedy.
  virtual ExitStatus run() = 0;
};

template <class Kind>
[[nodiscard]] std::unique_ptr<Command> makeCommand() {
  return std::make_unique<Kind>();
}

/// Name, help and factory of a command. The file <name>_command.cpp in the command's folder defines
/// `CommandEntry <name>Command()`. The build generates the table of all commands from these files.
struct CommandEntry {
  std::string name;     ///< name as typed
  std::string summary;  ///< its line in --help
  int place = 0;        ///< place in lists, lowest first
  std::unique_ptr<Command> (*make)() = nullptr;
  /// Used instead of `make` if set: runs another program with the arguments after the name.
  void (*start)(char** arguments) = nullptr;
};

}  // namespace tandem::demos
