#pragma once

#include <algorithm>

namespace tandem::net {

/// When to say something again that was not answered: after 250 ms, then each time after twice as
/// long, at most 1 s.
class Retry {
 public:
  void start(double now) noexcept {
    next_ = now;
    wait_ = kFirst;
    tries_ = 0;
  }
  /// True if it is time, and then counts the try.
  [[nodiscard]] bool isDue(double now) noexcept {
    if (now < next_) return false;
    next_ = now + wait_;
    wait_ = std::min(2.0 * wait_, kMost);
    ++tries_;
    return true;
  }
  [[nodiscard]] int tries() const noexcept { return tries_; }

 private:
  static constexpr double kFirst = 0.25, kMost = 1.0;  // [s]
  double next_ = 0.0, wait_ = kFirst;
  int tries_ = 0;
};

/// So many a second, and as many at once.
class RateLimit {
 public:
  explicit RateLimit(double rate) noexcept : rate_(rate), left_(rate) {}
  [[nodiscard]] bool take(double now) noexcept {
    if (now > last_) left_ = std::min(rate_, left_ + rate_ * (now - last_));
    last_ = std::max(last_, now);
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  double rate_, left_;
  double last_ = 0.0;
};

}  // namespace tandem::net
