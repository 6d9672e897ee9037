#include "island/follow_faces.h"

namespace tandem {

double followFace(IslandModel& model, const States& states, Touch& touch, double reach) noexcept {
  const SphereContact found = computeTouchState(model, touch, states).geometry;
  const bool is_kept = found.gap < reach && found.under >= 0 &&
                       model.faces.keep(keyOf(model, touch), found.under, found.gap);
  touch.touched = is_kept ? found.under : -1;
  return found.gap;
}

}  // namespace tandem
