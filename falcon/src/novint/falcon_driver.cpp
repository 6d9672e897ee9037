#include "novint/falcon_driver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "novint/falcon_edge.h"

namespace tandem {
namespace {

constexpr int kRestFrames = 5;     // frames without force before the line is closed or kept quiet
constexpr double kHeldUp = 0.005;  // a host this late has not been listening [s]
constexpr double kForceShown = 0.05;  // smallest force that the light indicates [N]
// While a command is on its way and acts, the grip moves: it may feel this much of max_force.
constexpr double kMostFelt = 1.1;
constexpr double kLeastWay = 0.001;  // way of a grip that seemed to rest [m]
constexpr double kActs = 0.002;      // age of a command when the next one replaces it [s]

std::array<double, 3> toArray(const Vec3& a) noexcept { return {a.x(), a.y(), a.z()}; }

}  // namespace

FalconDriver::FalconDriver(const FalconSettings& settings, FirmwareImage image)
    : settings_(settings),
      boot_(std::move(image), settings.boot),
      tracker_(settings.fastest_hand),
      gate_(settings.force) {
  check(settings);
  status_.image = static_cast<std::uint32_t>(boot_.size());
}

bool FalconDriver::isConversing() const noexcept {
  return status_.state != FalconState::kClosed && !boots_ && !boot_at_;
}

bool FalconDriver::hasStopped() const noexcept { return !isConversing() || (stops_ && isAtRest()); }

bool FalconDriver::isAtRest() const noexcept { return rest_frames_ >= kRestFrames; }

/// True while the force is taken away. Frames then follow each other, answered or not.
bool FalconDriver::isTakingForceAway() const noexcept {
  return stops_ || (status_.state == FalconState::kFault && !isAtRest());
}

void FalconDriver::beginStop() noexcept {
  if (stops_) return;
  stops_ = true;
  rest_frames_ = 0;  // the lights must still go out
  listens_until_.reset();
  asked_at_.reset();
}

void FalconDriver::connect(double now) noexcept {
  ++status_.opened;
  stops_ = false;
  startBoot(now);
}

void FalconDriver::disconnect(FalconFault why, double now) noexcept {
  // Keep the fault "unplugged" while reopening fails.
  const bool was_gone = status_.state == FalconState::kClosed;
  if (!was_gone)
    enterFault(why, now);
  else if (status_.fault == FalconFault::kNone)
    status_.fault = why;
  boots_ = false;
  boot_at_.reset();
  gate_.clear();
  tracker_.forget(now);
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
  tracker_.forget(now);
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
  listens_until_.reset();
  asked_at_.reset();
  silent_since_.reset();
  astray_since_.reset();
  due_ = heard_at_ = expected_at_ = now;
  rest_frames_ = 0;
  tracker_.forget(now);
  frames_.clear();
  dropped_ = frames_.dropped();
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
  status_.dropped_bytes = frames_.dropped();
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
  excuseHost(now);
  checkReplies(now);
  if (boots_) return advanceBoot(now);
  const LineStep step = listens_until_ && isAtRest() ? listen(now) : converse(now);
  expected_at_ = step.next;
  return step;
}

LineStep FalconDriver::converse(double now) noexcept {
  const double patience = isTakingForceAway() ? settings_.frame_period : settings_.resend_time;
  if (awaits_reply_ && now - sent_at_ >= patience) {
    awaits_reply_ = false;
    ++status_.missing;
  }
  LineStep step;
  if (!awaits_reply_ && now >= due_) {
    sendFrame(step, now);
    due_ = std::max(due_, now - settings_.frame_period) + settings_.frame_period;
  }
  step.next = awaits_reply_ ? std::max(due_, sent_at_ + patience) : due_;
  return step;
}

/// Waits for late replies to frames that were given up, so that they are not taken for new ones.
/// Sends nothing for `quiet_time`, then one frame whose reply must come in time.
LineStep FalconDriver::listen(double now) noexcept {
  LineStep step;
  if (now >= *listens_until_) {
    step.purges = true;
    frames_.clear();
    sendFrame(step, now);
    asked_at_ = now;
    listens_until_ = now + settings_.quiet_time;
  }
  step.next = *listens_until_;
  return step;
}

/// Restarts the reply timeout if the host was late: it sent late and did not listen. Excuses the
/// host only once until the next reply.
void FalconDriver::excuseHost(double now) noexcept {
  if (!silent_since_ || is_excused_ || now - expected_at_ <= kHeldUp) return;
  silent_since_ = sent_at_ = now;
  is_excused_ = true;
}

/// Silence is a fault: no usable reply within `reply_time`.
void FalconDriver::checkReplies(double now) noexcept {
  if (!silent_since_ || stops_ || now - *silent_since_ <= settings_.reply_time) return;
  const bool has_bytes = frames_.dropped() != dropped_;
  enterFault(has_bytes ? FalconFault::kDamagedReplies : FalconFault::kNoReply, now);
  // The force is taken away by frames first; then the line stays quiet for a while.
  if (!listens_until_ || !isAtRest()) listens_until_ = now + settings_.quiet_time;
  const double unheard = now - std::max(heard_at_, *silent_since_);
  if (!isAtRest() || unheard <= settings_.firmware_time) return;
  enterFault(FalconFault::kFirmwareLost, now);
  startBoot(now);
}

void FalconDriver::takeReply(const FalconReply& reply, double now) noexcept {
  heard_at_ = now;
  if (listens_until_) {
    if (!asked_at_ || now - *asked_at_ > settings_.reply_time) return;
    listens_until_.reset();
    asked_at_.reset();
    due_ = now;
  }
  noteReply(reply, now);
  const bool was_ready = status_.state == FalconState::kReady;
  if (was_ready && !reply.isHomed()) enterFault(FalconFault::kHomingLost, now);
  const bool has_position = reply.isHomed() && takePosition(reply, now);
  if (has_position || !reply.isHomed())
    astray_since_.reset();
  else if (!astray_since_)
    astray_since_ = now;
  if (astray_since_ && now - *astray_since_ > settings_.reply_time)
    enterFault(FalconFault::kOutOfReach, now);
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
  silent_since_.reset();
  is_excused_ = false;
  noteDropped(frames_.dropped() - dropped_);
  dropped_ = frames_.dropped();
  status_.homed = reply.homed;
  status_.buttons = reply.buttons;
  status_.counts = reply.counts;
}

void FalconDriver::noteDropped(std::uint64_t dropped) noexcept {
  if (dropped == 0) return;
  ++status_.resyncs;
  if (dropped < kFalconFrameSize) ++status_.short_replies;
}

/// Returns false if the position is not accepted.
bool FalconDriver::takePosition(const FalconReply& reply, double now) noexcept {
  const FalconTracker::Outcome outcome = tracker_.take(reply.counts, now);
  if (outcome == FalconTracker::Outcome::kPlaced) gate_.restart(now);
  status_.jumps = tracker_.jumps();
  return outcome != FalconTracker::Outcome::kNone;
}

void FalconDriver::updateState(bool has_position, double now) noexcept {
  const bool is_over = isAtRest() && now - trouble_at_ >= settings_.recovery_time;
  if (status_.state == FalconState::kFault && !is_over) return;
  if (status_.homed != 7) {
    status_.state = FalconState::kUnhomed;
    tracker_.forget(now);
  } else if (has_position && status_.state != FalconState::kReady) {
    status_.state = FalconState::kReady;
    status_.fault = FalconFault::kNone;
    tracker_.stop();
  }
}

void FalconDriver::publish(bool is_valid) noexcept {
  ++reading_.number;
  reading_.is_valid = is_valid;
  if (!is_valid) return;
  reading_.p = toArray(tracker_.pose()->p_D - settings_.centre_D);
  reading_.v = toArray(tracker_.velocity());
}

void FalconDriver::sendFrame(LineStep& step, double now) noexcept {
  const bool may_push = status_.state == FalconState::kReady && !stops_;
  Vec3 f_D = gate_.advance(wanted_D_, now - wanted_at_, may_push, now);
  // A fading force uses the last known position.
  FalconCommand command;
  command.homes = true;
  const auto& pose = tracker_.pose();
  const auto torques = pose ? computeTorques(*pose, f_D) : std::nullopt;
  const double share = torques ? findEdgeShare(*torques, now) : 0.0;
  if (share > 0.0) {
    command.motors = makeMotorCommands(share * *torques, settings_.motors_per_torque);
    f_D *= share;
    gate_.lower(share);
  } else {
    f_D.setZero();
    gate_.lower(0.0);
  }
  command.lights = chooseLights(f_D);
  step.send(encodeCommand(command).data(), kFalconFrameSize);
  ++status_.frames;
  status_.force_D = toArray(f_D);
  rest_frames_ = f_D.isZero(0.0) ? std::min(rest_frames_ + 1, kRestFrames) : 0;
  awaits_reply_ = true;
  if (!silent_since_) silent_since_ = now;
  sent_at_ = now;
}

/// Near the edge of the legs' reach a torque that is right here is a large force a little further.
double FalconDriver::findEdgeShare(const Vec3& torques, double now) const noexcept {
  const double way = kLeastWay + tracker_.velocity().norm() * (now - tracker_.seenAt() + kActs);
  return computeEdgeShare(kinematics_, *tracker_.pose(), torques, way,
                          kMostFelt * settings_.force.max_force);
}

std::uint8_t FalconDriver::chooseLights(const Vec3& f_D) const noexcept {
  if (stops_) return 0;
  if (status_.homed != 7 || status_.state != FalconState::kReady) return kRedLight;
  return f_D.norm() > kForceShown ? kGreenLight | kBlueLight : kGreenLight;
}

}  // namespace tandem
