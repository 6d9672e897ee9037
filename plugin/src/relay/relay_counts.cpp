#include "relay/relay_counts.h"

namespace tandem::relay {

const char* name(Result result) noexcept {
  switch (result) {
    case Result::kTaken:
      return "taken";
    case Result::kForm:
      return "form";
    case Result::kKey:
      return "key";
    case Result::kCookie:
      return "cookie";
    case Result::kOld:
      return "old";
    case Result::kFull:
      return "full";
    case Result::kIdInUse:
      return "id_in_use";
    case Result::kSession:
      return "unknown_session";
    case Result::kReplayed:
      return "replayed";
    case Result::kForged:
      return "forged";
    case Result::kTooMany:
      return "too_many";
    case Result::kNoReceiver:
      return "no_receiver";
  }
  return "";
}

}  // namespace tandem::relay
