#pragma once

#include "tandem/falcon/mouse_device.h"

#include "session/scene_look.h"

namespace tandem::view {

/// Draws the user's own hand in each picture.
class HandLook {
 public:
  /// `radius` of the hand's ball [m].
  explicit HandLook(double radius) : ball_(makeBall(radius)), cursor_(makeBall(0.3 * radius)) {}

  /// With a mouse the handle, the cursor and the stretch between them, which turns red where the
  /// hand gives no more force. Without one the hand `p_W` of another device, and its force.
  void add(DrawList& list, MouseDevice* mouse, const Vec3& p_W, const Vec3& f_W) const {
    if (!mouse) return addHand(list, ball_, p_W, f_W, kOwnColour);
    const MouseView view = mouse->view();
    const Colour colour = view.is_slack ? kSlackColour : kOwnColour;
    addHand(list, ball_, view.handle_W, view.force_W, kOwnColour);
    addHand(list, cursor_, view.cursor_W, Vec3::Zero(), colour);
    list.lines.push_back({view.handle_W, view.cursor_W, colour, kLineWidth});
  }

 private:
  static constexpr Colour kSlackColour{0.85F, 0.1F, 0.1F};
  static constexpr float kLineWidth = 1.5F;  // [pixel]

  std::shared_ptr<const ShapeMesh> ball_, cursor_;
};

}  // namespace tandem::view
