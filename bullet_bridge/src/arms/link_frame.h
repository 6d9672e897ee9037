#pragma once

#include <cstddef>

#include "arms/arm_model.h"
#include "joints/joint_settings.h"

namespace tandem {

/// A frame of a link, seen from the body that the link is a part of. Real-time safe.
[[nodiscard]] inline JointFrame moveToCarrier(const ArmModel& model, std::size_t place,
                                              JointFrame frame) noexcept {
  for (; model.links()[place].role == LinkRole::kFrame; place = model.links()[place].parent) {
    const ArmLink& link = model.links()[place];
    frame.p = link.e + link.q_PZ * (link.d + frame.p);
    frame.axes = link.q_PZ.toRotationMatrix() * frame.axes;
  }
  return frame;
}

}  // namespace tandem
