#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tandem/coordination/types.h"

/// \file
/// Velocities from readings of a position that is counted in steps. Small values of one shape:
///
///   Vec3 add(double time, const Vec3& p) noexcept   takes a reading in, gives the newest velocity
///   void clear() noexcept                           forgets all: after a jump (homing, reconnect)
///
/// A reading may be anything with three axes: a point [m], or the counts of a Falcon's three
/// encoders, where every axis has the same known step. The first reading gives zero. One that is
/// not finite, or not later than the last, is left out and gives the last velocity again. Fixed
/// size, real-time safe. Measured against each other in docs/devices.md.
#pragma GCC visibility push(default)
namespace tandem {

/// A reading and when it was taken [s].
struct TimedReading {
  double time = 0.0;
  Vec3 p = Vec3::Zero();
};

/// (p_k - p_k-1) / (t_k - t_k-1): half a period late, and as coarse as a step per period.
class FirstDifference {
 public:
  Vec3 add(double time, const Vec3& p) noexcept;
  void clear() noexcept { *this = {}; }

 private:
  TimedReading last_;
  Vec3 velocity_ = Vec3::Zero();
  bool has_last_ = false;
};

/// First difference behind a first-order low-pass, exact for readings at uneven times:
/// v += (1 - exp(-2 pi cutoff dt)) (difference - v).
class LowPassDifference {
 public:
  /// `cutoff` [Hz], > 0; higher is noisier and 1 / (2 pi cutoff) less late.
  explicit LowPassDifference(double cutoff) noexcept : cutoff_(cutoff) {}

  Vec3 add(double time, const Vec3& p) noexcept;
  void clear() noexcept { *this = LowPassDifference(cutoff_); }

 private:
  double cutoff_;
  TimedReading last_;
  Vec3 velocity_ = Vec3::Zero();
  bool has_last_ = false;
};

/// How an AdaptiveWindow's slope is drawn through the readings of its window.
enum class WindowFit : std::uint8_t {
  kEnds,  ///< from the oldest to the newest
  kBest   ///< least squares
};

/// What an AdaptiveWindow takes for one line. The defaults are those that docs/devices.md chooses,
/// for readings in counts.
struct AdaptiveWindowSettings {
  /// How far off the line a reading may be, in the reading's unit: less than a step, or a reading
  /// that goes to and fro by one counts as rest. Higher is calmer and later.
  double tolerance = 0.7;
  /// How far two readings' times may be off against each other [s]: the tolerance is wider by the
  /// way that the motion makes in it. 0: times are exact.
  double stamp_error = 0.4e-3;
  double longest = 8e-3;  ///< of a window [s]; higher is calmer when slow, and later by half of it
  WindowFit fit = WindowFit::kBest;
};

/// First-order adaptive windowing (Janabi-Sharifi, Hayward & Chen 2000): each axis looks back as
/// far as a line through the newest reading misses none in between by more than the tolerance, and
/// takes the slope of that stretch. Long and calm in slow motion, short and quick in fast.
///
/// What a line misses is not asked reading by reading: the range of slopes that miss none so far is
/// kept, so that a reading costs the window's length once.
class AdaptiveWindow {
 public:
  /// Readings kept: at 1 kHz a window ends here, whatever `longest` says.
  static constexpr std::size_t kRoom = 64;

  explicit AdaptiveWindow(const AdaptiveWindowSettings& settings = {}) noexcept
      : settings_(settings) {}

  Vec3 add(double time, const Vec3& p) noexcept;
  void clear() noexcept { *this = AdaptiveWindow(settings_); }

 private:
  /// `back` = 0: the newest.
  [[nodiscard]] const TimedReading& reading(std::size_t back) const noexcept {
    return readings_[(newest_ + kRoom - back) % kRoom];
  }
  [[nodiscard]] double findSlope(Eigen::Index axis) const noexcept;

  AdaptiveWindowSettings settings_;
  std::array<TimedReading, kRoom> readings_;
  std::size_t newest_ = 0, count_ = 0;
  Vec3 velocity_ = Vec3::Zero();
};

/// What is usual for a device that counts its position in steps of `step`, in the reading's unit:
/// 1 for a Falcon's counts.
[[nodiscard]] AdaptiveWindow makeUsualVelocityEstimator(double step = 1.0) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
