#include "bench/guest/guest_acts.h"

namespace tandem::demos::bench {

const std::vector<GuestAct>& guestActs() {
  static const std::vector<GuestAct> acts = [] {
    std::vector<GuestAct> all;
    appendMassActs(all);
    appendSurfaceActs(all);
    appendMotionActs(all);
    appendPresenceActs(all);
    appendWorldActs(all);
    appendJointActs(all);
    appendSiteActs(all);
    return all;
  }();
  return acts;
}

}  // namespace tandem::demos::bench
