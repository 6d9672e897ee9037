#pragma once

#include <algorithm>

namespace tandem::net {

/// Times to repeat an unanswered message: after 250 ms, then after twice the last wait, at most 1
/// s.
class Retry {
 public:
  void start(double now) noexcept {
    next_ = now;
    wait_ = kFirst;
  }
  /// True if the message is due; starts the next wait.
  [[nodiscard]] bool isDue(double now) noexcept {
    if (now < next_) return false;
    next_ = now + wait_;
    wait_ = std::min(2.0 * wait_, kMost);
    return true;
  }

 private:
  static constexpr double kFirst = 0.25, kMost = 1.0;  // [s]
  double next_ = 0.0, wait_ = kFirst;
};

/// Allows `rate` events, or bytes, per second, at most `depth` at once.
class RateLimit {
 public:
  RateLimit(double rate, double depth) noexcept : rate_(rate), depth_(depth), left_(depth) {}
  [[nodiscard]] bool take(double now, double amount = 1.0) noexcept {
    if (now > last_) left_ = std::min(depth_, left_ + rate_ * (now - last_));
    last_ = std::max(last_, now);
    if (left_ < amount) return false;
    left_ -= amount;
    return true;
  }

 private:
  double rate_, depth_, left_;
  double last_ = 0.0;
};

}  // namespace tandem::net
