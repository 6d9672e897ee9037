#include "hid/user_evdev.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <sys/ioctl.h>
#include <sys/socket.h>

#include "tandem/coordination/types.h"

namespace tandem::test {
namespace {

void setBit(std::vector<std::uint8_t>& bits, int code) {
  const auto place = static_cast<std::size_t>(code) / 8;
  if (place < bits.size()) bits[place] |= static_cast<std::uint8_t>(1U << (code % 8));
}

/// Copies as much as there is room for, and returns its size as evdev does.
int give(const void* from, std::size_t has, void* to, std::size_t room) {
  const std::size_t size = std::min(has, room);
  std::memcpy(to, from, size);
  return static_cast<int>(size);
}

}  // namespace

UserEvdev::UserEvdev(const std::string& name)
    : UserNode("/dev/input/tandem-" + name, SOCK_NONBLOCK) {}

void UserEvdev::press(int key) {
  const std::lock_guard held(mutex_);
  keys_[static_cast<std::size_t>(key) / 8] |= static_cast<std::uint8_t>(1U << (key % 8));
}

void UserEvdev::send(const void* bytes, std::size_t size) {
  if (::send(ours_, bytes, size, MSG_NOSIGNAL) != static_cast<std::ptrdiff_t>(size))
    throw Error("the input device in user space takes no events");
}

void UserEvdev::send(std::uint16_t type, std::uint16_t code, std::int32_t value) {
  input_event event{};
  event.type = type;
  event.code = code;
  event.value = value;
  send(&event, sizeof event);
}

std::optional<input_event> UserEvdev::receive(double wait) {
  if (!waitForMessage(wait)) return std::nullopt;
  input_event event{};
  if (::recv(ours_, &event, sizeof event, 0) != sizeof event) return std::nullopt;
  return event;
}

std::map<int, ff_effect> UserEvdev::uploaded() {
  const std::lock_guard held(mutex_);
  return uploaded_;
}

int UserEvdev::giveBits(unsigned type, void* to, std::size_t size) {
  std::vector<std::uint8_t> bits(KEY_MAX / 8 + 1);
  if (type == 0)
    for (const int kind : {EV_SYN, EV_KEY, EV_ABS, EV_FF}) setBit(bits, kind);
  if (type == EV_FF)
    for (const int code : effects) setBit(bits, code);
  return give(bits.data(), bits.size(), to, size);
}

int UserEvdev::upload(ff_effect& effect) {
  if (effect.id >= 0 && uploaded_.count(effect.id) == 0) return failWith(EINVAL);
  if (effect.id < 0) effect.id = static_cast<std::int16_t>(uploaded_.size());
  uploaded_[effect.id] = effect;
  return 0;
}

int UserEvdev::control(unsigned long request, void* argument) {
  const std::lock_guard held(mutex_);
  const unsigned number = _IOC_NR(request);
  const std::size_t size = _IOC_SIZE(request);
  if (request == EVIOCSFF) return upload(*static_cast<ff_effect*>(argument));
  if (request == EVIOCRMFF)
    return uploaded_.erase(static_cast<int>(reinterpret_cast<std::intptr_t>(argument))) > 0
               ? 0
               : failWith(EINVAL);
  if (number == _IOC_NR(EVIOCGNAME(0)))
    return give(path().c_str(), path().size() + 1, argument, size);
  if (number == _IOC_NR(EVIOCGKEY(0))) return give(keys_.data(), keys_.size(), argument, size);
  if (number >= _IOC_NR(EVIOCGABS(0)) && number <= _IOC_NR(EVIOCGABS(ABS_MAX))) {
    const auto axis = axes.find(static_cast<int>(number - _IOC_NR(EVIOCGABS(0))));
    return axis == axes.end() ? failWith(EINVAL)
                              : give(&axis->second, sizeof axis->second, argument, size);
  }
  if (number >= _IOC_NR(EVIOCGBIT(0, 0)) && number < _IOC_NR(EVIOCGBIT(EV_MAX, 0)))
    return giveBits(number - _IOC_NR(EVIOCGBIT(0, 0)), argument, size);
  return failWith(EINVAL);
}

}  // namespace tandem::test
