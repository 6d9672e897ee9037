#include <csignal>

#include <fmt/format.h>

#include "command/command.h"
#include "device/device_task.h"
#include "device/feel/feel.h"
#include "terminal/stop_signals.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kLongest = 86400.0;  // [s]
constexpr const char* kWaitHelp = "seconds to wait until it is homed, 120";

void checkTimes(const DeviceTask& task) {
  const auto require = [](double value, const char* option) {
    if (!(value > 0.0 && value <= kLongest))
      throw UsageError(fmt::format("{} {}: must be above 0 and at most 86400 s", option, value));
  };
  if (task.duration) require(*task.duration, "--for");
  require(task.patience, "--wait");
}

/// `tandem device` with its commands.
class DeviceCommand final : public Command {
 public:
  void declare(Arguments& arguments) override;
  ExitStatus run() override;

 private:
  void declareOutput(Arguments& arguments, bool has_json);
  void declareTimes(Arguments& arguments, const char* duration);
  /// Runs the given command. Returns false if a check failed.
  bool runOne(const Pause& pause);

  Arguments* arguments_ = nullptr;
  DeviceTask task_;
};

void DeviceCommand::declareOutput(Arguments& arguments, bool has_json) {
  if (has_json) arguments.flag("--json", task_.json, "print the outcome as JSON to stdout");
  arguments.flag("--quiet", task_.quiet, "print nothing but errors");
}

void DeviceCommand::declareTimes(Arguments& arguments, const char* duration) {
  arguments.option("--for", task_.duration, duration);
  arguments.option("--wait", task_.patience, kWaitHelp);
}

void DeviceCommand::declare(Arguments& arguments) {
  arguments_ = &arguments;
  declareOutput(arguments.command("list", "what is plugged in"), true);
  const auto add = [&](const char* name, const char* help, bool has_json) -> Arguments& {
    Arguments& one = arguments.command(name, help);
    declareDeviceOptions(one, task_.device);
    declareOutput(one, has_json);
    return one;
  };
  declareTimes(add("info", "what a device can do and how it does", true),
               "seconds in which is counted, 1");
  add("home", "lead through homing", false).option("--wait", task_.patience, kWaitHelp);
  declareTimes(add("check", "positions and small forces along each axis", true),
               "seconds in which positions are looked at, 10");
  declareTimes(add("latency", "rate, round trips and lateness", true), "seconds, 5");
  Arguments& record = add("record", "positions, velocities, forces and buttons as CSV", false);
  record.option("file", task_.file, "appears at the end", {.is_required = true});
  declareTimes(record, "seconds; without, until Ctrl-C, an hour at the most");

  declareDeviceOptions(arguments, task_.device);
  declareOutput(arguments, true);
  declareTimes(arguments, "seconds; without, until Ctrl-C");
  arguments.option("--scenario", task_.scenario,
                   "feel the world of a scenario file instead of a cube on a floor");
}

bool DeviceCommand::runOne(const Pause& pause) {
  if (arguments_->has("list"))
    listDevices(task_);
  else if (arguments_->has("info"))
    showDevice(task_, pause);
  else if (arguments_->has("home"))
    homeDevice(task_, pause);
  else if (arguments_->has("check"))
    return checkDevice(task_, pause);
  else if (arguments_->has("latency"))
    measureLatency(task_, pause);
  else if (arguments_->has("record"))
    recordDevice(task_, pause);
  else
    feelCube(task_, pause);
  return true;
}

ExitStatus DeviceCommand::run() {
  checkTimes(task_);
  // Threads that start later leave these signals to this thread.
  const StopSignals stop;
  // A closed pipe must not end the program while the device renders force.
  (void)std::signal(SIGPIPE, SIG_IGN);
  return runOne([&](double seconds) { return stop.isAskedWithin(seconds); }) ? kDone : kCheckFailed;
}

}  // namespace

CommandEntry deviceCommand() {
  return {"device", "feel a cube with a haptic device; list, home and check devices", 6,
          makeCommand<DeviceCommand>};
}

}  // namespace tandem::demos
