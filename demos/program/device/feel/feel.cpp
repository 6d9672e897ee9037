#include "device/feel/feel.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/plugin/haptic_loop.h"

#include "device/bars.h"
#include "device/feel/feel_scenario.h"
#include "device/get_ready.h"
#include "device/open_device.h"
#include "device/user_axes.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"
#include "world/scene.h"

namespace tandem::demos {
namespace {

constexpr double kGetReady = 0.02;  // time from making the threads to the first tick [s]

/// The link to an absent user.
class SilentLink final : public Link {
 public:
  void send(const StatePacket&, double) noexcept override {}
  [[nodiscard]] std::optional<Arrival> receive(double, double) noexcept override { return {}; }
};

/// The user's force and motion at a tick.
struct Moment {
  Vec3 hand_S, cube_S, force_S;
};

Moment look(SiteWorld& world, const Scenario& scenario) {
  const SceneFrame frame = makeSceneFrame(scenario);
  Site& site = world.site();
  Moment moment;
  site.betweenTicks([&] {
    moment.hand_S = frame.toScene(site.hip().p_W);
    moment.cube_S = scenario.hasObject() ? frame.toScene(site.object(0).p_W) : Vec3(Vec3::Zero());
    moment.force_S = frame.toScene(site.force());
  });
  return moment;
}

std::string show(double time, const Moment& moment, double most_force) {
  const double force = moment.force_S.norm();
  const Vec3 hand = 1e3 * moment.hand_S, cube = 1e3 * moment.cube_S;
  return fmt::format(
      "{:5.1f} s {} {:4.1f} N  hand {:+4.0f} {:+4.0f} {:+4.0f}  cube {:+4.0f} {:+4.0f} {:+4.0f} mm "
      " "
      "{}",
      time, makeLevel(force, most_force, 6), force, hand.x(), hand.y(), hand.z(), cube.x(),
      cube.y(), cube.z(), force > 0.0 ? "contact" : "free");
}

/// Numbers of the whole run.
struct Tally {
  double most_force = 0.0;
  int contacts = 0;
  bool was_touching = false;

  void add(const Moment& moment) {
    const double force = moment.force_S.norm();
    most_force = std::max(most_force, force);
    if (force > 0.0 && !was_touching) ++contacts;
    was_touching = force > 0.0;
  }
};

/// Steps the world when due, and checks after each step.
LoopReport run(SiteWorld& world, LiveDevice& device, const Scenario& scenario,
               const DeviceTask& task, const Pause& pause, Tally& tally) {
  HapticLoopSettings settings;
  settings.begin = readMonotonicClock() + kGetReady;
  settings.duration = task.duration.value_or(std::numeric_limits<double>::infinity());
  HapticLoop loop(world.site(), settings);
  const bool is_quiet = task.quiet || task.json;
  if (!is_quiet)
    for (const std::string& note : loop.notes()) fmt::print(stderr, "tandem: note: {}\n", note);
  StatusLine line(is_quiet);
  const double most_force = std::min(8.0, device.capabilities().max_force);
  for (std::uint64_t step = 1; loop.isRunning(); ++step) {
    const double time = static_cast<double>(step) / scenario.host_rate;
    if (pause(std::max(*settings.begin + time - readMonotonicClock(), 0.0))) break;
    world.stepHostUntil(time);
    if (task.device.grip) world.hold(device.isGripPressed());
    const Moment moment = look(world, scenario);
    tally.add(moment);
    if (line.isDue()) line.show(show(time, moment, most_force));
  }
  loop.stop();
  return loop.report();
}

nlohmann::json summarise(LiveDevice& device, Site& site, const LoopReport& loop,
                         const Tally& tally) {
  nlohmann::json j = {{"device", toText(device.spec())},
                      {"force", {{"max", tally.most_force}}},
                      {"contacts", tally.contacts},
                      {"ticks", loop.ticks},
                      {"late", loop.late},
                      {"skipped", loop.skipped},
                      {"lateness", {{"p50", loop.late_p50}, {"p99", loop.late_p99}}},
                      {"tick_time", {{"p50", loop.tick_p50}, {"p99", loop.tick_p99}}},
                      {"device_invalid", (site.status() & kDeviceInvalid) != 0},
                      {"device_trouble", device.report().trouble}};
  if (device.emulated()) j["felt"] = {{"max", device.emulated()->mostFelt()}};
  return j;
}

void print(const nlohmann::json& j) {
  fmt::print("largest force                    {:>12.3f} N in {} contacts\n",
             j["force"]["max"].get<double>(), j["contacts"].get<int>());
  if (j.contains("felt"))
    fmt::print("largest push of the motors       {:>12.3f} N, at the emulated grip\n",
               j["felt"]["max"].get<double>());
  fmt::print("ticks, late, skipped             {:>12} , {} , {}\n", j["ticks"].get<std::uint64_t>(),
             j["late"].get<std::uint64_t>(), j["skipped"].get<std::uint64_t>());
  if (j["device_invalid"].get<bool>())
    fmt::print("the device gave no position at times, and no force then: {}\n",
               j["device_trouble"].get<std::string>());
}

}  // namespace

void feelCube(const DeviceTask& task, const Pause& pause) {
  const Scenario scenario = makeFeelScenario(task);
  const SceneFrame frame = makeSceneFrame(scenario);
  const auto device =
      openDevice(task.device, {computeUserAxes(frame.q_WS, 0), computeStart(scenario, frame, 0)},
                 UserWish::kDip);
  const GetReadySettings settings = makeGetReadySettings(task, true);
  if (!getReady(*device, settings, pause)) return;
  if (!settings.is_quiet)
    fmt::print("{}: {}; end with Ctrl-C\n", toText(device->spec()), scenario.title);

  SilentLink nobody;
  SiteWorld world(scenario, 0, nobody, *device);
  Tally tally;
  const LoopReport loop = run(world, *device, scenario, task, pause, tally);
  const nlohmann::json summary = summarise(*device, world.site(), loop, tally);
  if (task.json) {
    writeOutput(summary.dump(2) + "\n");
  } else if (!task.quiet) {
    print(summary);
  }
  finishOutput();
}

}  // namespace tandem::demos
