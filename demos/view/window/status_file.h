#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "session/pace.h"
#include "session/session.h"

namespace tandem::view {

/// A file with one JSON object a line, every 0.1 s, for programs that drive the window: time,
/// world, scheme, contact, paused, speed, force, hip, object, apart, status, skipped, frames. For a
/// spectator also followed, a site, and users.
class StatusFile {
 public:
  /// Throws Error if the file cannot be written.
  explicit StatusFile(const std::filesystem::path& file);

  /// `time` is the monotonic clock's [s].
  void note(const demos::Scenario& scenario, const Pace& pace, const SessionLook& look, double time,
            std::uint64_t frames);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  double next_ = 0.0;
};

}  // namespace tandem::view
