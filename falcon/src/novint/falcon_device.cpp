#include "tandem/falcon/falcon_device.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include "tandem/falcon/monotonic_clock.h"

#include "guard/latest_value.h"
#include "guard/realtime_rights.h"
#include "novint/falcon_driver.h"

namespace tandem {
namespace {

constexpr double kMostAge = 0.02;      // oldest usable reading [s]
constexpr double kOpenPeriod = 0.25;   // time between attempts to open the line [s]
constexpr double kNap = 0.02;          // longest wait of a stop for the thread [s]
constexpr double kStopTime = 0.2;      // time limit for the last frames [s]
constexpr double kWorkspace = 0.05;    // half extents [m]
constexpr double kStiffness = 3000.0;  // stiffest spring that feels stable [N/m]

}  // namespace

/// The thread that owns the line, and the values it shares with the ticking thread.
class FalconDevice::Impl {
 public:
  Impl(const FalconSettings& settings, FirmwareImage image, OpenTransport open);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept { return capabilities_; }
  [[nodiscard]] DeviceSample read(double now) noexcept;
  void write(const Vec3& f_W) noexcept;
  [[nodiscard]] const FalconStatus& status() noexcept { return status_.read(); }
  [[nodiscard]] std::uint8_t buttons() const noexcept {
    return buttons_.load(std::memory_order_relaxed);
  }

 private:
  struct Wish {
    std::array<double, 3> f{};
    std::uint64_t number = 0;
  };

  void run() noexcept;
  void serve(ByteTransport& line) noexcept;
  void giveLastFrames(ByteTransport& line) noexcept;
  [[nodiscard]] std::unique_ptr<ByteTransport> tryOpen() noexcept;
  [[nodiscard]] bool exchange(ByteTransport& line) noexcept;
  void passOn() noexcept;

  DeviceCapabilities capabilities_;
  OpenTransport open_;
  int priority_;

  // Used by the device's thread only.
  FalconDriver driver_;
  std::array<char, 160> open_error_{};
  std::uint64_t seen_wish_ = 0;

  // Shared between the threads.
  LatestValue<FalconReading> reading_;
  LatestValue<Wish> wish_;
  LatestValue<FalconStatus> status_;
  std::atomic<std::uint8_t> buttons_{0};
  std::atomic<bool> stops_{false};

  // Used by the ticking thread only.
  std::uint64_t newest_ = 0, wishes_ = 0;
  double newest_since_ = 0.0;

  std::thread thread_;
};

FalconDevice::Impl::Impl(const FalconSettings& settings, FirmwareImage image, OpenTransport open)
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

FalconDevice::Impl::~Impl() {
  stops_.store(true, std::memory_order_relaxed);
  thread_.join();
}

DeviceSample FalconDevice::Impl::read(double now) noexcept {
  const FalconReading& reading = reading_.read();
  if (reading.number != newest_) {
    newest_ = reading.number;
    newest_since_ = now;
  }
  // Also false if `now` is NaN or runs back.
  const bool is_fresh = now >= newest_since_ && now - newest_since_ <= kMostAge;
  DeviceSample sample;
  sample.valid = reading.is_valid && is_fresh;
  sample.hip.p_W = Vec3(reading.p[0], reading.p[1], reading.p[2]);
  if (sample.valid) sample.hip.v_W = Vec3(reading.v[0], reading.v[1], reading.v[2]);
  if (sample.valid) sample.buttons = buttons();
  return sample;
}

void FalconDevice::Impl::write(const Vec3& f_W) noexcept {
  wish_.write({{f_W.x(), f_W.y(), f_W.z()}, ++wishes_});
}

void FalconDevice::Impl::run() noexcept {
  RealtimeRights rights;
  rights.take(priority_, false);
  while (!stops_.load(std::memory_order_relaxed)) {
    const double tried_at = readMonotonicClock();
    if (const std::unique_ptr<ByteTransport> line = tryOpen()) serve(*line);
    while (readMonotonicClock() - tried_at < kOpenPeriod && !stops_.load(std::memory_order_relaxed))
      sleepFor(kNap);
  }
}

std::unique_ptr<ByteTransport> FalconDevice::Impl::tryOpen() noexcept {
  const double now = readMonotonicClock();
  try {
    std::unique_ptr<ByteTransport> line = open_();
    if (line) {
      open_error_ = {};
      seen_wish_ = wish_.read().number;  // the caller of an old command may be gone
      driver_.connect(now);
      passOn();
      return line;
    }
  } catch (const std::exception& error) {
    const std::string_view text = error.what();
    open_error_ = {};
    std::copy_n(text.begin(), std::min(text.size(), open_error_.size() - 1), open_error_.begin());
  } catch (...) {  // this thread survives whatever the caller's function throws
  }
  driver_.disconnect(FalconFault::kCannotOpen, now);
  passOn();
  return nullptr;
}

/// Serves the line until it is gone or the device is stopped.
void FalconDevice::Impl::serve(ByteTransport& line) noexcept {
  while (!stops_.load(std::memory_order_relaxed) && exchange(line)) passOn();
  giveLastFrames(line);
  if (!stops_.load(std::memory_order_relaxed))
    driver_.disconnect(FalconFault::kUnplugged, readMonotonicClock());
  passOn();
}

/// Ramps the force to zero by frames. The device keeps the last force it received, and a failed
/// line may still accept bytes. If the ramp does not finish, one last frame sets zero at once.
void FalconDevice::Impl::giveLastFrames(ByteTransport& line) noexcept {
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

bool FalconDevice::Impl::exchange(ByteTransport& line) noexcept {
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

void FalconDevice::Impl::passOn() noexcept {
  reading_.write(driver_.reading());
  FalconStatus status = driver_.status();
  status.open_error = open_error_;
  const bool answers = status.state == FalconState::kReady || status.state == FalconState::kUnhomed;
  buttons_.store(answers ? status.buttons : std::uint8_t{0}, std::memory_order_relaxed);
  status_.write(status);
}

FalconDevice::FalconDevice(const FalconSettings& settings, FirmwareImage image, OpenTransport open)
    : impl_(std::make_unique<Impl>(settings, std::move(image), std::move(open))) {}
FalconDevice::~FalconDevice() = default;

const DeviceCapabilities& FalconDevice::capabilities() const noexcept {
  return impl_->capabilities();
}
DeviceSample FalconDevice::read(double now) noexcept { return impl_->read(now); }
void FalconDevice::write(const Vec3& f_W) noexcept { impl_->write(f_W); }
const FalconStatus& FalconDevice::status() noexcept { return impl_->status(); }
std::uint8_t FalconDevice::buttons() const noexcept { return impl_->buttons(); }

}  // namespace tandem
