#include "peer/watch_run.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/watcher.h"

#include "files/output_folder.h"
#include "peer/publishing.h"
#include "peer/watch_check.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"
#include "terminal/stop_signals.h"

namespace tandem::demos {
namespace {

constexpr double kLookPeriod = 0.01;   ///< states come each 1/32 s [s]
constexpr double kReportPeriod = 1.0;  // [s]

/// The file watch.csv: a row for each state of a hand or a copy.
class WatchFile {
 public:
  explicit WatchFile(const std::string& folder)
      : folder_(folder, "--out " + folder), file_(folder_ / "watch.csv") {
    file_ << "time,site,site_time,object,x,y,z\n";
  }
  void write(double time, const WatchedSite& site) {
    const StatePacket& packet = site.newest;
    writeRow(time, packet, "hand", packet.user.p_W);
    for (std::uint32_t i = 0; i < packet.object_count; ++i)
      writeRow(time, packet, std::to_string(packet.objects[i].id), packet.objects[i].state.p_W);
  }
  void publish() {
    file_.close();
    if (!file_) throw Error("--out: watch.csv cannot be written; is the disk full?");
    folder_.publish("watch.csv");
  }

 private:
  void writeRow(double time, const StatePacket& packet, const std::string& object, const Vec3& p) {
    file_ << fmt::format("{:.6f},{},{:.6f},{},{:.9g},{:.9g},{:.9g}\n", time,
                         static_cast<std::uint32_t>(packet.sender), packet.time, object, p.x(),
                         p.y(), p.z());
  }

  OutputFolder folder_;
  std::ofstream file_;
};

/// Largest distance between the copies of any object at any two sites [m].
double measureCoherency(const Watcher& watcher, const std::vector<PeerId>& sites) {
  double largest = 0.0;
  for (ObjectId id = 0; id < kMaxSharedObjects; ++id)
    for (const PeerId a : sites)
      for (const PeerId b : sites) {
        const ObjectState* one = watcher.object(a, id);
        const ObjectState* other = watcher.object(b, id);
        if (one && other) largest = std::max(largest, (one->state.p_W - other->state.p_W).norm());
      }
  return largest;
}

std::string describe(const Watcher& watcher, double now) {
  const RelayConnection relay = watcher.relay(now);
  const std::vector<PeerId> sites = watcher.heard();
  if (sites.empty())
    return relay.refused.empty() ? "waiting for sites" : "waiting | relay: " + relay.refused;
  std::string line;
  for (const PeerId id : sites) {
    const double age = now - watcher.latest(id)->heard_at;
    line += fmt::format("site {} {:.2f} s ago | ", static_cast<std::uint32_t>(id), age);
  }
  if (const ObjectState* object = watcher.object(sites.front(), 0)) {
    const Vec3& p = object->state.p_W;
    line += fmt::format("object at {:.3f} {:.3f} {:.3f} m | ", p.x(), p.y(), p.z());
  }
  return line + fmt::format("coherency {:.3f} mm", 1e3 * measureCoherency(watcher, sites));
}

SiteStates toStates(const StatePacket& packet) {
  SiteStates states{packet.sender, 0, packet.time, packet.user, std::nullopt, {}};
  states.objects.assign(packet.objects.begin(), packet.objects.begin() + packet.object_count);
  return states;
}

/// Follows the sites; knows which states it has seen.
class WatchRun {
 public:
  /// `publish` may be empty.
  WatchRun(const PeerLine& line, const Scenario* scenario, std::optional<WatchFile>& file,
           PublishStates publish)
      : watcher_(makeWatchAccess(line), line.bind.empty() ? Address{} : resolveAddress(line.bind)),
        check_(scenario, line.patience, started_),
        file_(file),
        publish_(std::move(publish)) {}

  void look(double now) {
    watcher_.poll(now);
    check_.check(watcher_, now);
    for (const PeerId id : watcher_.heard()) {
      const WatchedSite& site = *watcher_.latest(id);
      std::uint64_t& seen = seen_[static_cast<std::uint32_t>(id) - 1];
      if (std::exchange(seen, site.states) == site.states) continue;
      last_ = std::max(last_.value_or(0.0), site.heard_at);
      if (file_) file_->write(site.heard_at - started_, site);
      if (publish_) publish_(toStates(site.newest));
    }
  }
  [[nodiscard]] bool hasHeard() const noexcept { return last_.has_value(); }
  [[nodiscard]] double silence(double now) const noexcept { return now - last_.value_or(started_); }
  [[nodiscard]] const Watcher& watcher() const noexcept { return watcher_; }

 private:
  double started_ = readMonotonicClock();
  Watcher watcher_;
  WatchCheck check_;
  std::optional<WatchFile>& file_;
  PublishStates publish_;
  std::array<std::uint64_t, kMaxPeerId> seen_{};  ///< states of each site
  std::optional<double> last_;                    ///< newest state of any site [s]
};

}  // namespace

void watchSites(const PeerLine& line, const Scenario* scenario, const WatchOutput& output) {
  const StopSignals stop;  // before Cyclone's threads
  PublishStates publish;
  if (output.publish) publish = makePublisher(*output.publish, "what this spectator sees");
  std::optional<WatchFile> file;
  if (output.folder) file.emplace(*output.folder);
  WatchRun run(line, scenario, file, std::move(publish));
  double next_report = readMonotonicClock() + kReportPeriod;
  {
    StatusLine status(output.is_quiet);
    for (double now = readMonotonicClock(); !run.hasHeard() || run.silence(now) < line.patience;
         now = readMonotonicClock()) {
      run.look(now);
      if (now >= next_report) {
        status.show(describe(run.watcher(), now));
        next_report = now + kReportPeriod;
      }
      if (stop.isAskedWithin(kLookPeriod)) break;
    }
  }
  if (file && run.hasHeard()) file->publish();
  finishOutput();
}

}  // namespace tandem::demos
