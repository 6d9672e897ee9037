#include "window/hand_input.h"

#include <cmath>

#include <GLFW/glfw3.h>

namespace tandem::view {
namespace {

constexpr double kTurnPerPixel = 0.006;  // [rad]
constexpr double kZoomPerNotch = 0.9;

HandInput& inputOf(GLFWwindow* window) {
  return *static_cast<HandInput*>(glfwGetWindowUserPointer(window));
}

bool isPressed(GLFWwindow* window, int button) {
  return glfwGetMouseButton(window, button) == GLFW_PRESS;
}

bool isShifted(GLFWwindow* window) {
  return glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
         glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
}

}  // namespace

HandInput::HandInput(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, this);
  glfwSetInputMode(window, GLFW_STICKY_KEYS, GLFW_TRUE);  // a short press in a long frame counts
  glfwSetScrollCallback(window, [](GLFWwindow* of, double, double notches) {
    if (std::isfinite(notches)) inputOf(of).wheel_ += notches;
  });
  glfwSetKeyCallback(window, [](GLFWwindow* of, int key, int, int action, int) {
    if (key == GLFW_KEY_G && action == GLFW_PRESS) inputOf(of).stays_ = !inputOf(of).stays_;
  });
  glfwGetCursorPos(window, &pointer_.x, &pointer_.y);
}

HandInput::~HandInput() { glfwSetWindowUserPointer(window_, nullptr); }

void HandInput::apply(MouseDevice* mouse, Eye& eye, PictureSize size, double time, bool is_free) {
  last_pointer_ = pointer_;
  glfwGetCursorPos(window_, &pointer_.x, &pointer_.y);
  const PicturePoint moved{pointer_.x - last_pointer_.x, pointer_.y - last_pointer_.y};
  const bool turns = isPressed(window_, GLFW_MOUSE_BUTTON_RIGHT);
  const bool shifts = isPressed(window_, GLFW_MOUSE_BUTTON_MIDDLE);
  wants_hold_ = is_free && isPressed(window_, GLFW_MOUSE_BUTTON_LEFT);
  if (is_free && turns) {
    eye = orbitEye(eye, -kTurnPerPixel * moved.x, kTurnPerPixel * moved.y);
    eye = zoomEye(eye, std::pow(kZoomPerNotch, wheel_));
  } else if (is_free && shifts) {
    eye = panEye(eye, size, moved.x, moved.y);
  } else if (mouse) {
    const bool stays = stays_ || !is_free || !glfwGetWindowAttrib(window_, GLFW_HOVERED);
    if (!stays && (moved.x != 0.0 || moved.y != 0.0 || wheel_ != 0.0))
      moveHand(*mouse, eye, size, time);
  }
  wheel_ = 0.0;
}

void HandInput::moveHand(MouseDevice& mouse, const Eye& eye, PictureSize size, double time) {
  const Vec3 eye_W = computeEyePosition(eye);
  PointerPlane plane = makeLevelPlane(mouse.target());
  if (isShifted(window_))
    if (const auto upright = makeUprightPlane(mouse.target(), -computeEyeAxes(eye).back_W))
      plane = *upright;
  if (wheel_ != 0.0)
    if (const auto target = computeWheelTarget(plane, eye_W, wheel_, mouse.reach()))
      plane.p_W = *target;
  const auto ray = computeRay(eye, size, pointer_);
  if (!ray) return;
  const auto target = computePointerTarget(*ray, plane, mouse.reach());
  if (target) mouse.moveTo(*target, time);
}

}  // namespace tandem::view
