#include "plot/drawing.h"

#include <cerrno>

#include <fcntl.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tandem/coordination/scheme.h"
#include "tandem/coordination/types.h"

#include "files/own_folder.h"

namespace tandem::demos {
namespace {

namespace fs = std::filesystem;

// A command line that runs the package, without the package's own arguments.
struct Drawing {
  std::string python;
  std::string package;
};

// Exit status of a program; -1 if it cannot be started or a signal ended it.
int runAndWait(std::vector<std::string> command, bool is_silent) {
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (is_silent)
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string findPackage() {
  const fs::path main = findOwnData("plot/__main__.py");
  if (!main.empty()) return main.parent_path();
  throw Error(
      fmt::format("{}: the Python package that draws is neither here nor in {}; install "
                  "Tandem as a whole",
                  findOwnFolder().string(), TANDEM_DATA_FROM_PROGRAM));
}

Drawing findDrawing() {
  const char* const kCheck =
      "import sys, importlib.util as u; sys.exit(not all(map(u.find_spec, ['numpy', "
      "'matplotlib'])))";
  const std::string package = findPackage();
  for (const char* python : {"python3", "/usr/bin/python3"})
    if (runAndWait({python, "-c", kCheck}, true) == 0) return {python, package};
  throw Error(
      "no Python with matplotlib is here to draw figures; install it with `apt-get install "
      "python3-matplotlib`");
}

// -B keeps the package's folder unchanged.
int draw(const std::string& what, const std::vector<std::string>& arguments, bool is_silent) {
  const Drawing drawing = findDrawing();
  std::vector<std::string> command = {drawing.python, "-B", drawing.package, what};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return runAndWait(command, is_silent);
}

/// Draws the figures of one file into its folder.
void drawBeside(const std::string& what, const fs::path& json) {
  if (draw(what, {json.string()}, true) != 0)
    throw Error(
        fmt::format("{}: its figures could not be drawn; is the folder writable and the disk not "
                    "full?",
                    json.string()));
}

/// The program that draws films, beside this one; empty if it is not built.
std::string findFilmProgram() {
  std::error_code ignored;
  const fs::path program = findOwnFolder() / "tandem-view";
  return fs::exists(program, ignored) ? program.string() : "";
}

}  // namespace

void requireDrawing() { (void)findDrawing(); }

int plotRuns(const std::vector<std::string>& folders) {
  std::vector<std::string> schemes;
  for (const Scheme* scheme : allSchemes()) schemes.emplace_back(scheme->name());
  std::vector<std::string> arguments = {fmt::format("{}", fmt::join(schemes, ",")),
                                        findFilmProgram()};
  arguments.insert(arguments.end(), folders.begin(), folders.end());
  const int status = draw("runs", arguments, false);
  if (status < 0) throw Error("the drawing of figures was broken off");
  return status;
}

void drawBench(const fs::path& json) { drawBeside("bench", json); }

void drawAnalysis(const fs::path& json) { drawBeside("analysis", json); }

}  // namespace tandem::demos
