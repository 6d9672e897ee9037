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
    appendArmActs(all);
    return all;
  }();
  return acts;
}

std::size_t countWorldActs() {
  static const std::size_t count = [] {
    std::vector<GuestAct> of_arms;
    appendArmActs(of_arms);
    return guestActs().size() - of_arms.size();
  }();
  return count;
}

}  // namespace tandem::demos::bench
