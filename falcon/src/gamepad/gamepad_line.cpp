#include "gamepad/gamepad_line.h"

#include <array>
#include <utility>

#include "tandem/coordination/types.h"

#include "gamepad/feel_effect.h"

namespace tandem {
namespace {

constexpr std::size_t kEventsAtOnce = 64;

std::unique_ptr<EventPort> checked(std::unique_ptr<EventPort> port) {
  if (!port) throw Error("the gamepad's opener gave no port");
  return port;
}

}  // namespace

GamepadLine::GamepadLine(std::unique_ptr<EventPort> port)
    : port_(checked(std::move(port))), axes_(*port_), player_(*port_), state_(axes_.state()) {
  if (!axes_.hasStick())
    throw Error(name() + " has no stick; give a gamepad, see tandem device list");
}

GamepadLine::Heard GamepadLine::listen(double wait) noexcept {
  std::array<InputEvent, kEventsAtOnce> events;
  const std::ptrdiff_t count = port_->read(events.data(), events.size(), wait);
  Heard heard;
  heard.is_gone = count < 0;
  for (std::ptrdiff_t i = 0; i < count; ++i) takeEvent(events[static_cast<std::size_t>(i)], heard);
  return heard;
}

void GamepadLine::takeEvent(const InputEvent& event, Heard& heard) noexcept {
  const GamepadNews news = axes_.take(event);
  if (news == GamepadNews::kPart) return;
  if (news == GamepadNews::kLost) {
    axes_.readAll(*port_);
    ++heard.dropped;
  }
  state_ = axes_.state();
  ++heard.reports;
}

FeelNews GamepadLine::render(const Vec3& f_D, double max_force, double now) noexcept {
  return player_.show(makeFeelEffect(feel(), f_D, max_force), now);
}

}  // namespace tandem
