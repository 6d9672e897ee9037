#pragma once

#include <vector>

namespace tandem::view {

/// Which moment of a recorded run is shown: it plays, pauses, and is put anywhere.
class ReplayClock {
 public:
  /// `frames` are the moments of the recorded pictures, at least one, growing; `duration` is when
  /// the run ends [s]. It begins at 0 and plays.
  ReplayClock(const std::vector<double>& frames, double duration)
      : frames_(frames), duration_(duration) {}

  /// Lets `seconds` pass. At the end it pauses.
  void advance(double seconds);
  /// Plays, from the beginning if it is at the end; or pauses.
  void toggle();
  /// Pauses at the next picture, or with a negative `step` at the one before.
  void step(int step);
  /// Goes to a moment within the run; it goes on playing if it does.
  void seek(double time);

  [[nodiscard]] double time() const noexcept { return time_; }
  [[nodiscard]] double duration() const noexcept { return duration_; }
  [[nodiscard]] bool isPlaying() const noexcept { return is_playing_; }

  double speed = 1.0;  ///< recorded seconds for each second

 private:
  std::vector<double> frames_;
  double duration_;
  double time_ = 0.0;
  bool is_playing_ = true;
};

}  // namespace tandem::view
