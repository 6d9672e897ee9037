#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tandem/plugin/datagram_carrier.h"

#include "plugin/doors/dds/site_states.h"

namespace tandem::demos {

/// Throws UsageError that names `option` if the program was built without Cyclone DDS. The calls
/// below do so, too.
void checkDds(const std::string& option);

/// Throws as DdsCarrier does.
[[nodiscard]] std::unique_ptr<DatagramCarrier> makeDdsCarrier(int domain, PeerId self,
                                                              const std::vector<PeerId>& peers);

/// Publishes states in clear. One thread; may wait, as StatePublisher says.
using PublishStates = std::function<void(const SiteStates&)>;
/// Throws as StatePublisher does.
[[nodiscard]] PublishStates makeDdsPublisher(int domain);

}  // namespace tandem::demos
