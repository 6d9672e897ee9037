#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plot/projection.h"

/// \file
/// Pieces of animated SVG (SMIL): values that change over the frames of a loop.
namespace tandem::demos::plot {

/// Values of one attribute at one frame, such as the coordinates of a polygon's corners.
using FrameValues = std::vector<double>;

/// The clock that all animations of a picture share.
class LoopClock {
 public:
  /// `times` of the frames [s]; a short recording is slowed down so that it can be followed.
  explicit LoopClock(const std::vector<double>& times);

  [[nodiscard]] double length() const { return end_ - begin_; }  ///< of the recording [s]
  [[nodiscard]] double slowdown() const { return slowdown_; }
  /// Place of a frame or a time in the loop, 0 to 1.
  [[nodiscard]] double phaseOfFrame(std::size_t frame) const { return phaseOf(times_[frame]); }
  [[nodiscard]] double phaseOf(double time) const { return (time - begin_) / length(); }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] double begin() const { return begin_; }
  /// `dur="…" repeatCount="indefinite"`.
  [[nodiscard]] std::string attributes() const;

 private:
  std::vector<double> times_;
  double begin_ = 0;
  double end_ = 0;
  double slowdown_ = 1;
};

/// Frames that suffice: in between, straight lines are within `tolerance` of every value.
[[nodiscard]] std::vector<std::size_t> keyFrames(const LoopClock& clock,
                                                 const std::vector<FrameValues>& values,
                                                 double tolerance);

/// True when no value leaves its first by more than `tolerance`.
[[nodiscard]] bool isStill(const std::vector<FrameValues>& values, double tolerance);

/// `<animate>` of a polygon's points; empty when it stands still.
[[nodiscard]] std::string animatePoints(const LoopClock& clock,
                                        const std::vector<FrameValues>& points);
/// `<animateTransform>` by a shift; empty when it stands still.
[[nodiscard]] std::string animateShift(const LoopClock& clock,
                                       const std::vector<FrameValues>& shifts);
/// `<animate>` of a fill by brightness; empty when it does not change.
[[nodiscard]] std::string animateFill(const LoopClock& clock, std::string_view colour,
                                      const std::vector<FrameValues>& brightness);
/// `<animate>` of visibility: from the phase `begins[k]` on the state is `states[k]`.
[[nodiscard]] std::string animateVisibility(const LoopClock& clock,
                                            const std::vector<double>& begins,
                                            const std::vector<bool>& states);

/// "12.3,4.5 6.7,8.9" for pairs of coordinates.
[[nodiscard]] std::string pointsText(const FrameValues& points);
/// `colour` (#rrggbb) with that brightness; 1 leaves it.
[[nodiscard]] std::string shaded(std::string_view colour, double brightness);

}  // namespace tandem::demos::plot
