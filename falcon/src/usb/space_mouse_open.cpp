#include <algorithm>

#include "tandem/falcon/space_mouse_device.h"

#include "hid/space_mouse_report.h"

namespace tandem {

std::vector<HidAddress> findSpaceMice() {
  std::vector<HidAddress> found = findHid();
  found.erase(std::remove_if(found.begin(), found.end(),
                             [](const HidAddress& address) { return !isSpaceMouse(address); }),
              found.end());
  return found;
}

std::unique_ptr<HidPort> openSpaceMouse(const std::string& path) {
  HidAddress address;
  address.path = path;
  if (!path.empty()) return openHid(address);
  const std::vector<HidAddress> found = findSpaceMice();
  if (found.empty()) throw Error("there is no SpaceMouse; plug one in, see tandem device list");
  return openHid(found.front());
}

}  // namespace tandem
