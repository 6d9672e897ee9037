#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "files/output_folder.h"

namespace tandem::view {

/// Folders for the records of a window's sessions, one after the other: RUN, RUN-2, RUN-3. For one
/// thread at a time.
class SessionRecords {
 public:
  /// `site` is the one that is here alone, from 1; 0: all are. Throws UsageError if RUN is not
  /// writable or in use.
  SessionRecords(const std::filesystem::path& run, int site);

  /// Lets `publish` fill the next folder, and prints its name. Throws what `publish` throws, and
  /// Error if a later folder is not writable or in use.
  void store(const std::function<void(const demos::OutputFolder&)>& publish);
  /// Folders that were filled.
  [[nodiscard]] int count() const noexcept { return count_; }

 private:
  void open(const std::filesystem::path& folder);

  std::filesystem::path run_;
  demos::FolderPart part_;
  std::optional<demos::OutputFolder> next_;  ///< the first is there before anything is recorded
  int count_ = 0;
};

}  // namespace tandem::view
