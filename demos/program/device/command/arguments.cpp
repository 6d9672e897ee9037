#include "device/command/arguments.h"

#include <csignal>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "device/feel/feel.h"
#include "terminal/stop_signals.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kLongest = 86400.0;  // [s]

void addOutput(CLI::App& app, DeviceCommand& command, bool has_json) {
  if (has_json) app.add_flag("--json", command.json, "print the outcome as JSON to stdout");
  app.add_flag("--quiet", command.quiet, "print nothing but errors");
}

void addTimes(CLI::App& app, DeviceCommand& command, const char* what) {
  app.add_option("--for", command.duration, what);
  app.add_option("--wait", command.patience, "seconds to wait until it is homed, 120");
}

void check(const DeviceCommand& command) {
  const auto require = [](double value, const char* option) {
    if (!(value > 0.0 && value <= kLongest))
      throw UsageError(fmt::format("{} {}: must be above 0 and at most 86400 s", option, value));
  };
  if (command.duration) require(*command.duration, "--for");
  require(command.patience, "--wait");
}

}  // namespace

void addDeviceOptions(CLI::App& app, DeviceOptions& options) {
  app.add_option("--device", options.device,
                 "falcon, falcon:SERIAL, falcon@/dev/ttyUSB0, falcon@ft260, emulated, simulated, "
                 "spacemouse[:PATH], hid[:PATH]");
  app.add_option("--firmware", options.firmware, "file of the Falcon's image; none comes with us");
  app.add_option("--motors-per-torque", options.motors_per_torque,
                 "what a Falcon's motors make of a torque [1/(N m)], 4200");
  app.add_option("--max-force", options.max_force, "no more than this at the hand [N], 8");
  app.add_option("--scale", options.scale, "way in the world by way of the hand, 1");
  app.add_option("--offset", options.offset, "moves the workspace in the world: x y z [m]")
      ->expected(3);
  app.add_option("--clutch", options.clutch,
                 "while pressed the hand goes back alone: plus, forward, centre, minus, or "
                 "hid:PATH,KIND,REPORT,BYTE,VALUE");
}

CLI::App* addDeviceCommand(CLI::App& app, DeviceCommand& command) {
  CLI::App* device = app.add_subcommand(
      "device", "feel a cube with a haptic device; list, home and check devices");
  device->require_subcommand(0, 1);
  const auto add = [&](const char* name, const char* text, bool has_json) {
    CLI::App* one = device->add_subcommand(name, text);
    if (std::string_view(name) != "list") addDeviceOptions(*one, command.device);
    addOutput(*one, command, has_json);
    return one;
  };
  (void)add("list", "what is plugged in", true);
  addTimes(*add("info", "what a device can do and how it does", true), command,
           "seconds in which is counted, 1");
  CLI::App* home = add("home", "lead through homing", false);
  home->add_option("--wait", command.patience, "seconds to wait until it is homed, 120");
  addTimes(*add("check", "positions and small forces along each axis", true), command,
           "seconds in which positions are looked at, 10");
  addTimes(*add("latency", "rate, round trips and lateness", true), command, "seconds, 5");
  CLI::App* record = add("record", "positions, velocities, forces and buttons as CSV", false);
  record->add_option("file", command.file, "appears at the end")->required();
  addTimes(*record, command, "seconds; without, until Ctrl-C, an hour at the most");

  addDeviceOptions(*device, command.device);
  addOutput(*device, command, true);
  addTimes(*device, command, "seconds; without, until Ctrl-C");
  device->add_option("--scenario", command.scenario,
                     "feel the world of a scenario file instead of a cube on a floor");
  return device;
}

bool runDeviceCommand(const CLI::App& device, const DeviceCommand& command) {
  check(command);
  // Before there are threads: they must leave signals to this one.
  const StopSignals stop;
  // A reader that goes away must not end the program while there is force.
  (void)std::signal(SIGPIPE, SIG_IGN);
  const Pause pause = [&](double seconds) { return stop.isAskedWithin(seconds); };
  const auto is = [&](const char* name) { return device.got_subcommand(name); };
  if (is("list"))
    listDevices(command);
  else if (is("info"))
    showDevice(command, pause);
  else if (is("home"))
    homeDevice(command, pause);
  else if (is("check"))
    return checkDevice(command, pause);
  else if (is("latency"))
    measureLatency(command, pause);
  else if (is("record"))
    recordDevice(command, pause);
  else
    feelCube(command, pause);
  return true;
}

}  // namespace tandem::demos
