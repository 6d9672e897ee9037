#include "hid/hid_stream.h"

#include <cmath>
#include <utility>

#include "tandem/coordination/types.h"
#include "tandem/falcon/monotonic_clock.h"

#include "guard/settings_check.h"

//   constructor     reader's thread                                          writer's thread
//   connect() ----> readUntilGone() ---> disconnect() ---> wait, connect()
//       |               ^                     |                   |
//       |               +---------------------|-------------------+
//       +-----------------------------------------------------------------> writeUntilGone()
//
// The thread that first notices the loss of the device or the end of the stream sets a flag for the
// other one. The writer's thread ends before its port is closed.

namespace tandem {
namespace {

// Enough to fade 8 N by 2 N per report, with reports to spare.
constexpr int kLastReports = 6;
constexpr double kLastPeriod = 1e-3;  // [s]

/// Longest time before a reader without reports notices the end of the stream [s].
constexpr double kReadWait = 0.02;

HidStreamSettings checked(const HidStreamSettings& settings) {
  using falcon_detail::require;
  require(std::isfinite(settings.write_period) && settings.write_period >= 0.0,
          "write_period of the HID stream", settings.write_period, "finite and at least 0 [s]");
  require(std::isfinite(settings.first_retry) && settings.first_retry > 0.0,
          "first_retry of the HID stream", settings.first_retry, "finite and above 0 [s]");
  require(std::isfinite(settings.longest_retry) && settings.longest_retry >= settings.first_retry,
          "longest_retry of the HID stream", settings.longest_retry,
          "finite, at least first_retry");
  return settings;
}

}  // namespace

HidReport HidClient::giveReport(double) noexcept { return {}; }
HidReport HidClient::giveLastReport(double) noexcept { return {}; }

HidStreamSettings withoutWriting(HidStreamSettings settings) noexcept {
  settings.write_period = 0.0;
  return settings;
}

HidStream::HidStream(HidOpener open, HidClient& client, const HidStreamSettings& settings)
    : open_(std::move(open)),
      client_(client),
      settings_(checked(settings)),
      reader_("HID device", settings_.first_retry, settings_.longest_retry) {
  connect();
  try {
    reader_.start({[this] { readUntilGone(); }, [this] { disconnect(); }, [this] { connect(); }});
  } catch (...) {
    reader_.end();
    disconnect();
    throw;
  }
}

HidStreamCounters HidStream::counters() const noexcept {
  return {reports_, refused_, written_, write_misses_, reader_.losses()};
}

void HidStream::connect() {
  std::unique_ptr<HidPort> port = open_();
  if (!port) throw Error("the HID device's opener gave no port");
  is_gone_ = false;
  reader_.setName(port->name());
  port_ = std::move(port);
  client_.setConnected(true);
  startWriter();
  is_connected_ = true;
}

void HidStream::startWriter() {
  if (settings_.write_period <= 0.0) return;
  try {
    writer_ = std::thread([this] { writeUntilGone(); });
  } catch (...) {
    client_.setConnected(false);
    port_.reset();
    throw;
  }
}

void HidStream::disconnect() noexcept {
  is_gone_ = true;
  is_connected_ = false;
  client_.setConnected(false);
  if (writer_.joinable()) writer_.join();
  port_.reset();
}

void HidStream::readUntilGone() noexcept {
  HidReport report;
  while (!reader_.isEnding() && !is_gone_) {
    const std::ptrdiff_t size = port_->read(report.bytes.data(), report.bytes.size(), kReadWait);
    if (size < 0) return;
    if (size == 0) continue;
    if (!client_.takeReport(report.bytes.data(), static_cast<std::size_t>(size),
                            readMonotonicClock()))
      ++refused_;
    ++reports_;  // counted last: a thread that sees the count also sees the report's effect
  }
}

void HidStream::writeUntilGone() noexcept {
  const double period = settings_.write_period;
  double next = readMonotonicClock();
  while (!reader_.isEnding() && !is_gone_) {
    send(client_.giveReport(readMonotonicClock()));
    next += period;
    const double now = readMonotonicClock();
    if (now > next) {
      const double missed = std::floor((now - next) / period) + 1.0;
      write_misses_ += static_cast<std::uint64_t>(missed);
      next += missed * period;
    }
    sleepUntil(next);
  }
  sayLastWords();
}

/// Also writes to a device that seems gone: perhaps only one report failed.
void HidStream::sayLastWords() noexcept {
  for (int i = 0; i < kLastReports; ++i) {
    send(client_.giveLastReport(readMonotonicClock()));
    sleepFor(kLastPeriod);
  }
}

void HidStream::send(const HidReport& report) noexcept {
  if (report.size == 0) return;
  if (port_->write(report.bytes.data(), report.size))
    ++written_;
  else
    is_gone_ = true;
}

}  // namespace tandem
