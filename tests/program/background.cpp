#include "program/background.h"

#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tandem::test {

Background::Background(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("cannot start a process");
  if (child_ == 0) {
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);  // no process is left if a test crashes
    if (dup2(ends[1], STDERR_FILENO) < 0 || dup2(ends[1], STDOUT_FILENO) < 0) _exit(126);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  close(ends[1]);
  output_ = ends[0];
}

Background::~Background() {
  if (child_ > 0) {
    kill(child_, SIGKILL);
    (void)waitpid(child_, nullptr, 0);
  }
  close(output_);
}

bool Background::readMore() {
  pollfd wanted{output_, POLLIN, 0};
  if (poll(&wanted, 1, 60'000) != 1) throw std::runtime_error("the program says nothing");
  char text[4096];
  const ssize_t got = read(output_, text, sizeof text);
  if (got > 0) unread_.append(text, static_cast<std::size_t>(got));
  return got > 0;
}

std::string Background::readLine() {
  std::size_t end = unread_.find('\n');
  while (end == std::string::npos) {
    if (!readMore()) throw std::runtime_error("the program ended: " + unread_);
    end = unread_.find('\n');
  }
  const std::string line = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  return line;
}

Outcome Background::finish(int signal) {
  if (signal != 0) kill(child_, signal);
  while (readMore()) {
  }
  int status = 0;
  if (waitpid(child_, &status, 0) != child_) throw std::runtime_error("lost a child process");
  child_ = -1;
  Outcome outcome;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.out = unread_;
  return outcome;
}

}  // namespace tandem::test
