#include "device/device_report.h"

namespace tandem::demos {
namespace {

bool isBootFault(FalconFault fault) {
  switch (fault) {
    case FalconFault::kNoFirmware:
    case FalconFault::kNoBootLoader:
    case FalconFault::kNoBootEcho:
    case FalconFault::kWrongBootEcho:
    case FalconFault::kNotRunning:
      return true;
    default:
      return false;
  }
}

std::string describeTrouble(const FalconStatus& status) {
  if (status.fault == FalconFault::kNone) return "";
  if (status.fault == FalconFault::kCannotOpen && status.open_error[0] != '\0')
    return status.open_error.data();
  return textOf(status.fault);
}

}  // namespace

DeviceReport describe(const FalconStatus& status) {
  DeviceReport report;
  report.state = nameOf(status.state);
  report.trouble = describeTrouble(status);
  report.is_ready = status.state == FalconState::kReady;
  report.is_hopeless = status.state == FalconState::kFault && isBootFault(status.fault);
  report.is_starting = status.state == FalconState::kClosed || status.state == FalconState::kBoot ||
                       status.state == FalconState::kLoading;
  report.homed = status.homed;
  report.loaded = status.loaded;
  report.image = status.image;
  report.buttons = status.buttons;
  report.readings = status.replies;
  report.round_trips = status.round_trips;
  report.counters = {{"frames", status.frames},
                     {"replies", status.replies},
                     {"late", status.late},
                     {"missing", status.missing},
                     {"short replies", status.short_replies},
                     {"dropped bytes", status.dropped_bytes},
                     {"resyncs", status.resyncs},
                     {"jumps", status.jumps},
                     {"faults", status.faults},
                     {"boots", status.boots},
                     {"opened", status.opened}};
  return report;
}

}  // namespace tandem::demos
