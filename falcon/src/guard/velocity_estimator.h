#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tandem/coordination/types.h"

/// \file
/// Velocity estimators for positions that are counted in steps. All have the same interface:
///
///    Vec3 add(double time, const Vec3& p) noexcept   adds a reading, returns the newest velocity
///    void clear() noexcept                           forgets all readings: after homing,
///    reconnection
///
/// A reading is any quantity with three axes: a point [m], or the counts of a Falcon's encoders.
/// All axes have the same known step. The first reading gives zero velocity. A reading that is not
/// finite or not later than the last is skipped; add() then returns the last velocity. Fixed size,
/// real-time safe. docs/devices.md compares them by measurement.
namespace tandem {

/// A reading with its time [s].
struct TimedReading {
  double time = 0.0;
  Vec3 p = Vec3::Zero();
};

/// (p_k - p_k-1) / (t_k - t_k-1). Half a period late; its resolution is one step per period.
class FirstDifference {
 public:
  Vec3 add(double time, const Vec3& p) noexcept;
  void clear() noexcept { *this = {}; }

 private:
  TimedReading last_;
  Vec3 velocity_ = Vec3::Zero();
  bool has_last_ = false;
};

/// First difference behind a first-order low-pass. It is exact for uneven times: v += (1 - exp(-2
/// pi cutoff dt)) (difference - v).
class LowPassDifference {
 public:
  /// `cutoff` [Hz], > 0. A higher cutoff is noisier; the delay is 1 / (2 pi cutoff).
  explicit LowPassDifference(double cutoff) noexcept : cutoff_(cutoff) {}

  Vec3 add(double time, const Vec3& p) noexcept;
  void clear() noexcept { *this = LowPassDifference(cutoff_); }

 private:
  double cutoff_;
  TimedReading last_;
  Vec3 velocity_ = Vec3::Zero();
  bool has_last_ = false;
};

/// Fit of an AdaptiveWindow's line to the readings of its window.
enum class WindowFit : std::uint8_t {
  kEnds,  ///< line from the oldest to the newest reading
  kBest   ///< least-squares line
};

/// Settings of an AdaptiveWindow. The defaults are for readings in counts; docs/devices.md derives
/// them.
struct AdaptiveWindowSettings {
  /// Largest distance of a reading from the line, in the reading's unit. Higher is calmer and
  /// later. Keep it below one step: otherwise a reading that toggles by one step counts as rest.
  double tolerance = 0.7;
  /// Largest error between two readings' times [s]; 0: times are exact. It widens the tolerance by
  /// the distance moved in that time.
  double stamp_error = 0.4e-3;
  double longest = 8e-3;  ///< longest window [s]; higher is calmer when slow, and later
  WindowFit fit = WindowFit::kBest;
};

/// First-order adaptive windowing (Janabi-Sharifi, Hayward & Chen 2000). Each axis takes the
/// longest window whose line through the newest reading stays within the tolerance of all readings.
/// The velocity is the slope of that line. Windows are long and calm in slow motion, short and
/// quick in fast motion.
///
/// The estimator keeps the range of slopes that fit all readings so far. The cost of a reading is
/// therefore linear in the window's length.
class AdaptiveWindow {
 public:
  /// Capacity of the window in readings: 64 ms at 1 kHz, whatever `longest` is.
  static constexpr std::size_t kRoom = 64;

  explicit AdaptiveWindow(const AdaptiveWindowSettings& settings = {}) noexcept
      : settings_(settings) {}

  Vec3 add(double time, const Vec3& p) noexcept;
  void clear() noexcept { *this = AdaptiveWindow(settings_); }

 private:
  /// The reading `back` places before the newest.
  [[nodiscard]] const TimedReading& reading(std::size_t back) const noexcept {
    return readings_[(newest_ + kRoom - back) % kRoom];
  }
  [[nodiscard]] double findSlope(Eigen::Index axis) const noexcept;

  AdaptiveWindowSettings settings_;
  std::array<TimedReading, kRoom> readings_;
  std::size_t newest_ = 0, count_ = 0;
  Vec3 velocity_ = Vec3::Zero();
};

/// Default estimator for positions counted in steps of `step`, in the reading's unit: 1 for a
/// Falcon's counts.
[[nodiscard]] AdaptiveWindow makeUsualVelocityEstimator(double step = 1.0) noexcept;

}  // namespace tandem
