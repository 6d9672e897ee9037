#include "process.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

// No TOML library: this library is loaded into every child of a shell, and uses the C library only.
// The adaptor reads the whole file, and refuses a `process` that was read differently here.

namespace tandem::preload {
namespace {

constexpr std::size_t kMostOfFile = 64 * 1024;  // the key is near the beginning

const char* skipBlanks(const char* text) { return text + std::strspn(text, " \t"); }

/// Reads the value if the line is `process = "value"`.
bool readLine(const char* line, char* name, unsigned long size) {
  constexpr const char* kKey = "process";
  line = skipBlanks(line);
  if (std::strncmp(line, kKey, std::strlen(kKey)) != 0) return false;
  line = skipBlanks(line + std::strlen(kKey));
  if (*line++ != '=') return false;
  line = skipBlanks(line);
  const char quote = *line++;
  if (quote != '"' && quote != '\'') return false;
  unsigned long length = 0;
  while (line[length] != quote && line[length] != '\n' && line[length] != '\0') ++length;
  if (line[length] != quote || length >= size) return false;
  std::memcpy(name, line, length);
  name[length] = '\0';
  return true;
}

}  // namespace

const char* findConfig() noexcept {
  const char* config = std::getenv("TANDEM_PRELOAD");
  return config && *config ? config : nullptr;
}

const char* processName() noexcept { return program_invocation_short_name; }

bool findProcessKey(const char* text, char* name, unsigned long size) noexcept {
  while (text && *skipBlanks(text) != '[') {
    if (readLine(text, name, size)) return true;
    text = std::strchr(text, '\n');
    if (text) ++text;
  }
  return false;
}

bool isWanted(const char* config) noexcept {
  const int error = errno;
  // Without O_NONBLOCK a pipe would hold the host until it has a writer; the adaptor refuses pipes.
  const int file = open(config, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  auto* text = static_cast<char*>(std::malloc(kMostOfFile + 1));
  bool is_wanted = true;
  const ssize_t size = file >= 0 && text ? read(file, text, kMostOfFile) : -1;
  if (size >= 0) {
    text[size] = '\0';
    char name[256];
    if (findProcessKey(text, name, sizeof name)) is_wanted = !std::strcmp(name, processName());
  }
  std::free(text);
  if (file >= 0) close(file);
  errno = error;
  return is_wanted;
}

}  // namespace tandem::preload
