#include "tandem/falcon/falcon_driver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "settings_check.h"

namespace tandem {
namespace {

constexpr int kRestFrames = 5;            // without force before the line is left
constexpr double kForceShown = 0.05;      // from which the light shows it [N]
constexpr double kJumpSlack = 0.0005;     // the encoders' steps, and replies that come bunched [m]
constexpr double kLongestReach = 0.005;   // after a longer gap a far position has jumped, too [s]
constexpr double kShortestStep = 0.0002;  // velocity is not taken over less [s]

std::array<double, 3> toArray(const Vec3& a) noexcept { return {a.x(), a.y(), a.z()}; }

const FalconSettings& check(const FalconSettings& s) {
  using falcon_detail::require;
  const auto positive = [](double value, const char* name) {
    require(std::isfinite(value) && value > 0.0, name, value, "above 0");
  };
  require(s.force.max_force >= 0.0 && s.force.max_force <= 8.9, "max_force", s.force.max_force,
          "0 to 8.9 N");
  positive(s.force.max_slew, "max_slew");
  require(s.force.ramp_in >= 0.0 && std::isfinite(s.force.ramp_in), "ramp_in", s.force.ramp_in,
          "0 or more");
  positive(s.force.hold, "hold");
  positive(s.force.fade, "fade");
  require(s.motors_per_torque > 0.0 && s.motors_per_torque <= 20000.0, "motors_per_torque",
          s.motors_per_torque, "above 0, to 20000");
  require(s.centre_D.allFinite(), "centre_D", s.centre_D, "finite");
  positive(s.frame_period, "frame_period");
  positive(s.resend_time, "resend_time");
  positive(s.reply_time, "reply_time");
  require(s.firmware_time > s.reply_time, "firmware_time", s.firmware_time, "above reply_time");
  positive(s.recovery_time, "recovery_time");
  positive(s.reboot_pause, "reboot_pause");
  positive(s.fastest_hand, "fastest_hand");
  require(s.boot.tries >= 1, "boot.tries", s.boot.tries, "1 or more");
  require(s.boot.calls >= 1, "boot.calls", s.boot.calls, "1 or more");
  return s;
}

}  // namespace

FalconDriver::FalconDriver(const FalconSettings& settings, FirmwareImage image)
    : settings_(check(settings)), boot_(std::move(image), settings.boot), gate_(settings.force) {
  status_.image = static_cast<std::uint32_t>(boot_.size());
}

bool FalconDriver::isConversing() const noexcept {
  return status_.state != FalconState::kClosed && !boots_ && !boot_at_;
}

bool FalconDriver::hasStopped() const noexcept {
  return !isConversing() || rest_frames_ >= kRestFrames;
}

void FalconDriver::connect(double now) noexcept {
  ++status_.opened;
  startBoot(now);
}

void FalconDriver::disconnect(FalconFault why, double now) noexcept {
  // A device that was unplugged is that still while it cannot be opened again.
  const bool was_gone = status_.state == FalconState::kClosed;
  if (!was_gone)
    enterFault(why, now);
  else if (status_.fault == FalconFault::kNone)
    status_.fault = why;
  boots_ = false;
  boot_at_.reset();
  gate_.clear();
  pose_.reset();
  status_.force_D = {};
  status_.homed = 0;
  status_.state = FalconState::kClosed;
  publish(false);
}

void FalconDriver::enterFault(FalconFault fault, double now) noexcept {
  if (status_.state != FalconState::kFault) ++status_.faults;
  status_.state = FalconState::kFault;
  status_.fault = fault;
  trouble_at_ = now;
  publish(false);
}

void FalconDriver::startBoot(double now) noexcept {
  boots_ = true;
  boot_at_.reset();
  gate_.clear();
  pose_.reset();
  status_.homed = 0;
  status_.force_D = {};
  status_.state = FalconState::kBoot;
  publish(false);
  boot_.start(now);
}

void FalconDriver::startRun(double now) noexcept {
  boots_ = false;
  awaits_reply_ = false;
  ++status_.boots;
  due_ = replied_at_ = positioned_at_ = now;
  frames_.clear();
  dropped_ = frames_.dropped();
  doubted_p_D_.reset();
  status_.state = FalconState::kUnhomed;
}

void FalconDriver::take(const std::uint8_t* bytes, std::size_t count, double now) noexcept {
  if (boots_) {
    boot_.take(bytes, count, now);
    return;
  }
  if (!isConversing()) return;
  for (std::size_t i = 0; i < count; ++i) {
    const auto frame = frames_.take(bytes[i]);
    if (!frame) continue;
    if (const auto reply = decodeReply(*frame)) takeReply(*reply, now);
  }
}

void FalconDriver::command(const Vec3& f_D, double now) noexcept {
  wanted_D_ = f_D;
  wanted_at_ = now;
}

LineStep FalconDriver::advance(double now) noexcept {
  if (boots_) return advanceBoot(now);
  if (boot_at_ && now >= *boot_at_) {
    startBoot(now);
    return advanceBoot(now);
  }
  if (isConversing()) return advanceRun(now);
  LineStep step;
  step.next = boot_at_.value_or(now + settings_.reboot_pause);
  return step;
}

LineStep FalconDriver::advanceBoot(double now) noexcept {
  const LineStep step = boot_.advance(now);
  status_.loaded = static_cast<std::uint32_t>(boot_.loaded());
  if (boot_.fault() != BootFault::kNone) status_.fault = faultOf(boot_.fault());
  switch (boot_.phase()) {
    case FalconBoot::Phase::kRunning:
      startRun(now);
      return advanceRun(now);
    case FalconBoot::Phase::kFailed:
      enterFault(faultOf(boot_.fault()), now);
      boots_ = false;
      boot_at_ = now + settings_.reboot_pause;
      break;
    case FalconBoot::Phase::kLoading:
    case FalconBoot::Phase::kStarting:
      status_.state = FalconState::kLoading;
      break;
    default:
      status_.state = FalconState::kBoot;
  }
  return step;
}

LineStep FalconDriver::advanceRun(double now) noexcept {
  checkReplies(now);
  if (boots_) return advanceBoot(now);
  if (awaits_reply_ && now - sent_at_ >= settings_.resend_time) {
    awaits_reply_ = false;
    ++status_.missing;
  }
  LineStep step;
  if (!awaits_reply_ && now >= due_) {
    sendFrame(step, now);
    due_ = std::max(due_, now - settings_.frame_period) + settings_.frame_period;
  }
  step.next = awaits_reply_ ? sent_at_ + settings_.resend_time : due_;
  return step;
}

/// What is not said tells, too.
void FalconDriver::checkReplies(double now) noexcept {
  if (now - replied_at_ > settings_.firmware_time) {
    enterFault(FalconFault::kFirmwareLost, now);
    startBoot(now);
  } else if (now - replied_at_ > settings_.reply_time) {
    const bool has_bytes = frames_.dropped() != dropped_;
    enterFault(has_bytes ? FalconFault::kDamagedReplies : FalconFault::kNoReply, now);
  } else if (status_.homed == 7 && now - positioned_at_ > settings_.reply_time) {
    enterFault(FalconFault::kOutOfReach, now);
  }
}

void FalconDriver::takeReply(const FalconReply& reply, double now) noexcept {
  noteReply(reply, now);
  const bool was_ready = status_.state == FalconState::kReady;
  if (was_ready && !reply.isHomed()) enterFault(FalconFault::kHomingLost, now);
  const bool has_position = reply.isHomed() && takePosition(reply, now);
  updateState(has_position, now);
  publish(has_position && status_.state == FalconState::kReady);
}

void FalconDriver::noteReply(const FalconReply& reply, double now) noexcept {
  ++status_.replies;
  if (awaits_reply_) {
    const double time = now - sent_at_;
    status_.round_trips.add(time);
    if (time > 2.0 * settings_.frame_period) ++status_.late;
  }
  awaits_reply_ = false;
  replied_at_ = now;
  noteDropped(frames_.dropped() - dropped_);
  dropped_ = frames_.dropped();
  status_.dropped_bytes = dropped_;
  status_.homed = reply.homed;
  status_.buttons = reply.buttons;
  status_.counts = reply.counts;
}

void FalconDriver::noteDropped(std::uint64_t dropped) noexcept {
  if (dropped == 0) return;
  ++status_.resyncs;
  if (dropped < kFalconFrameSize) ++status_.short_replies;
}

/// Velocity is the first difference; a jump is none. False for a position that is not believed.
bool FalconDriver::takePosition(const FalconReply& reply, double now) noexcept {
  Vec3 angles;
  for (std::size_t i = 0; i < 3; ++i)
    angles[static_cast<Eigen::Index>(i)] = angleOfCounts(reply.counts[i]);
  const auto pose = pose_ ? kinematics_.computePoseOfAngles(angles, pose_->p_D)
                          : kinematics_.computePoseOfAngles(angles);
  if (!pose) return false;
  const double elapsed = now - positioned_at_;
  const double reach =
      settings_.fastest_hand * std::clamp(elapsed, settings_.frame_period, kLongestReach);
  const auto isNear = [&](const Vec3& p_D) {
    return (pose->p_D - p_D).norm() <= reach + kJumpSlack;
  };
  if (pose_ && isNear(pose_->p_D)) {
    if (elapsed < kShortestStep) return true;  // bunched replies: the older one stays
    v_D_ = (pose->p_D - pose_->p_D) / elapsed;
  } else if (pose_ && !(doubted_p_D_ && isNear(*doubted_p_D_))) {
    if (!doubted_p_D_) ++status_.jumps;
    doubted_p_D_ = pose->p_D;
    return false;
  } else {
    v_D_.setZero();
    gate_.restart(now);
  }
  pose_ = pose;
  doubted_p_D_.reset();
  positioned_at_ = now;
  return true;
}

void FalconDriver::updateState(bool has_position, double now) noexcept {
  if (status_.state == FalconState::kFault && now - trouble_at_ < settings_.recovery_time) return;
  if (status_.homed != 7) {
    status_.state = FalconState::kUnhomed;
    positioned_at_ = now;  // there is none to wait for
    pose_.reset();
  } else if (has_position && status_.state != FalconState::kReady) {
    status_.state = FalconState::kReady;
    status_.fault = FalconFault::kNone;
    v_D_.setZero();
  }
}

void FalconDriver::publish(bool is_valid) noexcept {
  ++reading_.number;
  reading_.is_valid = is_valid;
  if (!is_valid) return;
  reading_.p = toArray(pose_->p_D - settings_.centre_D);
  reading_.v = toArray(v_D_);
}

void FalconDriver::sendFrame(LineStep& step, double now) noexcept {
  const bool may_push = status_.state == FalconState::kReady && !stops_;
  Vec3 f_D = gate_.advance(wanted_D_, now - wanted_at_, may_push, now);
  // Force that is on its way out goes by the last position that was known.
  FalconCommand command;
  command.homes = true;
  const auto torques = pose_ ? computeTorques(*pose_, f_D) : std::nullopt;
  if (torques)
    command.motors = makeMotorCommands(*torques, settings_.motors_per_torque);
  else
    f_D.setZero();
  command.lights = chooseLights(f_D);
  step.send(encodeCommand(command).data(), kFalconFrameSize);
  ++status_.frames;
  status_.force_D = toArray(f_D);
  if (stops_ && f_D.isZero(0.0)) ++rest_frames_;
  awaits_reply_ = true;
  sent_at_ = now;
}

std::uint8_t FalconDriver::chooseLights(const Vec3& f_D) const noexcept {
  if (stops_) return 0;
  if (status_.homed != 7 || status_.state != FalconState::kReady) return kRedLight;
  return f_D.norm() > kForceShown ? kGreenLight | kBlueLight : kGreenLight;
}

}  // namespace tandem
