#pragma once

#include "tandem/falcon/mouse_device.h"

#include "gl/eye_motion.h"

struct GLFWwindow;

namespace tandem::view {

/// The mouse in a window: moves the hand, and with the right or middle button the eye.
///
///   move                      the hand, in the level plane; with Shift in the upright one
///   wheel                     the hand along the plane's normal; with the right button: zoom
///   right, middle button      turn, shift the eye
///   left button               hold an object
///   G                         the hand stays, or goes on
class HandInput {
 public:
  /// Takes the window's callbacks. Dear ImGui's come later and call these.
  explicit HandInput(GLFWwindow* window);
  ~HandInput();
  HandInput(const HandInput&) = delete;
  HandInput& operator=(const HandInput&) = delete;

  /// Moves the hand and the eye by what happened since the last call at `time` [s]. `mouse` may be
  /// null: then another device is in the user's hand. With `is_free` false the pointer is on the
  /// panel, and moves neither.
  void apply(MouseDevice* mouse, Eye& eye, PictureSize size, double time, bool is_free);

  /// True while the user wants to hold something.
  [[nodiscard]] bool wantsHold() const noexcept { return wants_hold_; }

 private:
  void moveHand(MouseDevice& mouse, const Eye& eye, PictureSize size, double time);

  GLFWwindow* window_;
  PicturePoint pointer_, last_pointer_;
  double wheel_ = 0.0;  ///< notches since the last apply()
  bool stays_ = false, wants_hold_ = false;
};

}  // namespace tandem::view
