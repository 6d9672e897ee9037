#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/event_port.h"

#include "gamepad/event_bits.h"
#include "guard/open_file.h"

namespace tandem {
namespace {

using falcon_detail::EventBits;
using falcon_detail::OpenFile;
using falcon_detail::toPrintable;

constexpr std::uint16_t kEffectLength_ms = 1000;  // it stops by itself if the program hangs

ff_effect toKernel(int id, const FeelEffect& effect) noexcept {
  ff_effect kernels{};
  kernels.id = static_cast<std::int16_t>(id);
  kernels.replay.length = kEffectLength_ms;
  if (effect.kind == Feel::kRumble) {
    kernels.type = FF_RUMBLE;
    kernels.u.rumble = {effect.level, effect.level};
  } else {
    kernels.type = FF_CONSTANT;
    kernels.direction = effect.direction;
    kernels.u.constant.level =
        static_cast<std::int16_t>(std::min<std::uint16_t>(effect.level, 0x7FFF));
  }
  return kernels;
}

class EvdevPort final : public EventPort {
 public:
  EvdevPort(OpenFile file, std::string name, Feel feel)
      : file_(std::move(file)), name_(std::move(name)), feel_(feel) {
    if (feel_ != Feel::kNothing) (void)send(FF_GAIN, 0xFFFF);
  }

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }
  [[nodiscard]] Feel feel() const noexcept override { return feel_; }

  [[nodiscard]] std::ptrdiff_t read(InputEvent* events, std::size_t room,
                                    double wait) noexcept override {
    pollfd file{file_.number(), POLLIN, 0};
    const int wait_ms = static_cast<int>(std::ceil(std::clamp(wait, 0.0, 1e6) * 1e3));
    if (::poll(&file, 1, wait_ms) <= 0) return 0;  // a signal is no loss of the device
    std::array<input_event, 64> kernels;
    const std::size_t most = std::min(room, kernels.size());
    const ssize_t size = ::read(file_.number(), kernels.data(), most * sizeof(input_event));
    if (size < 0) return errno == EAGAIN || errno == EINTR ? 0 : -1;
    // The kernel gives whole events only; a part of one counts as a lost device.
    const auto count = static_cast<std::size_t>(size) / sizeof(input_event);
    for (std::size_t i = 0; i < count; ++i)
      events[i] = {kernels[i].type, kernels[i].code, kernels[i].value};
    return count > 0 ? static_cast<std::ptrdiff_t>(count) : -1;
  }

  [[nodiscard]] std::optional<EventAxis> readAxis(std::uint16_t code) noexcept override {
    input_absinfo info{};
    if (code > ABS_MAX || ::ioctl(file_.number(), EVIOCGABS(code), &info) < 0) return std::nullopt;
    return EventAxis{info.value, info.minimum, info.maximum};
  }

  [[nodiscard]] bool readKey(std::uint16_t code) noexcept override {
    EventBits keys;
    return ::ioctl(file_.number(), EVIOCGKEY(sizeof keys.bytes), keys.bytes.data()) >= 0 &&
           keys.has(code);
  }

  [[nodiscard]] int upload(int id, const FeelEffect& effect) noexcept override {
    ff_effect kernels = toKernel(id, effect);
    return ::ioctl(file_.number(), EVIOCSFF, &kernels) < 0 ? -1 : kernels.id;
  }

  bool play(int id, bool is_on) noexcept override {
    return send(static_cast<std::uint16_t>(id), is_on ? 1 : 0);
  }

  void erase(int id) noexcept override { (void)::ioctl(file_.number(), EVIOCRMFF, id); }

 private:
  [[nodiscard]] bool send(std::uint16_t code, std::int32_t value) noexcept {
    input_event event{};
    event.type = EV_FF;
    event.code = code;
    event.value = value;
    return ::write(file_.number(), &event, sizeof event) == sizeof event;
  }

  OpenFile file_;
  std::string name_;
  Feel feel_;
};

OpenFile openFile(const std::string& path) {
  OpenFile file(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  const int reason = errno;
  if (file.number() >= 0) return file;
  if (reason == EACCES || reason == EPERM)
    throw Error(path + " may not be opened; " + kGamepadRights);
  throw Error(path + " cannot be opened (" + std::strerror(reason) + "); see tandem device list");
}

std::string readName(const OpenFile& file) {
  std::array<char, 128> text{};
  if (::ioctl(file.number(), EVIOCGNAME(text.size() - 1), text.data()) < 0) return "input device";
  return toPrintable(text.data());
}

std::unique_ptr<EventPort> openNode(const std::string& path) {
  OpenFile file = openFile(path);
  EventBits kinds, effects;
  if (::ioctl(file.number(), EVIOCGBIT(0, sizeof kinds.bytes), kinds.bytes.data()) < 0)
    throw Error(path + " is no input device; give the path of one, such as /dev/input/event5");
  if (::ioctl(file.number(), EVIOCGBIT(EV_FF, sizeof effects.bytes), effects.bytes.data()) < 0)
    effects = {};
  std::string name = readName(file) + " (" + path + ")";
  return std::make_unique<EvdevPort>(std::move(file), std::move(name),
                                     falcon_detail::chooseFeel(effects));
}

}  // namespace

std::unique_ptr<EventPort> openGamepad(const std::string& path) {
  if (!path.empty()) return openNode(path);
  const std::vector<GamepadAddress> found = findGamepads();
  if (found.empty()) throw Error("there is no gamepad; plug one in, see tandem device list");
  const auto first = std::find_if(found.begin(), found.end(),
                                  [](const GamepadAddress& one) { return one.may_open; });
  return openNode(first != found.end() ? first->path : found.front().path);
}

}  // namespace tandem
