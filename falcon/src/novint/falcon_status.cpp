#include "tandem/falcon/falcon_status.h"

#include <algorithm>

#include "novint/falcon_boot.h"

namespace tandem {

const char* nameOf(FalconState state) noexcept {
  switch (state) {
    case FalconState::kClosed:
      return "closed";
    case FalconState::kBoot:
      return "boot";
    case FalconState::kLoading:
      return "loading";
    case FalconState::kUnhomed:
      return "unhomed";
    case FalconState::kReady:
      return "ready";
    case FalconState::kFault:
      return "fault";
  }
  return "unknown";
}

const char* textOf(FalconFault fault) noexcept {
  switch (fault) {
    case FalconFault::kNone:
      return "no fault";
    case FalconFault::kCannotOpen:
      return "cannot be opened; plug it in, and see that you may use it";
    case FalconFault::kUnplugged:
      return "is gone; plug it in again";
    case FalconFault::kNoFirmware:
      return "has no firmware; give the path of the image from the Falcon's own software";
    case FalconFault::kNoBootLoader:
      return "boot loader does not answer; switch its power off and on";
    case FalconFault::kNoBootEcho:
      return "boot loader stopped in the image; switch its power off and on, check the image";
    case FalconFault::kWrongBootEcho:
      return "boot loader echoes wrong bytes; use another cable or port";
    case FalconFault::kNotRunning:
      return "took the image but does not run it; check that the image is for this device";
    case FalconFault::kNoReply:
      return "does not answer";
    case FalconFault::kDamagedReplies:
      return "answers with damaged frames; use another cable or port";
    case FalconFault::kFirmwareLost:
      return "lost its firmware; it is booted again";
    case FalconFault::kHomingLost:
      return "lost its homing; pull the grip all the way out and push it in";
    case FalconFault::kOutOfReach:
      return "reports an impossible position; switch its power off and on";
  }
  return "unknown fault";
}

FalconFault faultOf(BootFault fault) noexcept {
  switch (fault) {
    case BootFault::kNone:
      return FalconFault::kNone;
    case BootFault::kNoImage:
      return FalconFault::kNoFirmware;
    case BootFault::kNoAnswer:
      return FalconFault::kNoBootLoader;
    case BootFault::kNoEcho:
      return FalconFault::kNoBootEcho;
    case BootFault::kWrongEcho:
      return FalconFault::kWrongBootEcho;
    case BootFault::kNotRunning:
      return FalconFault::kNotRunning;
  }
  return FalconFault::kNone;
}

void FalconRoundTrips::add(double time) noexcept {
  least = count == 0 ? time : std::min(least, time);
  most = std::max(most, time);
  sum += time;
  ++count;
  const double bin = std::clamp(time / kBin, 0.0, static_cast<double>(bins.size() - 1));
  ++bins[static_cast<std::size_t>(bin)];
}

}  // namespace tandem
