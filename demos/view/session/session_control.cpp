#include "session/session_control.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "scenario/keys.h"
#include "session/own_worlds.h"
#include "terminal/usage_error.h"

namespace tandem::view {
namespace {

/// Bullet's own contact and couplers need steps of this rate at least [Hz]: at 60 Hz the world cube
/// flies apart.
constexpr double kLeastNativeRate = 240.0;

std::string nameContact(const demos::Scenario& scenario) {
  return "contact.model = " + demos::nameOf(scenario.site.contact_model);
}

void requireTwoSites(const demos::Scenario& scenario) {
  if (scenario.sites.size() == demos::kFewestSites) return;
  throw demos::UsageError(fmt::format(
      "tandem view: {} has {} sites; a window plays two of them: give --site, --bind, --peer and "
      "--key, or use tandem run and tandem view --replay",
      scenario.file.string(), scenario.sites.size()));
}

}  // namespace

SessionControl::SessionControl(const demos::Scenario& scenario,
                               const std::optional<demos::PeerLine>& line,
                               const UsersDevices& devices,
                               const std::optional<std::filesystem::path>& record)
    : scenario_(scenario), line_(line), devices_(devices) {
  if (!line_) checkHand(scenario_);
  if (record) records_.emplace(*record, line_ ? line_->site : 0);
  start({});
}

std::vector<std::string> SessionControl::notes() const {
  std::vector<std::string> notes = session_->notes();
  if (!refusal_.empty()) notes.push_back(refusal_);
  return notes;
}

void SessionControl::obey(const SessionWishes& wishes) {
  try {
    if (wishes.pace != pace_ || wishes.steps > 0) changePace(wishes);
    if (!wishes.world.empty()) return changeWorld(wishes.world);
    if (wishes.restarts || wishes.changes_sites) return changeSites(wishes);
    scenario_ = wishes.scenario;
    if (both_ && wishes.changes_network) both_->setNetwork(scenario_.network);
    if (friend_) followFriend();
  } catch (const demos::UsageError& error) {
    refusal_ = error.what();
  }
}

void SessionControl::end() {
  if (both_) both_->end();
  if (friend_) friend_->end();
  if (records_ && records_->count() == 0)
    fmt::print(stderr, "tandem: note: nothing is recorded: the session has not begun\n");
}

/// Own changes are in `scenario_` before they are in force.
void SessionControl::followFriend() {
  demos::ChangedScenario agreed = friend_->scenario();
  if (agreed.changes == changes_) return;
  changes_ = agreed.changes;
  scenario_ = std::move(agreed.scenario);
}

void SessionControl::changePace(const SessionWishes& wishes) {
  if (!both_)
    throw demos::UsageError("time goes on: your friend's hand does not stop with your window");
  if (devices_.own || devices_.second)
    throw demos::UsageError(
        "time goes on: a real hand does not stop; leave out --device and --second");
  refusal_.clear();
  pace_ = wishes.pace;
  both_->setPace(pace_);
  for (int step = 0; step < wishes.steps; ++step) both_->step();
}

/// With its own gains and network. A device stays where its first world put it.
void SessionControl::changeWorld(const std::string& name) {
  if (line_)
    throw demos::UsageError(name + ": your friend is in this world; start both in another one");
  if (devices_.own || devices_.second)
    throw demos::UsageError(name + ": a device has its place in this world; start tandem view " +
                            name);
  const auto file = findOwnWorld(name);
  if (!file) throw demos::UsageError(name + ": there is no such world");
  SessionWishes wishes;
  wishes.scenario = demos::loadScenario(*file, {});
  wishes.restarts = true;
  changeSites(wishes);
}

/// Sites that cannot be made leave those of before.
void SessionControl::changeSites(const SessionWishes& wishes) {
  demos::Scenario wanted = demos::changeScenario(wishes.scenario, {});
  checkHand(wanted);
  refusal_.clear();
  if (friend_) {
    friend_->propose(wanted);
    scenario_ = wanted;
    return;
  }
  const demos::ScenePlaces places = both_->end();
  const bool goes_on = !wishes.restarts && places.areNear();
  const auto kept = goes_on ? std::optional(places) : std::nullopt;
  std::swap(scenario_, wanted);
  try {
    start(kept);
  } catch (const std::exception& error) {
    refusal_ = error.what();
    std::swap(scenario_, wanted);
    start(kept);
  }
}

void SessionControl::checkHand(const demos::Scenario& scenario) const {
  if (LiveSession::hasHapticThreads(scenario)) return;
  if (line_)
    throw demos::UsageError(nameContact(scenario) +
                            ": a friend meets you by Tandem's own contact only; stay with island");
  if (devices_.own || devices_.second)
    throw demos::UsageError(nameContact(scenario) +
                            ": Bullet has no haptic rate for a device; take island, or the mouse");
}

void SessionControl::start(const std::optional<demos::ScenePlaces>& places) {
  session_maker_.run([&] { makeSession(places); });
}

void SessionControl::makeSession(const std::optional<demos::ScenePlaces>& places) {
  if (!line_) requireTwoSites(scenario_);
  demos::Scenario scenario = scenario_;
  if (places) demos::startHandsAt(*places, scenario);
  if (!LiveSession::hasHapticThreads(scenario))
    scenario.host_rate = std::max(scenario.host_rate, kLeastNativeRate);
  session_.reset();
  both_ = nullptr;
  if (!devices_.own) {
    MouseSettings settings;
    settings.start_W =
        demos::computeStart(scenario, demos::makeSceneFrame(scenario), userOf(line_));
    mouse_ = std::make_unique<MouseDevice>(settings);
  }
  SessionRecords* const records = records_ ? &*records_ : nullptr;
  HapticDevice& device = devices_.own ? static_cast<HapticDevice&>(*devices_.own) : *mouse_;
  if (line_) {
    auto session = std::make_unique<PeerSession>(scenario, *line_, device, records);
    friend_ = session.get();
    session_ = std::move(session);
    return;
  }
  LiveStart start{.pace = pace_, .records = records, .second = devices_.second};
  if (places) start.places = places->bodies;
  auto session = std::make_unique<LiveSession>(scenario, device, start);
  both_ = session.get();
  session_ = std::move(session);
}

}  // namespace tandem::view
