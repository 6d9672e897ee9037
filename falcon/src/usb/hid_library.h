#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <hidapi/hidapi.h>

namespace tandem::falcon_detail {

/// hidapi for as long as somebody needs it: the first to ask starts it, the last to go ends it.
/// Throws tandem::Error if it does not start.
class HidLibrary {
 public:
  HidLibrary();
  ~HidLibrary();
  HidLibrary(const HidLibrary&) = delete;
  HidLibrary& operator=(const HidLibrary&) = delete;

  /// To be held while devices are looked for or opened: hidapi keeps the text of the last such
  /// error in one place for all threads.
  [[nodiscard]] static std::unique_lock<std::mutex> lock();
};

struct HidCloser {
  void operator()(hid_device* device) const noexcept { hid_close(device); }
};
using HidHandle = std::unique_ptr<hid_device, HidCloser>;

/// What hidapi says of the last error of a device, or of all that has none; a copy. Only under the
/// lock, or by the one thread that uses the device.
[[nodiscard]] std::string textOfError(hid_device* device);

/// hidapi's wide text; what is not printable ASCII becomes '?'.
[[nodiscard]] std::string toNarrow(const wchar_t* text);

}  // namespace tandem::falcon_detail
