#include <algorithm>
#include <cstdio>

#include <ftdi.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/monotonic_clock.h"

namespace tandem {
namespace {

constexpr unsigned kFirst = 0;
/// USB transfers that take longer have failed [ms]. A working chip answers a read within its
/// latency time, at most 16 ms.
constexpr int kWriteTime_ms = 100, kReadTime_ms = 25;
constexpr int kTimedOut = -7;  // error of libusb that ftdi_read_data returns
constexpr int kNotFound = -3, kNotOpened = -4, kNotClaimed = -5;  // of ftdi_usb_open_desc_index

struct ContextDeleter {
  void operator()(ftdi_context* context) const noexcept { ftdi_free(context); }
};
using Context = std::unique_ptr<ftdi_context, ContextDeleter>;

Context makeContext() {
  Context context(ftdi_new());
  if (!context) throw Error("libftdi1 does not start: is there memory, is /dev/bus/usb there?");
  context->usb_read_timeout = kReadTime_ms;
  context->usb_write_timeout = kWriteTime_ms;
  return context;
}

std::string nameOf(const FtdiAddress& address) {
  char ids[16];
  std::snprintf(ids, sizeof ids, "%04x:%04x", static_cast<unsigned>(address.vendor),
                static_cast<unsigned>(address.product));
  return std::string("FTDI ") + ids + (address.serial.empty() ? "" : " " + address.serial);
}

class FtdiTransport final : public ByteTransport {
 public:
  FtdiTransport(Context context, const FtdiAddress& address)
      : context_(std::move(context)), name_(nameOf(address)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

  [[nodiscard]] bool write(const std::uint8_t* bytes, std::size_t count) noexcept override {
    const int size = static_cast<int>(count);
    return ftdi_write_data(context_.get(), bytes, size) == size;
  }

  [[nodiscard]] std::ptrdiff_t read(std::uint8_t* bytes, std::size_t room,
                                    double wait) noexcept override {
    const double until = readMonotonicClock() + wait;
    // The chip answers within its latency time, also if it has no data.
    for (;;) {
      const int count = readOnce(bytes, static_cast<int>(room));
      if (count != 0 || readMonotonicClock() >= until) return count;
    }
  }

  [[nodiscard]] bool setLine(const SerialLine& line) noexcept override {
    ftdi_context* ftdi = context_.get();
    return ftdi_setrts(ftdi, line.rts) == 0 && ftdi_setdtr(ftdi, line.dtr) == 0 &&
           ftdi_set_baudrate(ftdi, line.baud) == 0 &&
           ftdi_set_line_property(ftdi, BITS_8, STOP_BIT_1, NONE) == 0 &&
           ftdi_setflowctrl(ftdi, SIO_DISABLE_FLOW_CTRL) == 0 &&
           ftdi_set_latency_timer(ftdi, static_cast<unsigned char>(line.latency_ms)) == 0;
  }

  void purge() noexcept override { ftdi_tcioflush(context_.get()); }

 private:
  /// Reads the rest of the last transfer, or one new transfer. The library would read until all
  /// requested bytes are there, and a second transfer waits for the latency time.
  int readOnce(std::uint8_t* bytes, int room) noexcept {
    const int first = ftdi_read_data(context_.get(), bytes, std::min(room, 1));
    if (first <= 0) return first == kTimedOut ? 0 : first;
    const int left = static_cast<int>(context_->readbuffer_remaining);
    return first + ftdi_read_data(context_.get(), bytes + first, std::min(room - first, left));
  }

  Context context_;
  std::string name_;
};

}  // namespace

std::vector<FtdiAddress> findFtdi(const FtdiAddress& like) {
  const Context context = makeContext();
  ftdi_device_list* list = nullptr;
  std::vector<FtdiAddress> found;
  if (ftdi_usb_find_all(context.get(), &list, like.vendor, like.product) < 0) return found;
  for (const ftdi_device_list* one = list; one; one = one->next) {
    char serial[128] = "";
    if (ftdi_usb_get_strings(context.get(), one->dev, nullptr, 0, nullptr, 0, serial,
                             sizeof serial) != 0)
      serial[0] = '\0';
    if (like.serial.empty() || like.serial == serial)
      found.push_back({like.vendor, like.product, serial});
  }
  ftdi_list_free(&list);
  return found;
}

std::unique_ptr<ByteTransport> openFtdi(const FtdiAddress& address) {
  Context context = makeContext();
  ftdi_set_interface(context.get(), INTERFACE_A);
  const char* serial = address.serial.empty() ? nullptr : address.serial.c_str();
  const int result = ftdi_usb_open_desc_index(context.get(), address.vendor, address.product,
                                              nullptr, serial, kFirst);
  if (result == kNotFound)
    throw Error(nameOf(address) + " is not plugged in; see tandem device list");
  if (result < 0) {
    const char* remedy = "plug it in again";
    if (result == kNotOpened) remedy = "install the udev rule of Tandem and plug it in again";
    if (result == kNotClaimed) remedy = "end the other program that uses it";
    throw Error(nameOf(address) + " cannot be opened (" + ftdi_get_error_string(context.get()) +
                "); " + remedy);
  }
  return std::make_unique<FtdiTransport>(std::move(context), address);
}

}  // namespace tandem
