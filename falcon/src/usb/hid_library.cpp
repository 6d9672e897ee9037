#include "hid_library.h"

#include "tandem/coordination/types.h"

namespace tandem::falcon_detail {
namespace {

std::mutex library_mutex;
int users = 0;

}  // namespace

HidLibrary::HidLibrary() {
  const auto held = lock();
  if (users == 0 && hid_init() != 0)
    throw Error("hidapi does not start (" + textOfError(nullptr) + "); is libudev there?");
  ++users;
}

HidLibrary::~HidLibrary() {
  const auto held = lock();
  if (--users == 0) hid_exit();
}

std::unique_lock<std::mutex> HidLibrary::lock() { return std::unique_lock(library_mutex); }

std::string textOfError(hid_device* device) { return toNarrow(hid_error(device)); }

std::string toNarrow(const wchar_t* text) {
  std::string narrow;
  for (; text && *text != L'\0'; ++text)
    narrow += *text >= L' ' && *text <= L'~' ? static_cast<char>(*text) : '?';
  return narrow;
}

}  // namespace tandem::falcon_detail
