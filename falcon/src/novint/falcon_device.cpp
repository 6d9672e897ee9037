#include "tandem/falcon/falcon_device.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "tandem/falcon/monotonic_clock.h"

#include "guard/realtime_rights.h"

namespace tandem {
namespace {

constexpr double kMostAge = 0.02;      // of a reading that is still used [s]
constexpr double kOpenPeriod = 0.25;   // from one try to open the line to the next [s]
constexpr double kNap = 0.02;          // so long a stop may have to wait for the thread [s]
constexpr double kStopTime = 0.2;      // for the last frames [s]
constexpr double kWorkspace = 0.05;    // half extents [m]
constexpr double kStiffness = 3000.0;  // that still feels calm [N/m]

}  // namespace

FalconDevice::FalconDevice(const FalconSettings& settings, FirmwareImage image, OpenTransport open)
    : open_(std::move(open)),
      priority_(settings.thread_priority),
      driver_(settings, std::move(image)) {
  capabilities_.name = "Novint Falcon";
  capabilities_.max_force = settings.force.max_force;
  capabilities_.max_slew = settings.force.max_slew;
  capabilities_.max_stiffness = kStiffness;
  capabilities_.workspace = Vec3::Constant(kWorkspace);
  thread_ = std::thread([this] { run(); });
}

FalconDevice::~FalconDevice() {
  stops_.store(true, std::memory_order_relaxed);
  thread_.join();
}

DeviceSample FalconDevice::read(double now) noexcept {
  const FalconReading& reading = reading_.read();
  if (reading.number != newest_) {
    newest_ = reading.number;
    newest_since_ = now;
  }
  // Also false for a time that is no number, or runs back.
  const bool is_fresh = now >= newest_since_ && now - newest_since_ <= kMostAge;
  DeviceSample sample;
  sample.valid = reading.is_valid && is_fresh;
  sample.hip.p_W = Vec3(reading.p[0], reading.p[1], reading.p[2]);
  if (sample.valid) sample.hip.v_W = Vec3(reading.v[0], reading.v[1], reading.v[2]);
  return sample;
}

void FalconDevice::write(const Vec3& f_W) noexcept {
  wish_.write({{f_W.x(), f_W.y(), f_W.z()}, ++wishes_});
}

void FalconDevice::run() noexcept {
  RealtimeRights rights;
  rights.take(priority_, false);
  while (!stops_.load(std::memory_order_relaxed)) {
    const double tried_at = readMonotonicClock();
    if (const std::unique_ptr<ByteTransport> line = tryOpen()) serve(*line);
    while (readMonotonicClock() - tried_at < kOpenPeriod && !stops_.load(std::memory_order_relaxed))
      sleepFor(kNap);
  }
}

std::unique_ptr<ByteTransport> FalconDevice::tryOpen() noexcept {
  const double now = readMonotonicClock();
  try {
    std::unique_ptr<ByteTransport> line = open_();
    if (line) {
      open_error_ = {};
      seen_wish_ = wish_.read().number;  // who asked for it may be gone by now
      driver_.connect(now);
      passOn();
      return line;
    }
  } catch (const std::exception& error) {
    const std::string_view text = error.what();
    open_error_ = {};
    std::copy_n(text.begin(), std::min(text.size(), open_error_.size() - 1), open_error_.begin());
  } catch (...) {  // whatever the caller's function threw, this thread goes on
  }
  driver_.disconnect(FalconFault::kCannotOpen, now);
  passOn();
  return nullptr;
}

/// Until the line is gone, or the device is stopped.
void FalconDevice::serve(ByteTransport& line) noexcept {
  while (!stops_.load(std::memory_order_relaxed) && exchange(line)) passOn();
  giveLastFrames(line);
  if (!stops_.load(std::memory_order_relaxed))
    driver_.disconnect(FalconFault::kUnplugged, readMonotonicClock());
  passOn();
}

/// The device keeps the last force it was told, and a line that failed may yet take something:
/// the force goes frame by frame, or at once if only one frame more can be sent.
void FalconDevice::giveLastFrames(ByteTransport& line) noexcept {
  driver_.beginStop();
  const double until = readMonotonicClock() + kStopTime;
  for (double now = readMonotonicClock(); !driver_.hasStopped() && now < until;
       now = readMonotonicClock()) {
    const LineStep step = driver_.advance(now);
    if (!perform(step, line)) break;
    sleepFor(std::max(step.next - now, 0.0));
  }
  if (driver_.hasStopped()) return;
  LineStep rest;
  rest.send(encodeCommand({{}, true, 0}).data(), kFalconFrameSize);
  (void)perform(rest, line);
}

bool FalconDevice::exchange(ByteTransport& line) noexcept {
  const double now = readMonotonicClock();
  if (const Wish& wish = wish_.read(); wish.number != seen_wish_) {
    seen_wish_ = wish.number;
    driver_.command(Vec3(wish.f[0], wish.f[1], wish.f[2]), now);
  }
  const LineStep step = driver_.advance(now);
  if (!perform(step, line)) return false;
  std::array<std::uint8_t, 256> bytes;
  const double wait = std::clamp(step.next - readMonotonicClock(), 0.0, kNap);
  const std::ptrdiff_t count = line.read(bytes.data(), bytes.size(), wait);
  if (count > 0) driver_.take(bytes.data(), static_cast<std::size_t>(count), readMonotonicClock());
  return count >= 0;
}

void FalconDevice::passOn() noexcept {
  reading_.write(driver_.reading());
  FalconStatus status = driver_.status();
  status.open_error = open_error_;
  const bool answers = status.state == FalconState::kReady || status.state == FalconState::kUnhomed;
  buttons_.store(answers ? status.buttons : std::uint8_t{0}, std::memory_order_relaxed);
  status_.write(status);
}

}  // namespace tandem
