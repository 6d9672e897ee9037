#include "session/session_records.h"

#include <cstdio>

#include <fmt/format.h>

#include "tandem/coordination/types.h"

#include "terminal/usage_error.h"

namespace tandem::view {

SessionRecords::SessionRecords(const std::filesystem::path& run, int site)
    : run_(run), part_{site} {
  open(run_);
}

void SessionRecords::open(const std::filesystem::path& folder) {
  next_.emplace(folder, "--record " + folder.string(), part_);
}

void SessionRecords::store(const std::function<void(const demos::OutputFolder&)>& publish) {
  const std::string name =
      count_ == 0 ? run_.string() : fmt::format("{}-{}", run_.string(), count_ + 1);
  try {
    if (!next_) open(name);
  } catch (const demos::UsageError& error) {
    throw Error(error.what());  // the session is over, whoever may use the folder
  }
  publish(*next_);
  next_.reset();
  ++count_;
  fmt::print("{}\n", name);
  std::fflush(stdout);
}

}  // namespace tandem::view
