#pragma once

#include <functional>
#include <vector>

namespace tandem::demos::bench {

class GuestWorld;

/// Holds all that was done to a bare world in a frame, so that others can get the same.
struct GuestFrame {
  using Deed = std::function<void(GuestWorld&)>;
  double time = 0.0;                ///< at its begin [s]
  std::vector<Deed> before, after;  ///< the step
  std::vector<Deed> within;         ///< in the host's own callback of the first sub-step
};

/// Frame by frame.
using GuestJournal = std::vector<GuestFrame>;

}  // namespace tandem::demos::bench
