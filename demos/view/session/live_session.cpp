#include "session/live_session.h"

#include <utility>

#include "tandem/falcon/monotonic_clock.h"

#include "analyse/growth_warning.h"
#include "session/paced_time.h"

namespace tandem::view {
namespace {

/// Without haptic threads the sites look at the clock so often [s].
constexpr double kTurn = 1e-3;

}  // namespace

LiveSession::LiveSession(const demos::Scenario& scenario, HapticDevice& device,
                         const LiveStart& start)
    : pair_(scenario, {&device, start.second}, start.places),
      second_(start.second),
      record_(start.records ? std::make_unique<PairRecord>(scenario, pair_, *start.records)
                            : nullptr),
      scenario_(scenario),
      scene_look_(pair_.own()),
      may_hold_(scenario.mayGrip()),
      has_threads_(hasHapticThreads(scenario)),
      pace_(start.pace) {
  warn(demos::warnBeforeTouch(scenario_));
  lookAtWorlds(0.0);
  if (needsThreads()) startThreads();
  host_ = std::jthread([this](const std::stop_token& stop) { live(stop); });
}

LiveSession::~LiveSession() = default;

bool LiveSession::hasHapticThreads(const demos::Scenario& scenario) {
  return scenario.site.contact_model == ContactModel::kIsland &&
         scenario.site.injection == Injection::kHandoff;
}

void LiveSession::setNetwork(const Impairments& network) {
  pair_.network().change(network);
  scenario_.network = network;
  warn(demos::warnBeforeTouch(scenario_));
}

void LiveSession::setPace(const Pace& pace) {
  const std::lock_guard lock(mutex_);
  pace_ = pace;
}

Pace LiveSession::pace() const {
  const std::lock_guard lock(mutex_);
  return pace_;
}

demos::ScenePlaces LiveSession::end() {
  host_ = {};
  if (const auto record = std::exchange(record_, nullptr)) record->store(scenario_.network);
  const auto hand_W = [](demos::SiteWorld& world) { return world.site().hip().p_W; };
  return {{hand_W(pair_.own()), hand_W(pair_.other())}, pair_.own().places()};
}

void LiveSession::live(const std::stop_token& stop) {
  liveToTheEnd([&] {
    while (!stop.stop_requested()) needsThreads() ? runThreads(stop) : runPaced(stop);
  });
  pair_.stop();
}

void LiveSession::startThreads() {
  pair_.start();
  tell(pair_.loop().notes());
}

void LiveSession::runThreads(const std::stop_token& stop) {
  if (!pair_.isLive()) startThreads();
  for (int step = 1; !stop.stop_requested() && needsThreads(); ++step) {
    const double time = pair_.hostStepEnd(step);
    sleepUntil(pair_.begin() + time);
    pair_.stepHosts(time);
    afterSteps(time);
  }
  pair_.stop();
}

void LiveSession::runPaced(const std::stop_token& stop) {
  PacedTime time(pair_, readMonotonicClock(), pace());
  for (; !stop.stop_requested() && !needsThreads(); sleepFor(kTurn)) {
    time.advance(readMonotonicClock(), pace(), steps_.exchange(0));
    afterSteps(pair_.time());
  }
}

void LiveSession::afterSteps(double time) {
  if (may_hold_) pair_.own().hold(wantsHold());
  if (may_hold_ && second_) pair_.other().hold(second_->isGripPressed());
  if (record_) record_->noteStep(time);
  if (isLookDue(readMonotonicClock())) lookAtWorlds(time);
}

void LiveSession::lookAtWorlds(double time) {
  const auto look = std::make_shared<SessionLook>();
  look->time = time;
  look->list = scene_look_.look(details());
  look->apart = addGhosts(look->list, pair_.other());
  lookAt(pair_.own().site(), *look);
  if (pair_.isLive())
    look->loop = pair_.loop().report();
  else
    look->loop.ticks = pair_.nextTick();
  publish(look);
}

}  // namespace tandem::view
