#include "tandem/falcon/gamepad_device.h"

#include <utility>

#include "tandem/falcon/monotonic_clock.h"

#include "gamepad/gamepad_hand.h"
#include "gamepad/gamepad_stream.h"

namespace tandem {
namespace {

constexpr double kLongestStall = 0.5;  // of the device's thread; its sticks are stale then [s]

}  // namespace

GamepadDevice::GamepadDevice(EventOpener open, const GamepadSettings& settings)
    : q_DW_(settings.q_WD.conjugate()),
      hand_(std::make_unique<GamepadHand>(settings)),
      stream_(std::make_unique<GamepadStream>(std::move(open), settings)) {
  q_DW_.normalize();
  capabilities_.name = "gamepad";
  capabilities_.max_force = settings.max_force;
  capabilities_.workspace = settings.workspace;
}

GamepadDevice::~GamepadDevice() = default;

const DeviceCapabilities& GamepadDevice::capabilities() const noexcept { return capabilities_; }

DeviceSample GamepadDevice::read(double now) noexcept {
  const GamepadStream::News& news = stream_->newest();
  buttons_.store(news.state.buttons, std::memory_order_relaxed);
  const bool is_stale = readMonotonicClock() - news.time > kLongestStall;
  if (!news.is_connected || is_stale) return hand_->stand(now);
  return hand_->advance(now, news.state, news.feel == Feel::kForce);
}

void GamepadDevice::write(const Vec3& f_W) noexcept {
  hand_->write(f_W);
  stream_->setForce(q_DW_ * f_W);
}

GamepadStatus GamepadDevice::status() {
  const GamepadStream::News& news = stream_->newest();
  return {news.state,      news.is_connected,  news.feel,
          stream_->name(), stream_->trouble(), stream_->counters()};
}

}  // namespace tandem
