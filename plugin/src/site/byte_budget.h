#pragma once

#include <algorithm>
#include <cstddef>

#include "tandem/coordination/link.h"

#include "coordination/src/wire/wire.h"
#include "coordination/src/wire/wire_state.h"

namespace tandem {

/// Bytes of one state on its way, of the narrow profile, with the headers of IPv4 and UDP.
[[nodiscard]] constexpr double computeDatagramBytes(std::size_t objects, bool has_grip,
                                                    bool has_roll = false) noexcept {
  constexpr std::size_t kIpAndUdp = 28;
  return static_cast<double>(kIpAndUdp + kHeaderSize + kTagSize +
                             computeStateSize(WireProfile::kFloat32, objects, has_grip, has_roll));
}

/// Bytes that a site may send: they come in evenly, and are kept for a rare packet's period at
/// most. What must be sent may take it below 0; the others then wait. Plain value; real-time safe.
class ByteBudget {
 public:
  /// `rate` [bit/s]; 0: no limit.
  explicit ByteBudget(double rate) noexcept : rate_(rate / 8.0) {}

  /// True if it is too small for `bytes_per_second` [byte/s].
  [[nodiscard]] bool binds(double bytes_per_second) const noexcept {
    return rate_ > 0.0 && bytes_per_second > rate_;
  }
  /// Takes in what came until `time` [s].
  void fill(double time) noexcept {
    left_ = std::min(left_ + rate_ * std::max(time - filled_at_, 0.0), most());
    filled_at_ = time;
  }
  void spend(double bytes) noexcept { left_ = std::max(left_ - bytes, -most()); }
  /// [bytes]
  [[nodiscard]] double left() const noexcept { return left_; }
  /// True if less than half of the most is kept.
  [[nodiscard]] bool isShort() const noexcept { return 2.0 * left_ < most(); }
  /// True if more would be lost.
  [[nodiscard]] bool isFull() const noexcept { return left_ >= most(); }

 private:
  [[nodiscard]] double most() const noexcept { return rate_ * kIdlePacketPeriod; }

  double rate_;  ///< [byte/s]
  double left_ = 0.0, filled_at_ = 0.0;
};

}  // namespace tandem
