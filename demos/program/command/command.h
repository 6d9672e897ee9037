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

  /// Declares the arguments that the command takes.
  virtual void declare(Arguments& arguments) = 0;

  /// Runs with the arguments as they were parsed. Throws UsageError or std::invalid_argument for
  /// bad use, and any other std::exception for what went wrong; each has one line with the remedy.
  virtual ExitStatus run() = 0;
};

template <class Kind>
[[nodiscard]] std::unique_ptr<Command> makeCommand() {
  return std::make_unique<Kind>();
}

/// How a command is listed and started. The file <name>_command.cpp in the command's folder defines
/// `CommandEntry <name>Command()`; the build makes the table of all commands from these files.
struct CommandEntry {
  std::string name;     ///< as it is typed
  std::string summary;  ///< its line in --help
  int place = 0;        ///< its place in lists, lowest first
  std::unique_ptr<Command> (*make)() = nullptr;
  /// Instead of make: becomes a program of its own, which gets the arguments behind the name.
  void (*start)(char** arguments) = nullptr;
};

}  // namespace tandem::demos
