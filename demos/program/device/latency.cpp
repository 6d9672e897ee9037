#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/falcon/monotonic_clock.h"

#include "device/bars.h"
#include "device/device_task.h"
#include "device/get_ready.h"
#include "device/open_device.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"

namespace tandem::demos {
namespace {

constexpr double kUsual = 5.0;  // [s]
constexpr int kBar = 50;

/// Round trips between two looks.
FalconRoundTrips subtract(FalconRoundTrips after, const FalconRoundTrips& before) {
  after.count -= before.count;
  after.sum -= before.sum;
  for (std::size_t i = 0; i < after.bins.size(); ++i) after.bins[i] -= before.bins[i];
  return after;
}

/// Prints the share of ticks that began late by up to each of these times [s].
constexpr std::array<double, 8> kSteps = {20e-6, 50e-6, 100e-6, 200e-6, 500e-6, 1e-3, 5e-3, 100.0};

nlohmann::json describeLateness(std::vector<double> late) {
  std::sort(late.begin(), late.end());
  const auto at = [&](double share) {
    if (late.empty()) return 0.0;
    return late[static_cast<std::size_t>(share * static_cast<double>(late.size() - 1))];
  };
  nlohmann::json j = {{"count", late.size()},
                      {"p50", at(0.5)},
                      {"p99", at(0.99)},
                      {"max", at(1.0)},
                      {"bins", nlohmann::json::array()}};
  auto from = late.begin();
  for (const double step : kSteps) {
    const auto to = std::upper_bound(from, late.end(), step);
    j["bins"].push_back({{"until", step}, {"count", to - from}});
    from = to;
  }
  return j;
}

nlohmann::json describeRoundTrips(const FalconRoundTrips& trips) {
  nlohmann::json j = {
      {"count", trips.count}, {"mean", trips.mean()}, {"bins", nlohmann::json::array()}};
  for (std::size_t i = 0; i < trips.bins.size(); ++i)
    j["bins"].push_back(
        {{"until", FalconRoundTrips::kBin * static_cast<double>(i + 1)}, {"count", trips.bins[i]}});
  return j;
}

void printBins(const char* title, const nlohmann::json& part) {
  const double count = part["count"];
  fmt::print("{}\n", title);
  for (const nlohmann::json& bin : part["bins"]) {
    const double until = bin["until"], share = count > 0 ? bin["count"].get<double>() / count : 0.0;
    if (bin["count"] == 0) continue;
    const std::string label = until < 10.0 ? fmt::format("{:.2f} ms", 1e3 * until) : "more";
    fmt::print("  to {:>9} {:>8} {}\n", label, bin["count"].get<std::uint64_t>(),
               makeShare(share, kBar));
  }
}

}  // namespace

void measureLatency(const DeviceTask& task, const Pause& pause) {
  const auto device = openDevice(task.device, placeAlone(), UserWish::kRest);
  const GetReadySettings settings = makeGetReadySettings(task, false);
  if (!getReady(*device, settings, pause)) return;

  nlohmann::json j;
  {
    StatusLine line(settings.is_quiet);
    const double duration = task.duration.value_or(kUsual), began = readMonotonicClock();
    const DeviceReport before = device->report();
    std::vector<double> lateness;
    const bool is_done = exchange(
        *device, duration, pause,
        [&](double t, const DeviceSample&) {
          if (line.isDue()) line.show(fmt::format("{:.0f} of {:.0f} s", t, duration));
          return Vec3(Vec3::Zero());
        },
        &lateness);
    const DeviceReport after = device->report();
    const double elapsed = readMonotonicClock() - began;
    j = {{"device", toText(device->spec())},
         {"duration", elapsed},
         {"loop_rate", static_cast<double>(lateness.size()) / elapsed},
         {"device_rate", static_cast<double>(after.readings - before.readings) / elapsed},
         {"lateness", describeLateness(std::move(lateness))}};
    if (after.round_trips)
      j["round_trip"] = describeRoundTrips(subtract(*after.round_trips, *before.round_trips));
    if (!is_done) line.print("ended early");
  }
  if (task.json) {
    writeOutput(j.dump(2) + "\n");
  } else if (!task.quiet) {
    fmt::print("{}: {:.1f} s, loop {:.1f} per second, device {:.1f} per second\n",
               j["device"].get<std::string>(), j["duration"].get<double>(),
               j["loop_rate"].get<double>(), j["device_rate"].get<double>());
    printBins("lateness of the loop's ticks", j["lateness"]);
    if (j.contains("round_trip")) printBins("time from a frame to its reply", j["round_trip"]);
  }
  finishOutput();
}

}  // namespace tandem::demos
