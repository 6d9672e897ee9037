#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/guest/guest_run.h"

namespace tandem::demos::bench {

struct GuestOptions {
  std::uint64_t seed = 1;
  std::uint64_t cases = 10000;
  int workers = 2;  ///< number of processes
};

/// Result of `tandem bench guest`.
struct GuestResult {
  GuestOptions options;
  std::vector<GuestOutcome> outcomes;  ///< ordered by index
  double seconds = 0.0;

  [[nodiscard]] std::size_t countFailed() const;
};

/// Draws and runs all cases in worker processes. Throws tandem::Error if no process can be started.
[[nodiscard]] GuestResult measureGuest(const GuestOptions& options,
                                       const std::function<void(double)>& progress);

/// The case with as few acts as still fail in the same way.
[[nodiscard]] GuestCase reduceGuestCase(GuestCase one);

/// Table of failures, and a line to repeat each of the first.
[[nodiscard]] std::string makeGuestTable(const GuestResult& result);

/// guest.json.
[[nodiscard]] std::string makeGuestJson(const GuestResult& result);

}  // namespace tandem::demos::bench
