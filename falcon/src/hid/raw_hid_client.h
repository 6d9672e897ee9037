#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>

#include "tandem/falcon/raw_hid_device.h"

#include "guard/latest_value.h"
#include "hid/hid_stream.h"
#include "hid/raw_hid_report.h"
#include "novint/falcon_force_gate.h"

namespace tandem::falcon_detail {

/// Command of the haptic thread, as plain numbers to copy between threads.
struct RawHidWish {
  std::array<double, 3> f_D{};  ///< [N]
  /// Torques at the arms per force [m], column by column, at the grip's last known pose.
  std::array<double, 9> torques_by_force{};
  std::uint64_t closures = 0;  ///< closures known when the command was made
  bool is_usable = false;      ///< the position is valid and the force is finite
};

/// Connects the haptic thread with the two threads that carry reports. It holds the newest state,
/// the newest command and the gate that limits the force last. The gate belongs to the writer and
/// uses its clock. Whichever thread sees a fault, the force fades and later returns by the ramp.
class RawHidClient final : public HidClient {
 public:
  struct Heard {
    RawHidState state;
    std::uint64_t count = 0;  ///< reports with a new number
    bool is_connected = false;
  };

  explicit RawHidClient(const FalconForceLimits& limits) noexcept : gate_(limits) {}

  // For the haptic thread.
  [[nodiscard]] const Heard& newest() noexcept { return heard_.read(); }
  /// The last command, to be changed and passed on.
  [[nodiscard]] RawHidWish& nextWish() noexcept { return next_wish_; }
  void passWishOn() noexcept { wishes_.write(next_wish_); }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  /// Number of reasons to take the force away, even for one report. If read after newest(), it is
  /// at least as new.
  [[nodiscard]] std::uint64_t closures() const noexcept { return closures_; }
  void close() noexcept { ++closures_; }

  // For the reader's thread.
  [[nodiscard]] bool takeReport(const std::uint8_t* report, std::size_t size,
                                double now) noexcept override {
    const std::optional<RawHidState> state = decodeRawState(report, size);
    if (!state) return false;
    const auto step = static_cast<std::uint16_t>(state->number - last_.state.number);
    const bool is_first = !was_heard_;
    was_heard_ = true;
    if (!is_first && step == 0) return true;  // a repeated report carries no news
    if (!is_first) lost_ += step - 1U;
    const bool was_late = !is_first && now - heard_at_ > RawHidDevice::kFresh;
    if (was_late || (is_homed_ && !state->isHomed())) close();
    last_.state = *state;
    ++last_.count;
    heard_at_ = now;
    is_homed_ = state->isHomed();
    heard_.write(last_);
    return true;
  }
  void setConnected(bool is_connected) noexcept override {
    if (is_connected)
      gate_.clear();  // a newly connected device has no force to fade
    else
      close();
    was_heard_ = false;
    is_homed_ = false;
    last_.state = {};
    last_.is_connected = is_connected;
    heard_.write(last_);
  }

  // For the writer's thread.
  [[nodiscard]] HidReport giveReport(double now) noexcept override {
    if (wishes_.isNew()) {
      wish_ = wishes_.read();
      wished_at_ = now;
    }
    const bool may_drive = mayDrive(now);
    return make(may_drive, is_homed_ ? std::uint8_t{0} : std::uint8_t{kRawHidHome}, now);
  }
  [[nodiscard]] HidReport giveLastReport(double now) noexcept override {
    return make(false, 0, now);
  }

 private:
  [[nodiscard]] bool mayDrive(double now) noexcept {
    const std::uint64_t closures = closures_;
    const bool was_closed = closures != closures_seen_;
    closures_seen_ = closures;
    return !was_closed && wish_.is_usable && wish_.closures == closures && is_homed_ &&
           now - heard_at_ <= RawHidDevice::kFresh && now - wished_at_ <= RawHidDevice::kCommand;
  }

  /// Unless the force may drive, it fades with the motors on; then `idle_flags` are sent.
  [[nodiscard]] HidReport make(bool may_drive, std::uint8_t idle_flags, double now) noexcept {
    const Vec3 f_D =
        gate_.advance(Eigen::Map<const Vec3>(wish_.f_D.data()), now - wished_at_, may_drive, now);
    const auto torques =
        makeRawTorques(Eigen::Map<const Eigen::Matrix3d>(wish_.torques_by_force.data()) * f_D);
    const bool drives = may_drive || torques != std::array<std::int16_t, 3>{};
    const std::uint8_t flags = drives ? std::uint8_t{kRawHidDrive} : idle_flags;
    return toReport(encodeRawCommand({number_++, torques, flags}));
  }

  LatestValue<Heard> heard_;
  LatestValue<RawHidWish> wishes_;
  std::atomic<std::uint64_t> lost_{0}, closures_{0};

  RawHidWish next_wish_;  // of the haptic thread

  Heard last_;  // of the reader's thread
  bool was_heard_ = false;
  std::atomic<bool> is_homed_{false};  // from the reader to the writer, with heard_at_
  std::atomic<double> heard_at_{-std::numeric_limits<double>::infinity()};

  FalconForceGate gate_;  // of the writer's thread
  RawHidWish wish_;
  double wished_at_ = -std::numeric_limits<double>::infinity();
  std::uint64_t closures_seen_ = 0;
  std::uint16_t number_ = 0;
};

}  // namespace tandem::falcon_detail
