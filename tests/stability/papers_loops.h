#pragma once

#include "tandem/coordination/stability.h"

namespace tandem::test {

/// Experiment I of the paper: one shared cube, 50 ms.
inline LoopSettings makeFirstExperiment(StandInKind stand_in) {
  LoopSettings settings;
  settings.stand_in = stand_in;
  return settings;
}

/// Experiment II: users push each other, 100 ms.
inline LoopSettings makeSecondExperiment(StandInKind stand_in) {
  LoopSettings settings;
  settings.stand_in = stand_in;
  settings.has_object = false;
  settings.contact = {2000.0, 1.0};
  settings.coordination = {200.0, 10.0};
  settings.delay = 0.1;
  return settings;
}

}  // namespace tandem::test
