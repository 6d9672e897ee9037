#include "tandem/falcon/hid_port.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>

#include "tandem/coordination/types.h"

#include "guard/open_file.h"
#include "hid_library.h"

// hidapi 0.13 replaces the text of a handle's last error in every call without a lock. Two threads
// on one handle can then free it twice. A port therefore has one handle for reading and one for
// writing. Every open hidraw file gets all input reports; those of the second handle are never
// read.

namespace tandem {
namespace {

using falcon_detail::HidHandle;
using falcon_detail::HidLibrary;

const char* const kRule = "; install the udev rule of Tandem and plug the device in again";

class HidapiPort final : public HidPort {
 public:
  HidapiPort(std::unique_ptr<HidLibrary> library, HidHandle reader, HidHandle writer,
             std::string name)
      : library_(std::move(library)),
        reader_(std::move(reader)),
        writer_(std::move(writer)),
        name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

  [[nodiscard]] std::ptrdiff_t read(std::uint8_t* report, std::size_t room,
                                    double wait) noexcept override {
    const int wait_ms = static_cast<int>(std::clamp(wait, 0.0, 1e6) * 1e3 + 0.5);
    errno = 0;
    const int size = hid_read_timeout(reader_.get(), report, room, wait_ms);
    return size < 0 && errno == EINTR ? 0 : size;  // a signal is no loss of the device
  }

  [[nodiscard]] bool write(const std::uint8_t* report, std::size_t size) noexcept override {
    for (;;) {
      errno = 0;
      const int sent = hid_write(writer_.get(), report, size);
      if (sent >= 0 || errno != EINTR) return sent == static_cast<int>(size);
    }
  }

  [[nodiscard]] bool setFeature(const std::uint8_t* report, std::size_t size) noexcept override {
    return hid_send_feature_report(writer_.get(), report, size) >= 0;
  }

  [[nodiscard]] std::ptrdiff_t getFeature(std::uint8_t* report,
                                          std::size_t room) noexcept override {
    return hid_get_feature_report(writer_.get(), report, room);
  }

 private:
  std::unique_ptr<HidLibrary> library_;  // outlives the handles
  HidHandle reader_, writer_;
  std::string name_;
};

/// Throws unless the path is a hidraw node: hid_open_path() of hidapi 0.13 uses freed memory for
/// other files.
void requireHidraw(const HidAddress& address) {
  const falcon_detail::OpenFile file(::open(address.path.c_str(), O_RDWR | O_CLOEXEC));
  const int reason = errno;
  if (file.number() < 0 && (reason == EACCES || reason == EPERM))
    throw Error("HID " + toText(address) + " may not be opened" + kRule);
  if (file.number() < 0)
    throw Error("HID " + toText(address) + " cannot be opened (" + std::strerror(reason) +
                "); see tandem device list");
  int size = 0;
  if (::ioctl(file.number(), HIDIOCGRDESCSIZE, &size) < 0)
    throw Error(address.path + " is no HID device; give the path of a hidraw node");
}

HidHandle openHandle(const HidAddress& address) {
  HidHandle handle(hid_open_path(address.path.c_str()));
  if (!handle)
    throw Error("HID " + toText(address) + " cannot be opened (" +
                falcon_detail::textOfError(nullptr) + ")" + kRule);
  return handle;
}

std::unique_ptr<HidPort> openPath(const HidAddress& address) {
  auto library = std::make_unique<HidLibrary>();
  const auto held = HidLibrary::lock();
  requireHidraw(address);
  HidHandle reader = openHandle(address), writer = openHandle(address);
  return std::make_unique<HidapiPort>(std::move(library), std::move(reader), std::move(writer),
                                      "HID " + toText(address));
}

}  // namespace

std::vector<HidAddress> findHid(const HidAddress& like) {
  const HidLibrary library;
  const auto held = HidLibrary::lock();
  std::vector<HidAddress> found;
  const auto vendor = static_cast<unsigned short>(like.vendor);
  const auto product = static_cast<unsigned short>(like.product);
  hid_device_info* list = hid_enumerate(vendor, product);
  for (const hid_device_info* one = list; one; one = one->next) {
    const HidAddress address{one->vendor_id,
                             one->product_id,
                             one->usage_page,
                             one->usage,
                             one->interface_number,
                             one->path ? one->path : "",
                             falcon_detail::toNarrow(one->product_string)};
    if (isLike(address, like)) found.push_back(address);
  }
  hid_free_enumeration(list);
  return found;
}

std::unique_ptr<HidPort> openHid(const HidAddress& address) {
  if (!address.path.empty()) return openPath(address);
  const std::vector<HidAddress> found = findHid(address);
  if (found.empty())
    throw Error("HID " + toText(address) + " is not plugged in; see tandem device list");
  return openPath(found.front());
}

}  // namespace tandem
