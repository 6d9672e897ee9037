#include "replay/replay_clock.h"

#include <algorithm>

namespace tandem::view {

void ReplayClock::advance(double seconds) {
  if (!is_playing_) return;
  seek(time_ + speed * seconds);
  is_playing_ = time_ < duration_;
}

void ReplayClock::toggle() {
  if (!is_playing_ && time_ >= duration_) time_ = 0.0;
  is_playing_ = !is_playing_;
}

void ReplayClock::step(int step) {
  is_playing_ = false;
  if (step > 0) {
    const auto next = std::ranges::upper_bound(frames_, time_);
    time_ = next == frames_.end() ? duration_ : *next;
  } else {
    const auto here = std::ranges::lower_bound(frames_, time_);
    time_ = here == frames_.begin() ? frames_.front() : *std::prev(here);
  }
}

void ReplayClock::seek(double time) { time_ = std::clamp(time, 0.0, duration_); }

}  // namespace tandem::view
