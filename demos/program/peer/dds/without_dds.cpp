#include "peer/dds/dds_bus.h"
#include "terminal/usage_error.h"

namespace tandem::demos {

void checkDds(const std::string& option) {
  throw UsageError(
      option +
      ": this program is built without Cyclone DDS (cyclonedds-dev, cyclonedds-tools); "
      "scripts/packages.sh install dds, then configure and build again");
}

std::unique_ptr<DatagramCarrier> makeDdsCarrier(int, PeerId, const std::vector<PeerId>&) {
  checkDds("--carrier");
  return nullptr;
}

PublishStates makeDdsPublisher(int) {
  checkDds("--publish");
  return {};
}

}  // namespace tandem::demos
