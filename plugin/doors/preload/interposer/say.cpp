#include "say.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>

#include <unistd.h>

namespace tandem::preload {

void say(const char* format, ...) noexcept {
  const int error = errno;
  char line[1024] = "tandem preload: ";
  constexpr int kPrefix = 16;
  va_list values;
  va_start(values, format);
  int size = kPrefix + std::vsnprintf(line + kPrefix, sizeof line - kPrefix - 1, format, values);
  va_end(values);
  if (size > static_cast<int>(sizeof line) - 2) size = static_cast<int>(sizeof line) - 2;
  line[size++] = '\n';
  // One write() keeps the lines of several threads apart. A failure is ignored.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line, static_cast<size_t>(size));
  errno = error;
}

}  // namespace tandem::preload
