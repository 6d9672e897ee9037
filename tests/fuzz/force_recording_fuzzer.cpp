// Recorded hand forces give finite rows with growing times, or a tandem::Error of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "simulated/force_recording.h"

namespace tandem::falcon_detail {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// A file in memory that exists as long as this object.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("fuzz", 0)) {
    require(descriptor_ >= 0);
    require(write(descriptor_, data, size) == static_cast<ssize_t>(size));
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void requireSound(const std::vector<ForceRow>& rows) {
  require(!rows.empty());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    require(std::isfinite(rows[i].t) && rows[i].f_W.allFinite());
    require(rows[i].f_W.cwiseAbs().maxCoeff() <= 1e6);
    require(i == 0 || rows[i].t > rows[i - 1].t);
  }
}

void read(const MemoryFile& file) {
  try {
    requireSound(readForceRecording(file.path()));
  } catch (const Error& error) {
    require(std::string_view(error.what()).starts_with(file.path()));
    require(std::string_view(error.what()).find_first_of("\n\r") == std::string_view::npos);
  }
}

}  // namespace
}  // namespace tandem::falcon_detail

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tandem::falcon_detail::read(tandem::falcon_detail::MemoryFile(data, size));
  return 0;
}
