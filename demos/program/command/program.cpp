#include "command/program.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

ExitStatus runCommand(const Program& program, int argc, char** argv) {
  for (const CommandEntry& entry : program.commands)
    if (entry.start && argc > 1 && entry.name == argv[1]) entry.start(argv + 2);

  CommandLine line(program.name, program.summary);
  std::vector<std::unique_ptr<Command>> commands;
  for (const CommandEntry& entry : program.commands) {
    Arguments& arguments = line.arguments().command(entry.name, entry.summary);
    commands.push_back(entry.make ? entry.make() : nullptr);
    if (commands.back()) commands.back()->declare(arguments);
  }
  if (!line.parse(argc, argv)) return kDone;
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (commands[i] && line.arguments().has(program.commands[i].name)) return commands[i]->run();
  return kDone;
}

/// Prints one line, whatever file names and values the message quotes.
ExitStatus reportError(std::string message, ExitStatus status) {
  std::replace_if(
      message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; },
      ' ');
  std::fprintf(stderr, "tandem: %s\n", message.c_str());
  return status;
}

}  // namespace

int runProgram(Program program, int argc, char** argv) noexcept {
  std::ranges::sort(program.commands, {}, &CommandEntry::place);
  try {
    return runCommand(program, argc, argv);
  } catch (const UsageError& error) {
    return reportError(error.what(), kBadUse);
  } catch (const std::invalid_argument& error) {
    return reportError(error.what(), kBadUse);
  } catch (const std::exception& error) {
    return reportError(error.what(), kFailed);
  }
}

}  // namespace tandem::demos
