// Reports of HID devices. The first byte of the input selects the device: a SpaceMouse with several
// reports, each after its size; an FT260; a raw HID device, with the CRC as it is or corrected; a
// switch.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "tandem/falcon/hid_switch.h"

#include "falcon/src/hid/ft260_reports.h"
#include "falcon/src/hid/raw_hid_report.h"
#include "falcon/src/hid/space_mouse_report.h"

namespace tandem {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// Each report has its own memory, so that a sanitizer detects reads beyond it.
using Report = std::vector<std::uint8_t>;

void checkSpaceMouse(const Report& input) {
  SpaceMouseState state;
  for (std::size_t i = 0; i < input.size();) {
    const std::size_t size = std::min<std::size_t>(input[i] % 66, input.size() - i - 1);
    const auto first = input.begin() + static_cast<std::ptrdiff_t>(i + 1);
    const Report report(first, first + static_cast<std::ptrdiff_t>(size));
    const SpaceMouseState before = state;
    const SpaceMouseNews news = takeSpaceMouseReport(report.data(), report.size(), state);
    for (const double axis : state.axes) require(axis >= -1.0 && axis <= 1.0);
    if (news == SpaceMouseNews::kRefused || news == SpaceMouseNews::kNothing)
      require(state.axes == before.axes && state.buttons == before.buttons);
    i += 1 + size;
  }
}

void checkFt260(const Report& report) {
  const auto content = decodeUartBytes(report.data(), report.size());
  if (!content) return;
  require(content->count >= 1 && content->count <= kMostUartBytes);
  require(std::equal(content->bytes.begin(),
                     content->bytes.begin() + static_cast<std::ptrdiff_t>(content->count),
                     report.begin() + 2));
  const HidReport again = encodeUartBytes(content->bytes.data(), content->count);
  const auto same = decodeUartBytes(again.bytes.data(), again.size);
  require(same && same->count == content->count && same->bytes == content->bytes);
}

void checkRawHid(const Report& report) {
  const auto state = decodeRawState(report.data(), report.size());
  const auto command = decodeRawCommand(report.data(), report.size());
  require(!(state && command));
  // An accepted report has exactly one form.
  const auto isSame = [&](const RawHidBytes& bytes) {
    return std::equal(bytes.begin(), bytes.end(), report.begin(), report.end());
  };
  if (state) require(isSame(encodeRawState(*state)));
  if (command) require(isSame(encodeRawCommand(*command)));
}

void checkSealed(Report report) {
  if (report.size() == kRawHidSize) {
    const std::uint16_t crc = computeCrc16(report.data(), kRawHidSize - 2);
    report[62] = static_cast<std::uint8_t>(crc);
    report[63] = static_cast<std::uint8_t>(crc >> 8);
  }
  checkRawHid(report);
}

void checkSwitch(const Report& input) {
  if (input.size() < 4) return;
  const HidSwitchMap map{static_cast<HidSwitchKind>(input[0] % 3), input[1] % 4, input[2] % 65U,
                         static_cast<std::uint16_t>(input[3] + 1)};
  const Report report(input.begin() + 4, input.end());
  const auto is_pressed = readSwitch(map, report.data(), report.size());
  require(!is_pressed || report.size() > map.byte);
}

void checkInput(std::uint8_t kind, const Report& input) {
  switch (kind % 5) {
    case 0:
      return checkSpaceMouse(input);
    case 1:
      return checkFt260(input);
    case 2:
      return checkRawHid(input);
    case 3:
      return checkSealed(input);
    default:
      return checkSwitch(input);
  }
}

}  // namespace
}  // namespace tandem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) tandem::checkInput(data[0], {data + 1, data + size});
  return 0;
}
