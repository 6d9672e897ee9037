// Words for what a relay refuses.

#include "relay/admission_wire.h"
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
    case Result::kWatcher:
      return "watcher";
  }
  return "";
}

std::string explain(const RefuseAnswer& answer) {
  switch (answer.code) {
    case Code::kVersion:
      return "the relay speaks version " + std::to_string(answer.version) + ", this site " +
             std::to_string(kRelayVersion) + "; install the same release";
    case Code::kKey:
      return "the relay has another key; give this site a copy of the relay's key file";
    case Code::kRooms:
      return "all rooms of the relay are in use; raise its --rooms";
    case Code::kMembers:
      return "the room is full; raise the relay's --members, or take another room";
    case Code::kTaken:
      return "another site with this number is in the room; give each site its own";
    case Code::kSession:
      return "the relay has restarted";
  }
  return "the relay says no reason";
}

}  // namespace tandem::relay
