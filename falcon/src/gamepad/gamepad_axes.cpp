#include "gamepad/gamepad_axes.h"

#include <algorithm>
#include <cmath>

#include <linux/input-event-codes.h>

namespace tandem {
namespace {

constexpr std::array<std::uint16_t, 7> kCodes = {ABS_X,  ABS_Y,  ABS_Z,    ABS_RX,
                                                 ABS_RY, ABS_RZ, ABS_HAT0Y};
constexpr double kEnd = 0.9;          // from here on a place counts as an end of the range
constexpr std::uint16_t kBlock = 16;  // buttons of a joystick, and of a gamepad

}  // namespace

double GamepadAxes::Place::part() const noexcept {
  if (!is_there) return 0.0;
  return std::clamp(2.0 * (value - low) / (high - low) - 1.0, -1.0, 1.0);
}

bool GamepadAxes::Place::isCentred() const noexcept { return is_there && std::abs(part()) < kEnd; }

bool GamepadAxes::Place::isAtLowEnd() const noexcept { return is_there && part() <= -kEnd; }

GamepadAxes::GamepadAxes(EventPort& port) noexcept {
  static_assert(kCodes.size() == kAxes);
  for (std::size_t i = 0; i < kAxes; ++i) {
    const std::optional<EventAxis> axis = port.readAxis(kCodes[i]);
    if (!axis || axis->low >= axis->high) continue;
    axes_[i] = {true, static_cast<double>(axis->low), static_cast<double>(axis->high),
                static_cast<double>(axis->value)};
  }
  readAll(port);
  chooseRoles(port.feel());
}

/// A stick with force has one upright axis, its hat: others are pedals and levers.
void GamepadAxes::chooseRoles(Feel feel) noexcept {
  has_back_ = axes_[kY].is_there;
  if (feel == Feel::kForce) {
    has_back_ = axes_[kY].isCentred();
    return;
  }
  if (axes_[kRy].isCentred())
    down_ = kRy;
  else if (axes_[kRz].isCentred())
    down_ = kRz;
  has_triggers_ = axes_[kZ].isAtLowEnd() && axes_[kRz].isAtLowEnd();
}

void GamepadAxes::readAll(EventPort& port) noexcept {
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!axes_[i].is_there) continue;
    if (const auto axis = port.readAxis(kCodes[i])) axes_[i].value = axis->value;
  }
  buttons_ = 0;
  for (std::uint16_t i = 0; i < kBlock; ++i) {
    const auto joystick = static_cast<std::uint16_t>(BTN_JOYSTICK + i);
    const auto gamepad = static_cast<std::uint16_t>(BTN_GAMEPAD + i);
    if (port.readKey(joystick) || port.readKey(gamepad)) setButton(gamepad, true);
  }
}

GamepadNews GamepadAxes::take(const InputEvent& event) noexcept {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) is_lost_ = true;
  if (event.type == EV_SYN && event.code == SYN_REPORT) {
    const bool was_lost = is_lost_;
    is_lost_ = false;
    return was_lost ? GamepadNews::kLost : GamepadNews::kReport;
  }
  if (is_lost_) return GamepadNews::kPart;
  if (event.type == EV_KEY) setButton(event.code, event.value != 0);
  if (event.type == EV_ABS)
    if (const auto axis = findAxis(event.code)) axes_[*axis].value = event.value;
  return GamepadNews::kPart;
}

std::optional<std::size_t> GamepadAxes::findAxis(std::uint16_t code) noexcept {
  const auto found = std::find(kCodes.begin(), kCodes.end(), code);
  if (found == kCodes.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kCodes.begin());
}

void GamepadAxes::setButton(std::uint16_t code, bool is_pressed) noexcept {
  if (code < BTN_JOYSTICK || code >= BTN_GAMEPAD + kBlock) return;
  const std::uint32_t bit = 1U << (code % kBlock);
  buttons_ = is_pressed ? buttons_ | bit : buttons_ & ~bit;
}

double GamepadAxes::computeUp() const noexcept {
  double up = -axes_[kHat].part();
  if (down_ != kAxes) up -= axes_[down_].part();
  if (has_triggers_) up += 0.5 * (axes_[kRz].part() - axes_[kZ].part());
  return std::clamp(up, -1.0, 1.0);
}

GamepadState GamepadAxes::state() const noexcept {
  return {{axes_[kX].part(), computeUp(), has_back_ ? axes_[kY].part() : 0.0}, buttons_};
}

}  // namespace tandem
