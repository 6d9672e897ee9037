#pragma once

#include "replay/replay_clock.h"
#include "scenario/scenario.h"
#include "session/session.h"

namespace tandem::view {

/// Time, speed and numbers of a recorded run beside its picture. Needs Dear ImGui's frame.
class ReplayPanel {
 public:
  /// Shows the panel, and moves the clock as the user asks by it and by keys. True if the user
  /// wants a picture stored.
  [[nodiscard]] bool show(const demos::Scenario& scenario, const SessionLook& look,
                          ReplayClock& clock);

 private:
  static void showClock(ReplayClock& clock);
  static void showNumbers(const demos::Scenario& scenario, const SessionLook& look);

  bool shows_help_ = false;
};

}  // namespace tandem::view
