// Events of a gamepad, and the files of the system folder. The first byte of the input selects: an
// input device whose ranges and events are the input's bytes, or a file of capabilities.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "devices/fake_event_port.h"
#include "falcon/src/gamepad/event_bits.h"
#include "falcon/src/gamepad/gamepad_axes.h"

namespace tandem {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// Takes numbers from the input; zeros after its end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  template <typename Number>
  Number take() {
    Number number{};
    const std::size_t size = std::min(sizeof number, left_);
    std::memcpy(&number, data_, size);
    data_ += size;
    left_ -= size;
    return number;
  }
  [[nodiscard]] bool isEmpty() const noexcept { return left_ == 0; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

void checkEvents(Bytes bytes) {
  test::FakeEventDevice device;
  device.setFeel(static_cast<Feel>(bytes.take<std::uint8_t>() % 3));
  for (const int code : {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ, ABS_HAT0Y}) {
    const auto value = bytes.take<std::int32_t>(), low = bytes.take<std::int32_t>();
    device.setAxis(code, {value, low, bytes.take<std::int32_t>()});
  }
  const auto port = device.open();
  GamepadAxes axes(*port);
  while (!bytes.isEmpty()) {
    const auto type = bytes.take<std::uint16_t>(), code = bytes.take<std::uint16_t>();
    if (axes.take({type, code, bytes.take<std::int32_t>()}) == GamepadNews::kLost)
      axes.readAll(*port);
    const GamepadState state = axes.state();
    for (const double part : state.sticks) require(std::abs(part) <= 1.0);
    require(state.buttons < 0x10000U);
  }
}

void checkText(std::string_view text) {
  for (const std::size_t word : {4, 8}) {
    const auto bits = falcon_detail::parseEventBits(text, word);
    require(!bits.has(8 * bits.bytes.size()));
    (void)falcon_detail::isGamepad(bits, bits);
  }
  for (const char c : falcon_detail::toPrintable(text)) require(c >= ' ' && c <= '~');
}

}  // namespace
}  // namespace tandem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  if (data[0] % 2 == 0)
    tandem::checkEvents({data + 1, size - 1});
  else
    tandem::checkText({reinterpret_cast<const char*>(data + 1), size - 1});
  return 0;
}
