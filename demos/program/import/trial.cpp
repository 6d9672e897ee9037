#include "import/trial.h"

#include <cerrno>
#include <exception>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr rlim_t kLongest = 20;  // of processor time [s]

/// The child says nothing, leaves no core, and ends here.
[[noreturn]] void runQuietly(const std::function<void()>& import) {
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const rlimit no_core{0, 0}, time{kLongest, kLongest};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &time);
  try {
    import();
  } catch (const std::exception&) {
    // The parent meets the same, and reports it.
  }
  _exit(0);
}

}  // namespace

void tryInChild(const std::filesystem::path& file, const std::string& format,
                const std::function<void()>& import) {
  const pid_t child = fork();
  if (child < 0)
    throw UsageError(file.string() + ": no process to try it in; end some programs and try again");
  if (child == 0) runQuietly(import);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno == EINTR) continue;
    throw UsageError(file.string() + ": lost the process that tried it; try again");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw UsageError(file.string() + ": damaged: the reader of " + format +
                   " cannot go through it; export it again");
}

}  // namespace tandem::demos
