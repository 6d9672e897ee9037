#include "guard/velocity_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tandem {
namespace {

constexpr double kPi = 3.14159265358979323846;

bool isUsable(double time, const Vec3& p) noexcept { return std::isfinite(time) && p.allFinite(); }

/// Least-squares slope from sums over points relative to the newest one.
class BestFit {
 public:
  void add(double t, double x) noexcept {
    n_ += 1.0;
    t_ += t;
    x_ += x;
    tt_ += t * t;
    tx_ += t * x;
  }
  [[nodiscard]] double slope() const noexcept {
    return (n_ * tx_ - t_ * x_) / (n_ * tt_ - t_ * t_);
  }

 private:
  double n_ = 1.0, t_ = 0.0, x_ = 0.0, tt_ = 0.0, tx_ = 0.0;  // the newest point is (0, 0)
};

}  // namespace

Vec3 FirstDifference::add(double time, const Vec3& p) noexcept {
  if (!isUsable(time, p) || (has_last_ && time <= last_.time)) return velocity_;
  if (has_last_) velocity_ = (p - last_.p) / (time - last_.time);
  last_ = {time, p};
  has_last_ = true;
  return velocity_;
}

Vec3 LowPassDifference::add(double time, const Vec3& p) noexcept {
  if (!isUsable(time, p) || (has_last_ && time <= last_.time)) return velocity_;
  if (has_last_) {
    const double dt = time - last_.time;
    velocity_ += -std::expm1(-2.0 * kPi * cutoff_ * dt) * ((p - last_.p) / dt - velocity_);
  }
  last_ = {time, p};
  has_last_ = true;
  return velocity_;
}

Vec3 AdaptiveWindow::add(double time, const Vec3& p) noexcept {
  if (!isUsable(time, p) || (count_ > 0 && time <= reading(0).time)) return velocity_;
  newest_ = (newest_ + 1) % kRoom;
  readings_[newest_] = {time, p};
  count_ = std::min(count_ + 1, kRoom);
  if (count_ > 1)
    for (Eigen::Index axis = 0; axis < 3; ++axis) velocity_[axis] = findSlope(axis);
  return velocity_;
}

double AdaptiveWindow::findSlope(Eigen::Index axis) const noexcept {
  const TimedReading& newest = reading(0);
  const double band = settings_.tolerance + settings_.stamp_error * std::abs(velocity_[axis]);
  // Range of slopes through the newest reading that miss no visited reading by more than the band.
  double least = -std::numeric_limits<double>::infinity(), most = -least;
  double slope = 0.0;
  BestFit best;
  for (std::size_t back = 1; back < count_; ++back) {
    const double t = newest.time - reading(back).time;
    const double way = newest.p[axis] - reading(back).p[axis];
    const double to_here = way / t;
    if (back > 1 && (t > settings_.longest || to_here < least || to_here > most)) break;
    best.add(-t, -way);
    slope = settings_.fit == WindowFit::kBest ? best.slope() : to_here;
    least = std::max(least, (way - band) / t);
    most = std::min(most, (way + band) / t);
  }
  return slope;
}

AdaptiveWindow makeUsualVelocityEstimator(double step) noexcept {
  AdaptiveWindowSettings settings;
  settings.tolerance *= step;
  return AdaptiveWindow(settings);
}

}  // namespace tandem
