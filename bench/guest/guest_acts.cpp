#include "bench/guest/guest_acts.h"

namespace tandem::demos::bench {
namespace {

int countActs(void (*append)(std::vector<GuestAct>& acts)) {
  std::vector<GuestAct> acts;
  append(acts);
  return static_cast<int>(acts.size());
}

}  // namespace

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
    appendMoreActs(all);
    return all;
  }();
  return acts;
}

GuestActRange worldActs() { return {0, armActs().first - 1}; }

GuestActRange armActs() {
  static const int count = countActs(appendArmActs);
  return {moreActs().first - count, moreActs().first - 1};
}

GuestActRange moreActs() {
  static const int count = countActs(appendMoreActs);
  const int all = static_cast<int>(guestActs().size());
  return {all - count, all - 1};
}

}  // namespace tandem::demos::bench
