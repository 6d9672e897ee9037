#include <cstdio>

#include "tandem/falcon/hid_port.h"

namespace tandem {

bool isLike(const HidAddress& found, const HidAddress& like) noexcept {
  return (like.vendor == 0 || like.vendor == found.vendor) &&
         (like.product == 0 || like.product == found.product) &&
         (like.usage_page == 0 || like.usage_page == found.usage_page) &&
         (like.usage == 0 || like.usage == found.usage) &&
         (like.interface_number < 0 || like.interface_number == found.interface_number) &&
         (like.path.empty() || like.path == found.path);
}

std::string toText(const HidAddress& address) {
  std::string text;
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : " ") + more; };
  const auto addNumbers = [&add](const char* format, int first, int second) {
    char numbers[48];
    std::snprintf(numbers, sizeof numbers, format, static_cast<unsigned>(first),
                  static_cast<unsigned>(second));
    add(numbers);
  };
  if (address.vendor != 0) addNumbers("%04x:%04x", address.vendor, address.product);
  if (address.vendor == 0 && address.usage_page != 0)
    addNumbers("usage page %04x usage %04x", address.usage_page, address.usage);
  if (!address.product_name.empty()) add(address.product_name);
  if (!address.path.empty()) add("(" + address.path + ")");
  return text.empty() ? "any" : text;
}

}  // namespace tandem
