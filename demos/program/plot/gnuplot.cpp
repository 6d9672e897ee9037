#include "plot/gnuplot.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

namespace tandem::demos::plot {
namespace {

constexpr const char* kScriptFile = "script.gp";
constexpr const char* kLogFile = "gnuplot.log";
constexpr double kPngScale = 1.5;  // PNGs have more pixels than their layout, for sharp text

// What posix_spawn does in the child before gnuplot starts: work in `folder`, messages to a file.
class SpawnActions {
 public:
  explicit SpawnActions(const std::filesystem::path& folder) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, kLogFile,
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
  }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

// gnuplot's exit status; -1 when it cannot be started or was killed.
int runGnuplot(const std::filesystem::path& folder, const std::string& argument) {
  std::string program = "gnuplot";
  std::string defaults = "-d";  // leave the user's own start-up file out
  std::string last = argument;
  char* arguments[] = {program.data(), defaults.data(), last.data(), nullptr};
  const SpawnActions actions(folder);
  pid_t child = 0;
  if (posix_spawnp(&child, "gnuplot", actions.get(), nullptr, arguments, environ) != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string terminal(const Figure& figure, const std::string& type) {
  if (type == "svg")
    return fmt::format(
        "set terminal svg size {},{} dynamic noenhanced font 'sans-serif,14' background 'white'",
        figure.width, figure.height);
  return fmt::format(
      "set terminal pngcairo size {:.0f},{:.0f} noenhanced font 'sans-serif,10' fontscale {} "
      "linewidth {} pointscale {} background 'white'",
      figure.width * kPngScale, figure.height * kPngScale, kPngScale, kPngScale, kPngScale);
}

std::string scriptOf(const Figure& figure) {
  std::string script = "set encoding utf8\nset datafile missing 'NaN'\n" + figure.data;
  for (const std::string type : {"svg", "png"}) {
    script += fmt::format("{}\nset output {}\n", terminal(figure, type),
                          gnuplotText(fmt::format("{}.{}", figure.name, type)));
    script += fmt::format("set multiplot title {} font ',{}'\n", gnuplotText(figure.title),
                          type == "svg" ? 17 : 12);
    script += figure.commands + "unset multiplot\nset output\n";
  }
  return script;
}

std::string firstLine(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  while (line.empty() && std::getline(in, line)) {
  }
  return line;
}

}  // namespace

void writeText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error(fmt::format("{}: cannot be written: {}", file.string(), strerror(errno)));
}

void requireGnuplot(const std::filesystem::path& folder) {
  if (runGnuplot(folder, "--version") != 0)
    throw Error("gnuplot cannot be started; install it with `apt-get install gnuplot-nox`");
}

void drawFigure(const Figure& figure, const std::filesystem::path& folder) {
  if (!figure.svg.empty()) {
    writeText(folder / (figure.name + ".svg"), figure.svg);
    return;
  }
  writeText(folder / kScriptFile, scriptOf(figure));
  if (runGnuplot(folder, kScriptFile) != 0)
    throw Error(
        fmt::format("gnuplot could not draw {}: {}", figure.name, firstLine(folder / kLogFile)));
  std::filesystem::remove(folder / kScriptFile);
  std::filesystem::remove(folder / kLogFile);
}

}  // namespace tandem::demos::plot
