#include "peer/dds/dds_bus.h"
#include "plugin/doors/dds/dds_carrier.h"

namespace tandem::demos {

void checkDds(const std::string&) {}

std::unique_ptr<DatagramCarrier> makeDdsCarrier(int domain, PeerId self,
                                                const std::vector<PeerId>& peers) {
  return std::make_unique<DdsCarrier>(domain, self, peers);
}

}  // namespace tandem::demos
