#pragma once

#include <atomic>
#include <limits>

#include "tandem/falcon/latest_value.h"
#include "tandem/falcon/raw_hid_device.h"

namespace tandem::falcon_detail {

/// What lies between the haptic thread and the two that carry reports: the newest state, the newest
/// torques, and the last look at both ages before torques go out.
class RawHidClient final : public HidClient {
 public:
  struct Heard {
    RawHidState state;
    std::uint64_t count = 0;  ///< reports with a new number
    bool is_connected = false;
  };
  using Torques = std::array<std::int16_t, 3>;

  // The haptic thread's.
  [[nodiscard]] const Heard& newest() noexcept { return heard_.read(); }
  void command(const Torques& torques) noexcept { commanded_.write(torques); }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

  // The reader's.
  [[nodiscard]] bool takeReport(const std::uint8_t* report, std::size_t size,
                                double now) noexcept override {
    const std::optional<RawHidState> state = decodeRawState(report, size);
    if (!state) return false;
    const auto step = static_cast<std::uint16_t>(state->number - last_.state.number);
    const bool is_first = !was_heard_;
    was_heard_ = true;
    if (!is_first && step == 0) return true;  // a device that repeats itself tells nothing
    if (!is_first) lost_ += step - 1U;
    last_.state = *state;
    ++last_.count;
    heard_at_ = now;
    is_homed_ = state->isHomed();
    heard_.write(last_);
    return true;
  }
  void setConnected(bool is_connected) noexcept override {
    was_heard_ = false;
    is_homed_ = false;
    last_.state = {};
    last_.is_connected = is_connected;
    heard_.write(last_);
  }

  // The writer's.
  [[nodiscard]] HidReport giveReport(double now) noexcept override {
    if (commanded_.isNew()) {
      torques_ = commanded_.read();
      commanded_at_ = now;
    }
    const bool is_homed = is_homed_;
    const bool drives = is_homed && now - heard_at_ <= RawHidDevice::kFresh &&
                        now - commanded_at_ <= RawHidDevice::kCommand;
    return make(drives ? torques_ : Torques{}, static_cast<std::uint8_t>(!is_homed ? kRawHidHome
                                                                         : drives  ? kRawHidDrive
                                                                                   : 0));
  }
  [[nodiscard]] HidReport giveLastReport(double) noexcept override { return make({}, 0); }

 private:
  [[nodiscard]] HidReport make(const Torques& torques, std::uint8_t flags) noexcept {
    return toReport(encodeRawCommand({number_++, torques, flags}));
  }

  LatestValue<Heard> heard_;
  LatestValue<Torques> commanded_;
  std::atomic<std::uint64_t> lost_{0};

  Heard last_;  // the reader's
  bool was_heard_ = false;
  std::atomic<bool> is_homed_{false};  // from the reader to the writer, with the time
  std::atomic<double> heard_at_{-std::numeric_limits<double>::infinity()};

  Torques torques_{};  // the writer's
  double commanded_at_ = -std::numeric_limits<double>::infinity();
  std::uint16_t number_ = 0;
};

}  // namespace tandem::falcon_detail
