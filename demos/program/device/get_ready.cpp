#include "device/get_ready.h"

#include <fmt/format.h>

#include "tandem/falcon/monotonic_clock.h"

#include "device/bars.h"
#include "terminal/status_line.h"

namespace tandem::demos {
namespace {

constexpr double kLook = 0.005;    // [s]
constexpr double kMiddle = 0.015;  // largest distance that counts as the middle [m]
constexpr double kShown = 0.06;    // largest distance that the bar shows [m]

std::string showLegs(std::uint8_t homed) {
  std::string text = "homing: ";
  for (int leg = 0; leg < 3; ++leg)
    text += fmt::format("leg {} {}  ", leg + 1, (homed >> leg & 1) != 0 ? "[found]" : "[     ]");
  return text;
}

std::string show(const DeviceReport& report, const LiveDevice& device) {
  if (report.state == "loading")
    return fmt::format("firmware {} {} of {} bytes", makeLevel(report.loaded, report.image, 20),
                       report.loaded, report.image);
  std::string text;
  if (report.is_ready)
    text = fmt::format("to the middle {} {:3.0f} mm",
                       makeLevel(device.distanceFromMiddle(), kShown, 20),
                       1e3 * device.distanceFromMiddle());
  else if (report.homed && report.state == "unhomed")
    text = showLegs(*report.homed);
  else
    text = report.state;
  if (!report.is_ready && !report.trouble.empty()) text += " | " + report.trouble;
  return text;
}

/// Prints three lines, once.
class Instructions {
 public:
  void print(StatusLine& line, const DeviceReport& report, bool to_middle) {
    if (report.homed && report.state == "unhomed" && !told_homing_) {
      told_homing_ = true;
      line.print("1. Pull the grip straight out towards you, as far as it goes.");
      line.print("2. Push it in, all the way: each leg finds its place, the light turns green.");
    }
    const bool is_homing_told = told_homing_ || report.is_ready;
    if (to_middle && is_homing_told && !told_middle_) {
      told_middle_ = true;
      line.print("3. Hold it in the middle of its way; it begins by itself.");
    }
  }

 private:
  bool told_homing_ = false, told_middle_ = false;
};

}  // namespace

bool getReady(LiveDevice& device, const GetReadySettings& settings, const Pause& pause) {
  StatusLine line(settings.is_quiet);
  Instructions instructions;
  const double until = readMonotonicClock() + settings.patience;
  for (;;) {
    const bool is_valid = device.read(0.0).valid;
    device.write(Vec3::Zero());
    const DeviceReport report = device.report();
    const std::string name = toText(device.spec());
    if (report.is_hopeless) throw Error(name + ": " + report.trouble);
    const bool is_ready = is_valid && report.is_ready;
    const bool is_there =
        is_ready && (!settings.to_middle || device.distanceFromMiddle() < kMiddle);
    if (is_there) return true;
    if (report.is_ready == is_valid && !report.is_starting)
      instructions.print(line, report, settings.to_middle);
    if (readMonotonicClock() > until)
      throw Error(fmt::format("{}: not ready within {} s: {}", name, settings.patience,
                              report.trouble.empty() ? show(report, device) : report.trouble));
    if (line.isDue()) line.show(show(report, device));
    if (pause(kLook)) return false;
  }
}

}  // namespace tandem::demos
