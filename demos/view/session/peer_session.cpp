#include "session/peer_session.h"

namespace tandem::view {

PeerSession::PeerSession(const demos::Scenario& scenario, const demos::PeerLine& line,
                         HapticDevice& device)
    : patience_(line.patience),
      run_(scenario, line.site - 1, demos::makeMeshSettings(line, scenario),
           demos::makeOtherSite(line), &device, {}, demos::PeerPurpose::kSession) {
  lookAtWorld(0.0, nullptr);
  thread_ = std::jthread([this](const std::stop_token& stop) { live(stop); });
}

PeerSession::~PeerSession() = default;

std::vector<std::string> PeerSession::notes() const {
  const std::lock_guard lock(mutex_);
  return notes_;
}

bool PeerSession::goesOn() const {
  const std::lock_guard lock(mutex_);
  if (problem_) std::rethrow_exception(problem_);
  return !has_ended_;
}

void PeerSession::live(const std::stop_token& stop) {
  const auto asks = [&] { return stop.stop_requested(); };
  const auto report = [](const demos::PeerReport&) {};
  const auto note = [&](const std::string& line) {
    const std::lock_guard lock(mutex_);
    notes_.push_back(line);
  };
  const auto look = [&](double time, const HapticLoop& loop) {
    run_.world().hold(wantsHold());
    if (isLookDue(time)) lookAtWorld(time, &loop);
  };
  try {
    if (run_.waitForPeer(patience_, asks, report)) {
      scene_look_.reset();
      run_.run(asks, report, note, look);
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    problem_ = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
}

void PeerSession::lookAtWorld(double time, const HapticLoop* loop) {
  demos::SiteWorld& world = run_.world();
  if (!scene_look_) scene_look_.emplace(world);
  const auto look = std::make_shared<SessionLook>();
  look->time = time;
  look->list = scene_look_->look(details());
  look->is_waiting = loop == nullptr;
  if (loop) look->loop = loop->report();
  const auto there = lookAt(world.site(), *look);
  for (const demos::SceneBody& body : world.bodies())
    if (there && body.role == "object") look->apart = addGhost(look->list, body.name, *there);
  publish(look);
}

}  // namespace tandem::view
