#include "tandem/plugin/toml_text.h"

#include <cerrno>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tandem {
namespace {

/// Reads at most one byte more than allowed, which reveals a longer file. Returns false on an
/// error.
bool readAll(int file, std::string& text) {
  text.resize(kLargestToml + 1);
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = ::read(file, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  text.resize(size);
  return true;
}

}  // namespace

std::string readTomlText(const std::filesystem::path& path, const std::string& kind) {
  const auto refuse = [&](const std::string& fault) {
    throw std::invalid_argument(path.string() + ": " + fault);
  };
  // Without O_NONBLOCK, opening a pipe would wait for its writer.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  struct stat status {};
  const bool is_there = file >= 0 && ::fstat(file, &status) == 0 && !S_ISDIR(status.st_mode);
  const bool is_file = is_there && S_ISREG(status.st_mode);
  std::string text;
  const bool is_read = is_file && readAll(file, text);
  if (file >= 0) ::close(file);

  if (is_there && !is_file) refuse("is a device or a pipe; give the " + kind + " as a file");
  if (!is_read) refuse("cannot read this " + kind + "; is the path right?");
  if (text.size() > kLargestToml)
    refuse("is larger than 1 MiB, so it is no " + kind + "; is the path right?");
  requireShallowToml(text, path.string());
  return text;
}

void requireShallowToml(std::string_view text, const std::string& name) {
  if (const auto line = findDeepToml(text))
    throw std::invalid_argument(name + ":" + std::to_string(*line) + ": nests more than " +
                                std::to_string(kDeepestToml) +
                                " deep; use fewer dots and brackets inside one another");
}

}  // namespace tandem
