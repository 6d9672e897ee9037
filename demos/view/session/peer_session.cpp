#include "session/peer_session.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "tandem/falcon/monotonic_clock.h"

#include "analyse/growth_warning.h"
#include "peer/peer_output.h"

namespace tandem::view {

PeerSession::PeerSession(const demos::Scenario& scenario, const demos::PeerLine& line,
                         HapticDevice& device, SessionRecords* records)
    : site_(line.site),
      records_(records),
      meeting_(scenario, line,
               {&device,
                {},
                records ? demos::PeerPurpose::kRecordedSession : demos::PeerPurpose::kSession}) {
  warn(demos::warnBeforeTouch(scenario));
  lookAtWorld(0.0, nullptr);
  thread_ = std::jthread([this](const std::stop_token& stop) { live(stop); });
}

PeerSession::~PeerSession() = default;

void PeerSession::end() {
  thread_ = {};
  (void)goesOn();
}

void PeerSession::storeRecord() {
  const demos::PeerRun& run = meeting_.run();
  if (!run.record().hasAnything()) return;
  records_->store([&](const demos::OutputFolder& folder) {
    demos::writePeerRun(folder, site_, demos::makePeerSummary(run), run);
  });
}

void PeerSession::live(const std::stop_token& stop) {
  std::vector<std::string> notes;
  demos::PeerWatch watch;
  watch.stop = [&] { return stop.stop_requested(); };
  watch.report = [](const demos::PeerReport&) {};
  watch.note = [&](const std::string& line) {
    if (std::ranges::find(notes, line) == notes.end()) notes.push_back(line);
    tell(notes);
  };
  watch.has_world = [&] {
    scene_look_.reset();
    lookAtWorld(0.0, nullptr);
  };
  watch.after_step = [&](double time, const HapticLoop& loop) {
    meeting_.run().world().hold(wantsHold());
    if (isLookDue(readMonotonicClock())) lookAtWorld(time, &loop);
  };
  if (records_) watch.after_run = [&] { storeRecord(); };
  liveToTheEnd([&] { meeting_.live(watch); });
}

void PeerSession::lookAtWorld(double time, const HapticLoop* loop) {
  demos::SiteWorld& world = meeting_.run().world();
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
