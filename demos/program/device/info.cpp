#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/falcon/monotonic_clock.h"

#include "device/device_task.h"
#include "device/open_device.h"
#include "device/user_axes.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"

namespace tandem::demos {
namespace {

constexpr double kLook = 0.005;  // [s]

/// Waits until the device is opened, booted and loaded, or has failed.
bool waitUntilStarted(LiveDevice& device, const DeviceTask& task, const Pause& pause) {
  StatusLine line(task.quiet || task.json);
  const double until = readMonotonicClock() + task.patience;
  for (;;) {
    (void)device.read(0.0);
    const DeviceReport report = device.report();
    if (!report.is_starting || report.is_hopeless || readMonotonicClock() > until) return true;
    if (line.isDue()) line.show(report.state);
    if (pause(kLook)) return false;
  }
}

nlohmann::json toJson(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::json makeInfo(LiveDevice& device, const DeviceReport& before, const DeviceReport& after,
                        double elapsed) {
  const DeviceCapabilities& can = device.capabilities();
  nlohmann::json j = {{"device", toText(device.spec())},
                      {"name", can.name},
                      {"degrees_of_freedom", can.degrees_of_freedom},
                      {"max_force", toJson(can.max_force)},
                      {"max_slew", toJson(can.max_slew)},
                      {"max_stiffness", toJson(can.max_stiffness)},
                      {"state", after.state},
                      {"trouble", after.trouble},
                      {"buttons", after.buttons}};
  j["workspace"] = {toJson(can.workspace.x()), toJson(can.workspace.y()),
                    toJson(can.workspace.z())};
  if (after.homed) j["homed"] = *after.homed;
  j["readings_per_second"] = static_cast<double>(after.readings - before.readings) / elapsed;
  j["counters"] = nlohmann::json::object();
  for (std::size_t i = 0; i < after.counters.size(); ++i)
    j["counters"][after.counters[i].first] = {
        {"all", after.counters[i].second},
        {"in_this_second", after.counters[i].second - before.counters[i].second}};
  return j;
}

std::string show(const nlohmann::json& value, double unit, const char* name) {
  return value.is_null() ? "no limit" : fmt::format("{:.4g} {}", unit * value.get<double>(), name);
}

void print(const nlohmann::json& j) {
  const auto row = [](const char* name, const std::string& value) {
    fmt::print("{:<20} {}\n", name, value);
  };
  row("device",
      fmt::format("{}: {}", j["device"].get<std::string>(), j["name"].get<std::string>()));
  row("force", j["max_force"] == 0.0 ? "none" : show(j["max_force"], 1.0, "N"));
  row("slew", show(j["max_slew"], 1.0, "N/s"));
  row("calm stiffness", show(j["max_stiffness"], 1.0, "N/m"));
  row("workspace",
      fmt::format("+- {} away, {} left, {} up", show(j["workspace"][0], 1e3, "mm"),
                  show(j["workspace"][1], 1e3, "mm"), show(j["workspace"][2], 1e3, "mm")));
  row("state", j["state"].get<std::string>());
  if (const std::string trouble = j["trouble"]; !trouble.empty()) row("trouble", trouble);
  if (j.contains("homed")) {
    const int homed = j["homed"];
    row("homed legs", fmt::format("{} of 3", (homed & 1) + (homed >> 1 & 1) + (homed >> 2 & 1)));
  }
  row("buttons", fmt::format("{:#04x}", j["buttons"].get<int>()));
  row("readings", fmt::format("{:.0f} per second", j["readings_per_second"].get<double>()));
  for (const auto& [name, count] : j["counters"].items())
    row(name.c_str(),
        fmt::format("{} in this second, {} in all", count["in_this_second"].get<std::uint64_t>(),
                    count["all"].get<std::uint64_t>()));
}

}  // namespace

Placement placeAlone() { return {computeUserAxes(Quat::Identity(), 0), Vec3::Zero()}; }

void showDevice(const DeviceTask& task, const Pause& pause) {
  const auto device = openDevice(task.device, placeAlone(), UserWish::kRest);
  if (!waitUntilStarted(*device, task, pause)) return;
  const DeviceReport before = device->report();
  const double began = readMonotonicClock();
  if (!exchange(*device, task.duration.value_or(1.0), pause,
                [](double, const DeviceSample&) { return Vec3(Vec3::Zero()); }))
    return;
  const nlohmann::json info =
      makeInfo(*device, before, device->report(), readMonotonicClock() - began);
  if (task.json) {
    writeOutput(info.dump(2) + "\n");
  } else if (!task.quiet) {
    print(info);
  }
  finishOutput();
}

}  // namespace tandem::demos
