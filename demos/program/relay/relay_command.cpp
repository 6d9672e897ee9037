#include <algorithm>
#include <cstdio>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/key_file.h"
#include "tandem/plugin/relay.h"

#include "command/command.h"
#include "relay/relay_report.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"
#include "terminal/stop_signals.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kReportPeriod = 1.0;  // [s]
constexpr double kLookPeriod = 0.01;   ///< of silent members and addresses [s]
constexpr double kLongestRun = 1e9;    // [s]

/// Options of `tandem relay`, as written.
struct RelayOptions {
  std::string bind, key;
  RelaySettings settings;
  std::optional<double> duration;  ///< [s]; empty: until SIGINT or SIGTERM
  bool json = false;
  bool quiet = false;
};

double readDuration(const RelayOptions& options) {
  if (!options.duration) return std::numeric_limits<double>::infinity();
  if (!(*options.duration >= 0.0 && *options.duration <= kLongestRun))
    throw UsageError(fmt::format("--seconds {}: must be 0 to 1e9", *options.duration));
  return *options.duration;
}

/// Sleeps until a datagram comes, `seconds` have passed or a signal asks to stop.
void wait(const RelayServer& relay, const StopSignals& stop, double seconds) noexcept {
  pollfd wanted{relay.handle(), POLLIN, 0};
  timespec time{};
  time.tv_nsec = static_cast<long>(std::clamp(seconds, 0.0, kLookPeriod) * 1e9);
  (void)::ppoll(&wanted, 1, &time, &stop.whileWaiting());
}

/// Says what the relay does, once a second.
class RelayWatch {
 public:
  RelayWatch(const RelayServer& relay, const RelayOptions& options, double started)
      : relay_(relay),
        is_json_(options.json),
        is_quiet_(options.quiet),
        line_(options.quiet || options.json),
        started_(started),
        next_(started + kReportPeriod) {}

  void look(double now) {
    if (now < next_) return;
    const RelayStatus status = relay_.status();
    if (is_json_)
      writeOutput(makeRelayReport(status, now - started_).dump() + "\n");
    else if (!is_quiet_)
      line_.show(formatRelayLine(status, before_, now - next_ + kReportPeriod));
    before_ = status;
    next_ = now + kReportPeriod;
  }

 private:
  const RelayServer& relay_;
  bool is_json_, is_quiet_;
  StatusLine line_;
  double started_, next_;
  RelayStatus before_;
};

void runRelay(RelayOptions options) {
  const double duration = readDuration(options);
  options.settings.bind = resolveAddress(options.bind);
  RelayServer relay(options.settings, readKeyFile(options.key));
  const StopSignals stop;
  if (!options.quiet) {
    fmt::print(options.json ? stderr : stdout, "relay on {}\n", toString(relay.bound()));
    finishOutput();  // other programs wait for this line
  }
  const double started = readMonotonicClock();
  {
    RelayWatch watch(relay, options, started);
    for (double now = started; !stop.isAsked() && now - started < duration;
         now = readMonotonicClock()) {
      relay.poll(now);
      watch.look(now);
      wait(relay, stop, started + duration - now);
    }
  }
  if (!options.quiet && !options.json) writeOutput(formatRelaySum(relay.status()) + "\n");
}

/// `tandem relay`: runs until it is told to end.
class RelayCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    RelayOptions& own = options_;
    const OptionRules required = {.is_required = true};
    arguments.option("--bind", own.bind, "own address, e.g. :7000", required);
    arguments.option("--key", own.key, "key file of the relay; members have a copy", required);
    arguments.option("--rooms", own.settings.rooms, "rooms at the same time, 1 to 10000");
    arguments.option("--members", own.settings.members, "members of a room, 2 to 64");
    arguments.option("--rate", own.settings.datagram_rate, "datagrams of a member per second");
    arguments.option("--bytes", own.settings.byte_rate, "bytes of a member per second");
    arguments.option("--seconds", own.duration, "end after so many seconds");
    arguments.flag("--json", own.json, "a line of JSON to stdout each second");
    arguments.flag("--quiet", own.quiet, "print nothing but errors");
  }

  ExitStatus run() override {
    runRelay(options_);
    return kDone;
  }

 private:
  RelayOptions options_;
};

}  // namespace

CommandEntry relayCommand() {
  return {"relay", "forwards datagrams among the members of rooms", 6, makeCommand<RelayCommand>};
}

}  // namespace tandem::demos
