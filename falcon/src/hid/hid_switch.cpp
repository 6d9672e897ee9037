#include "tandem/falcon/hid_switch.h"

#include <algorithm>
#include <utility>

#include "guard/settings_check.h"
#include "hid/hid_stream.h"

namespace tandem {
namespace {

std::size_t leastSize(const HidSwitchMap& map) noexcept {
  return map.byte + (map.kind == HidSwitchKind::kUsage ? 2 : 1);
}

HidSwitchMap checked(const HidSwitchMap& map) {
  using falcon_detail::require;
  require(map.report >= 0 && map.report <= 255, "report of the HID switch", map.report,
          "an identifier of 1 to 255, or 0");
  require(leastSize(map) <= kMostHidReport, "byte of the HID switch", static_cast<double>(map.byte),
          "within a report of 65 bytes");
  require(map.value > 0 && (map.kind == HidSwitchKind::kUsage || map.value <= 255),
          "value of the HID switch", map.value, "1 to 255, a usage to 65535");
  return map;
}

bool isOf(const HidSwitchMap& map, const std::uint8_t* report, std::size_t size) noexcept {
  return size > 0 && (map.report == 0 || report[0] == map.report);
}

}  // namespace

std::optional<bool> readSwitch(const HidSwitchMap& map, const std::uint8_t* report,
                               std::size_t size) noexcept {
  if (!isOf(map, report, size) || size < leastSize(map)) return std::nullopt;
  const std::uint8_t* at = report + map.byte;
  switch (map.kind) {
    case HidSwitchKind::kKey:
      return std::find(at, report + size, map.value) != report + size;
    case HidSwitchKind::kUsage:
      return (at[0] | at[1] << 8) == map.value;
    default:
      return (*at & map.value) != 0;
  }
}

class HidSwitch::Client final : public HidClient {
 public:
  explicit Client(const HidSwitchMap& map) : map_(map) {}

  [[nodiscard]] bool takeReport(const std::uint8_t* report, std::size_t size,
                                double) noexcept override {
    if (!isOf(map_, report, size)) return size > 0;
    const std::optional<bool> is_pressed = readSwitch(map_, report, size);
    is_pressed_ = is_pressed.value_or(false);
    return is_pressed.has_value();
  }
  void setConnected(bool) noexcept override { is_pressed_ = false; }
  [[nodiscard]] bool isPressed() const noexcept { return is_pressed_; }

 private:
  HidSwitchMap map_;
  std::atomic<bool> is_pressed_{false};
};

HidSwitch::HidSwitch(HidOpener open, const HidSwitchMap& map, const HidStreamSettings& settings)
    : client_(std::make_unique<Client>(checked(map))),
      stream_(std::make_unique<HidStream>(std::move(open), *client_, withoutWriting(settings))) {}

HidSwitch::~HidSwitch() = default;

bool HidSwitch::isPressed() const noexcept { return client_->isPressed(); }

}  // namespace tandem
