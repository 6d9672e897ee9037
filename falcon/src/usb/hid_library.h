#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <hidapi/hidapi.h>

namespace tandem::falcon_detail {

/// Keeps hidapi initialised while at least one object exists. Throws tandem::Error if hidapi does
/// not start.
class HidLibrary {
 public:
  HidLibrary();
  ~HidLibrary();
  HidLibrary(const HidLibrary&) = delete;
  HidLibrary& operator=(const HidLibrary&) = delete;

  /// Lock to hold while devices are listed or opened: hidapi keeps the text of the last such error
  /// in one place for all threads.
  [[nodiscard]] static std::unique_lock<std::mutex> lock();
};

struct HidCloser {
  void operator()(hid_device* device) const noexcept { hid_close(device); }
};
using HidHandle = std::unique_ptr<hid_device, HidCloser>;

/// Copies hidapi's text of the last error of `device`, or of the last call without one (nullptr).
/// Needs the lock, or the one thread that uses the device.
[[nodiscard]] std::string textOfError(hid_device* device);

/// Converts hidapi's wide text. Anything but printable ASCII becomes '?'.
[[nodiscard]] std::string toNarrow(const wchar_t* text);

}  // namespace tandem::falcon_detail
