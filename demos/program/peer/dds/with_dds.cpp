#include "peer/dds/dds_bus.h"
#include "plugin/doors/dds/dds_carrier.h"
#include "plugin/doors/dds/state_publisher.h"

namespace tandem::demos {

void checkDds(const std::string&) {}

std::unique_ptr<DatagramCarrier> makeDdsCarrier(int domain, PeerId self,
                                                const std::vector<PeerId>& peers) {
  return std::make_unique<DdsCarrier>(domain, self, peers);
}

PublishStates makeDdsPublisher(int domain) {
  // A function can be copied: all copies share the publisher.
  const auto publisher = std::make_shared<StatePublisher>(domain);
  return [publisher](const SiteStates& states) { publisher->publish(states); };
}

}  // namespace tandem::demos
