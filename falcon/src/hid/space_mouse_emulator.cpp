#include "hid/space_mouse_emulator.h"

#include <algorithm>

namespace tandem {
namespace {

constexpr int kZeros = 3;

}  // namespace

std::vector<std::uint8_t> makeSpaceMouseDescriptor(SpaceMouseLayout layout) {
  std::vector<std::uint8_t> bytes = {
      0x05, 0x01, 0x09, 0x08, 0xA1, 0x01,              // generic desktop, multi-axis, application
      0xA1, 0x00, 0x85, 0x01,                          // report 1
      0x16, 0xA2, 0xFE, 0x26, 0x5E, 0x01, 0x75, 0x10,  // -350 to 350 in 16 bits
      0x95, 0x03, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32,  // x y z
      0x81, 0x02};
  if (layout == SpaceMouseLayout::kOld)
    bytes.insert(bytes.end(), {0xC0, 0xA1, 0x00, 0x85, 0x02});                // report 2
  bytes.insert(bytes.end(), {0x95, 0x03, 0x09, 0x33, 0x09, 0x34, 0x09, 0x35,  // rx ry rz
                             0x81, 0x02, 0xC0,                                //
                             0xA1, 0x00, 0x85, 0x03, 0x05, 0x09,              // report 3, buttons
                             0x19, 0x01, 0x29, 0x10, 0x15, 0x00, 0x25, 0x01,  // 1 to 16
                             0x75, 0x01, 0x95, 0x10, 0x81, 0x02, 0xC0, 0xC0});
  return bytes;
}

void SpaceMouseEmulator::move(const std::array<std::int16_t, 6>& counts) noexcept {
  counts_ = counts;
  const bool is_at_rest = std::all_of(counts.begin(), counts.end(), [](int c) { return c == 0; });
  if (!is_at_rest) {
    remaining_ = -1;
  } else if (remaining_ < 0) {
    remaining_ = layout_ == SpaceMouseLayout::kOld ? 2 * kZeros : kZeros;
    tells_turn_ = false;
  }
}

void SpaceMouseEmulator::press(std::uint16_t buttons) noexcept {
  buttons_changed_ = buttons_changed_ || buttons != buttons_;
  buttons_ = buttons;
}

std::optional<HidReport> SpaceMouseEmulator::next(double now) noexcept {
  if (buttons_changed_) {
    buttons_changed_ = false;
    return HidReport{
        {3, static_cast<std::uint8_t>(buttons_), static_cast<std::uint8_t>(buttons_ >> 8)}, 3};
  }
  if (remaining_ == 0) {
    due_ = std::max(due_, now);  // the first report of a motion comes at once
    return std::nullopt;
  }
  if (now < due_) return std::nullopt;
  due_ += kPeriod;
  if (remaining_ > 0) --remaining_;
  return makeMotion();
}

HidReport SpaceMouseEmulator::makeMotion() noexcept {
  HidReport report;
  const bool is_new = layout_ == SpaceMouseLayout::kNew;
  const std::size_t first = !is_new && tells_turn_ ? 3 : 0, count = is_new ? 6 : 3;
  report.bytes[0] = first == 3 ? 2 : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = static_cast<std::uint16_t>(counts_[first + i]);
    report.bytes[1 + 2 * i] = static_cast<std::uint8_t>(bits);
    report.bytes[2 + 2 * i] = static_cast<std::uint8_t>(bits >> 8);
  }
  report.size = 1 + 2 * count;
  tells_turn_ = !tells_turn_;
  return report;
}

}  // namespace tandem
