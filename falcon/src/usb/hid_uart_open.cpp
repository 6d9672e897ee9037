#include "hid/hid_uart.h"

namespace tandem {

std::unique_ptr<ByteTransport> openHidUart(const HidAddress& address) {
  requireFastBridge(address);
  const std::vector<HidAddress> found = findHid(address);
  // A node that udev does not list can still be opened by its path.
  const HidAddress& chosen = found.empty() ? address : found.front();
  requireFastBridge(chosen);
  return makeHidUart(openHid(chosen));
}

}  // namespace tandem
