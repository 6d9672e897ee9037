#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "device/bars.h"
#include "device/check_push.h"
#include "device/device_task.h"
#include "device/get_ready.h"
#include "device/open_device.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"

namespace tandem::demos {
namespace {

constexpr double kForce = 1.0;           // force of a push [N]
constexpr double kShown = 0.06;          // longest way that position bars show [m]
constexpr double kShownPush = 0.01;      // longest way that push bars show [m]
constexpr double kLook = 10.0;           // time in which the user moves [s]
constexpr double kLookUnattended = 0.5;  // [s]

/// The user moves, and bars follow. Returns false if asked to end.
bool lookAtPositions(LiveDevice& device, double duration, StatusLine& line, const Pause& pause) {
  if (!device.emulated())
    line.print(fmt::format("Move the grip for {:.0f} s and see that the bars follow.", duration));
  return exchange(device, duration, pause, [&](double, const DeviceSample& sample) {
    if (line.isDue()) {
      const Vec3& p = sample.hip.p_W;
      line.show(fmt::format("away {} {:+5.1f}  left {} {:+5.1f}  up {} {:+5.1f} mm{}",
                            makeBar(p.x(), kShown, 8), 1e3 * p.x(), makeBar(p.y(), kShown, 8),
                            1e3 * p.y(), makeBar(p.z(), kShown, 8), 1e3 * p.z(),
                            sample.valid ? "" : "  no position"));
    }
    return Vec3(Vec3::Zero());
  });
}

std::string showPush(const std::string& where, double force, double way) {
  return fmt::format("push {:<12} force {} {:.2f} N  grip {} {:+5.1f} mm", where,
                     makeLevel(force, kForce, 10), force, makeBar(way, kShownPush, 10), 1e3 * way);
}

nlohmann::json toJson(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::json toJson(const LiveDevice& device, const std::vector<Push>& pushes) {
  nlohmann::json j = {{"device", toText(device.spec())}, {"pushes", nlohmann::json::array()}};
  for (const Push& one : pushes) {
    nlohmann::json push = {{"where", one.where},
                           {"force", toJson(one.asked_W)},
                           {"moved", toJson(one.moved_W)},
                           {"fault", one.fault}};
    if (one.felt_W) push["felt"] = toJson(*one.felt_W);
    j["pushes"].push_back(push);
  }
  return j;
}

}  // namespace

bool checkDevice(const DeviceTask& task, const Pause& pause) {
  const auto device = openDevice(task.device, placeAlone(), UserWish::kRest);
  GetReadySettings settings = makeGetReadySettings(task, false);
  if (!getReady(*device, settings, pause)) return true;
  std::vector<Push> pushes;
  {
    StatusLine line(settings.is_quiet);
    const double look = task.duration.value_or(device->emulated() ? kLookUnattended : kLook);
    if (!lookAtPositions(*device, look, line, pause)) return true;
    const double force = std::min(kForce, device->capabilities().max_force);
    if (force > 0.0) {
      if (!device->emulated())
        line.print("Hold the grip loosely: it is pushed along each axis in turn.");
      settings.to_middle = true;
      if (!getReady(*device, settings, pause)) return true;
      pushes = pushEachWay(*device, force, pause, [&](const Push& push, double now, double way) {
        if (line.isDue()) line.show(showPush(push.where, now, way));
      });
    } else {
      line.print("It renders no force; there is nothing more to check.");
    }
  }
  const bool is_good =
      std::all_of(pushes.begin(), pushes.end(), [](const Push& one) { return one.fault.empty(); });
  if (task.json) {
    writeOutput(toJson(*device, pushes).dump(2) + "\n");
  } else if (!task.quiet) {
    for (const Push& one : pushes)
      fmt::print("{}  {}\n",
                 showPush(one.where, one.asked_W.norm(), one.asked_W.normalized().dot(one.moved_W)),
                 one.fault.empty() ? "ok" : one.fault);
  }
  finishOutput();
  return is_good || !device->emulated();
}

}  // namespace tandem::demos
