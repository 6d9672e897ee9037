#include "novint/falcon_boot.h"

#include <algorithm>
#include <utility>

namespace tandem {
namespace {

// 3 MHz / 21 is exact. For 140000 Bd, chips that divide by eighths would choose another speed.
constexpr SerialLine kReset{9600, 16, false, false};
constexpr SerialLine kCall{9600, 16, true, false};
constexpr SerialLine kLoad{142857, 16, false, false};
constexpr SerialLine kRun{1500000, 1, false, false};

constexpr std::array<std::uint8_t, 3> kCallBytes = {0x0A, 0x43, 0x0D};
constexpr std::array<std::uint8_t, 4> kAnswer = {0x0A, 0x44, 0x2C, 0x0D};
constexpr std::uint8_t kTiming = 'A';

constexpr double kResetTime = 0.01;    // DTR is low for this long [s]
constexpr double kFramePeriod = 0.01;  // time between frames that probe for running firmware [s]
constexpr std::size_t kPiece = 62;     // payload of one FTDI packet [bytes]

/// A command in homing mode, so that running firmware keeps its homing.
const FalconFrame& probeFrame() noexcept {
  static const FalconFrame frame = encodeCommand({{}, true, kRedLight});
  return frame;
}

}  // namespace

FalconBoot::FalconBoot(FirmwareImage image, const BootSettings& settings)
    : image_(std::move(image)), settings_(settings) {}

void FalconBoot::start(double now) noexcept {
  tries_ = 0;
  loaded_ = 0;
  fault_ = BootFault::kNone;
  enter(Phase::kProbing, now);
}

void FalconBoot::enter(Phase phase, double now) noexcept {
  phase_ = phase;
  has_entered_ = false;
  send_at_ = now;
  switch (phase) {
    case Phase::kProbing:
      until_ = now + settings_.probe_time;
      break;
    case Phase::kResetting:
      ++tries_;
      until_ = now + kResetTime;
      break;
    case Phase::kCalling:
      calls_ = 0;
      until_ = now + settings_.calls * settings_.call_period;
      break;
    case Phase::kTiming:
      until_ = now + settings_.echo_time;
      break;
    case Phase::kLoading:
      loaded_ = sent_ = 0;
      until_ = now + settings_.echo_time;
      break;
    case Phase::kStarting:
      until_ = now + settings_.start_time;
      break;
    case Phase::kPausing: {
      double pause = settings_.back_off;
      for (int i = 1; i < tries_ && pause < settings_.max_back_off; ++i) pause *= 2.0;
      until_ = now + std::min(pause, settings_.max_back_off);
      break;
    }
    case Phase::kIdle:
    case Phase::kRunning:
    case Phase::kFailed:
      until_ = now;
  }
}

void FalconBoot::fail(BootFault fault, double now) noexcept {
  fault_ = fault;
  enter(tries_ < settings_.tries ? Phase::kPausing : Phase::kFailed, now);
}

void FalconBoot::take(const std::uint8_t* bytes, std::size_t count, double now) noexcept {
  for (std::size_t i = 0; i < count; ++i) takeByte(bytes[i], now);
}

void FalconBoot::takeByte(std::uint8_t byte, double now) noexcept {
  if (!has_entered_) return;  // the byte came before the line was set for this phase
  std::copy(last_.begin() + 1, last_.end(), last_.begin());
  last_.back() = byte;
  switch (phase_) {
    case Phase::kProbing:
    case Phase::kStarting:
      if (const auto frame = frames_.take(byte); frame && decodeReply(*frame))
        enter(Phase::kRunning, now);
      break;
    case Phase::kCalling:
      if (last_ == kAnswer) enter(Phase::kTiming, now);
      break;
    case Phase::kTiming:
      if (byte == kTiming) enter(Phase::kLoading, now);
      break;
    case Phase::kLoading:
      takeEcho(byte, now);
      break;
    default:
      break;
  }
}

void FalconBoot::takeEcho(std::uint8_t byte, double now) noexcept {
  if (loaded_ >= sent_ || byte != image_.bytes[loaded_]) {
    fail(BootFault::kWrongEcho, now);
  } else if (++loaded_ == image_.bytes.size()) {
    enter(Phase::kStarting, now);
  } else if (loaded_ == sent_) {
    until_ = now + settings_.echo_time;
  }
}

void FalconBoot::onTimeUp(double now) noexcept {
  switch (phase_) {
    case Phase::kProbing:
      if (image_.isEmpty()) {
        fault_ = BootFault::kNoImage;
        enter(Phase::kFailed, now);
      } else {
        enter(Phase::kResetting, now);
      }
      break;
    case Phase::kResetting:
      enter(Phase::kCalling, now);
      break;
    case Phase::kCalling:
      fail(BootFault::kNoAnswer, now);
      break;
    case Phase::kTiming:
    case Phase::kLoading:
      fail(BootFault::kNoEcho, now);
      break;
    case Phase::kStarting:
      fail(BootFault::kNotRunning, now);
      break;
    case Phase::kPausing:
      enter(Phase::kResetting, now);
      break;
    case Phase::kIdle:
    case Phase::kRunning:
    case Phase::kFailed:
      break;
  }
}

LineStep FalconBoot::advance(double now) noexcept {
  // However late the caller is, a phase is entered before its time can be up.
  if (has_entered_ && now >= until_) onTimeUp(now);
  return makeStep(now);
}

LineStep FalconBoot::makeEntryStep(double now) noexcept {
  LineStep step;
  step.purges = true;
  switch (phase_) {
    case Phase::kProbing:
    case Phase::kStarting:
      step.line = kRun;
      break;
    case Phase::kResetting:
      step.line = kReset;
      break;
    case Phase::kCalling:
      step.line = kCall;
      break;
    case Phase::kTiming:
      step.line = kLoad;
      break;
    default:
      step.purges = false;
  }
  has_entered_ = true;
  send_at_ = now;
  last_ = {};
  frames_.clear();
  return step;
}

LineStep FalconBoot::makeStep(double now) noexcept {
  LineStep step;
  if (!has_entered_) step = makeEntryStep(now);
  step.next = until_;
  const bool is_due = now >= send_at_;
  switch (phase_) {
    case Phase::kProbing:
    case Phase::kStarting:
      if (is_due) {
        step.send(probeFrame().data(), kFalconFrameSize);
        send_at_ = now + kFramePeriod;
      }
      step.next = std::min(until_, send_at_);
      break;
    case Phase::kCalling:
      if (is_due && calls_ < settings_.calls) {
        step.send(kCallBytes.data(), kCallBytes.size());
        send_at_ = now + settings_.call_period;
        ++calls_;
      }
      step.next = std::min(until_, send_at_);
      break;
    case Phase::kTiming:
      if (step.line) step.send(&kTiming, 1);
      break;
    case Phase::kLoading:
      if (loaded_ == sent_) sendPiece(step);
      break;
    default:
      break;
  }
  return step;
}

void FalconBoot::sendPiece(LineStep& step) noexcept {
  step.send(image_.bytes.data() + sent_, std::min(kPiece, image_.bytes.size() - sent_));
  sent_ += step.count;
}

}  // namespace tandem
