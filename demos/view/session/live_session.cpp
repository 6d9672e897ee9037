#include "session/live_session.h"

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::view {
namespace {

/// From the start of the threads to the first tick [s].
constexpr double kGetReady = 0.02;

}  // namespace

void startHandsAt(const SessionPlaces& places, demos::Scenario& scenario) {
  const demos::SceneFrame frame = demos::makeSceneFrame(scenario);
  for (int user : {0, 1}) {
    const auto at = static_cast<std::size_t>(user);
    const Vec3 away_W = places.hands_W[at] - demos::computeStart(scenario, frame, user);
    scenario.hands[at].start_offset += frame.toScene(away_W);
  }
}

LiveSession::LiveSession(const demos::Scenario& scenario, HapticDevice& device,
                         const demos::BodyPlaces& places)
    : network_(scenario.network),
      own_(scenario, 0, network_.end(0), device, places),
      other_(scenario, 1, network_.end(1), places),
      scene_look_(own_),
      host_rate_(scenario.host_rate),
      may_hold_(scenario.mayGrip()) {
  lookAtWorlds(0.0);
  begin_ = readMonotonicClock() + kGetReady;
  HapticLoopSettings settings;
  settings.begin = begin_;
  loops_[0] = std::make_unique<HapticLoop>(own_.site(), settings);
  loops_[1] = std::make_unique<HapticLoop>(other_.site(), settings);
  network_.start(begin_);
  host_ = std::jthread([this](const std::stop_token& stop) { stepWorlds(stop); });
}

LiveSession::~LiveSession() { stop(); }

void LiveSession::stop() noexcept {
  if (!host_.joinable()) return;
  host_.request_stop();
  host_.join();
  for (auto& loop : loops_) loop->stop();
}

SessionPlaces LiveSession::end() {
  stop();
  return {{own_.site().hip().p_W, other_.site().hip().p_W}, own_.places()};
}

void LiveSession::stepWorlds(const std::stop_token& stop) {
  for (std::uint64_t step = 1; !stop.stop_requested(); ++step) {
    const double time = static_cast<double>(step) / host_rate_;
    sleepUntil(begin_ + time);
    own_.stepHostUntil(time);
    other_.stepHostUntil(time);
    if (may_hold_) own_.hold(wantsHold());
    if (isLookDue(time)) lookAtWorlds(time);
  }
}

void LiveSession::lookAtWorlds(double time) {
  const auto look = std::make_shared<SessionLook>();
  look->time = time;
  look->list = scene_look_.look(details());
  look->apart = addGhosts(look->list, other_);
  lookAt(own_.site(), *look);
  if (loops_[0]) look->loop = loops_[0]->report();
  publish(look);
}

}  // namespace tandem::view
