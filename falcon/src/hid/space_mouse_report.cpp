#include "hid/space_mouse_report.h"

#include <algorithm>

namespace tandem {
namespace {

enum Report : std::uint8_t { kFirst = 1, kSecond = 2, kButtonBits = 3, kBattery = 0x17 };
constexpr std::size_t kThreeAxes = 7, kSixAxes = 13;

constexpr int kLogitech = 0x046D, k3Dconnexion = 0x256F;
constexpr std::array kOfLogitech = {0xC603, 0xC605, 0xC606, 0xC621, 0xC623, 0xC625,
                                    0xC626, 0xC627, 0xC628, 0xC629, 0xC62B, 0xC640};
constexpr std::array kOf3Dconnexion = {0xC62E, 0xC62F, 0xC631, 0xC632, 0xC633,
                                       0xC635, 0xC636, 0xC638, 0xC63A};
constexpr int kGenericDesktop = 1, kMultiAxis = 8;

/// Reads `count` axes, starting at axis `first`.
void readAxes(const std::uint8_t* from, std::size_t first, std::size_t count,
              SpaceMouseState& state) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = static_cast<std::uint16_t>(from[2 * i] | from[2 * i + 1] << 8);
    const double part = static_cast<std::int16_t>(bits) / kSpaceMouseFull;
    state.axes[first + i] = std::clamp(part, -1.0, 1.0);
  }
}

std::uint32_t readButtons(const std::uint8_t* from, std::size_t count) noexcept {
  std::uint32_t buttons = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(count, 4); ++i)
    buttons |= static_cast<std::uint32_t>(from[i]) << (8 * i);
  return buttons;
}

template <std::size_t N>
bool isIn(const std::array<int, N>& products, int product) noexcept {
  return std::find(products.begin(), products.end(), product) != products.end();
}

}  // namespace

SpaceMouseNews takeSpaceMouseReport(const std::uint8_t* report, std::size_t size,
                                    SpaceMouseState& state) noexcept {
  if (size < 2) return SpaceMouseNews::kRefused;
  const std::uint8_t* content = report + 1;
  switch (report[0]) {
    case kFirst:
      if (size != kThreeAxes && size != kSixAxes) return SpaceMouseNews::kRefused;
      readAxes(content, 0, size == kSixAxes ? 6 : 3, state);
      return size == kSixAxes ? SpaceMouseNews::kBoth : SpaceMouseNews::kPlace;
    case kSecond:
      if (size != kThreeAxes) return SpaceMouseNews::kRefused;
      readAxes(content, 3, 3, state);
      return SpaceMouseNews::kTurn;
    case kButtonBits:
      state.buttons = readButtons(content, size - 1);
      return SpaceMouseNews::kButtons;
    case kBattery:
      return SpaceMouseNews::kNothing;
    default:
      return SpaceMouseNews::kRefused;
  }
}

bool isSpaceMouse(const HidAddress& address) noexcept {
  if (address.usage_page != kGenericDesktop || address.usage != kMultiAxis) return false;
  return (address.vendor == kLogitech && isIn(kOfLogitech, address.product)) ||
         (address.vendor == k3Dconnexion && isIn(kOf3Dconnexion, address.product));
}

}  // namespace tandem
