#include <algorithm>
#include <cmath>

#include "island/smooth_motion.h"

// The rules of Runge-Kutta. Their last stage is the first of the next step.
//
// Order 5: Tsitouras (2011, Computers & Mathematics with Applications 62, 770-775), seven stages.
// An embedded result of order 4 gives the error. For an oscillation it is a sixth of Dormand and
// Prince's at the same cost.
//
// Order 4: the classical rule of four stages and the next step's first. With a part of that one
// instead of the fourth, the result is of order 3 (Hairer, Norsett, Wanner 1993, II.4): it gives
// an error that is larger than the step's own.

namespace tandem {

void SmoothMotion::tryStep(double from, double h) noexcept {
  using Look = SmoothForces::Look;
  const Eigen::Index n = forces_.size();
  const auto y = y_.head(n);
  const auto k1 = k_[0].head(n), k3 = k_[2].head(n), k4 = k_[3].head(n), k5 = k_[4].head(n),
             k6 = k_[5].head(n);
  const auto k2 = k_[1].head(n);
  auto next = next_.head(n);
  const auto evaluate = [&](int stage, double part, Look look) {
    forces_.evaluate(from + part * h, next_.data(), k_[stage].data(), look);
  };
  next = y + (h * 0.161) * k1;
  evaluate(1, 0.161, Look::kPushing);
  next = y - (h * 0.008480655492356989) * k1 + (h * 0.335480655492357) * k2;
  evaluate(2, 0.327, Look::kPushing);
  next = y + (h * 2.8971530571054935) * k1 - (h * 6.359448489975075) * k2 +
         (h * 4.3622954328695815) * k3;
  evaluate(3, 0.9, Look::kPushing);
  next = y + (h * 5.325864828439257) * k1 - (h * 11.748883564062828) * k2 +
         (h * 7.4955393428898365) * k3 - (h * 0.09249506636175525) * k4;
  evaluate(4, 0.9800255409045097, Look::kPushing);
  next = y + (h * 5.86145544294642) * k1 - (h * 12.92096931784711) * k2 +
         (h * 8.159367898576159) * k3 - (h * 0.071584973281401) * k4 -
         (h * 0.028269050394068383) * k5;
  evaluate(5, 1.0, Look::kPushing);
  next = y + (h * 0.09646076681806523) * k1 + (h * 0.01) * k2 + (h * 0.4798896504144996) * k3 +
         (h * 1.379008574103742) * k4 - (h * 3.290069515436081) * k5 + (h * 2.324710524099774) * k6;
  evaluate(6, 1.0, Look::kAll);
}

void SmoothMotion::tryStepOfOrder4(double from, double h) noexcept {
  using Look = SmoothForces::Look;
  const Eigen::Index n = forces_.size();
  const auto y = y_.head(n);
  const auto k1 = k_[0].head(n), k2 = k_[1].head(n), k3 = k_[2].head(n), k4 = k_[3].head(n);
  auto next = next_.head(n);
  const auto evaluate = [&](int stage, double part, Look look) {
    forces_.evaluate(from + part * h, next_.data(), k_[stage].data(), look);
  };
  next = y + (0.5 * h) * k1;
  evaluate(1, 0.5, Look::kPushing);
  next = y + (0.5 * h) * k2;
  evaluate(2, 0.5, Look::kPushing);
  next = y + h * k3;
  evaluate(3, 1.0, Look::kPushing);
  next = y + (h / 6.0) * (k1 + 2.0 * (k2 + k3) + k4);
  evaluate(6, 1.0, Look::kAll);
}

double SmoothMotion::estimateErrorOfOrder4(double h) noexcept {
  const Eigen::Index n = forces_.size();
  auto e = k_[1].head(n);
  e = (h / 6.0) * (k_[6].head(n) - k_[3].head(n));
  return measureError(e.data());
}

double SmoothMotion::estimateError(double h) noexcept {
  const Eigen::Index n = forces_.size();
  // The second stage is no longer needed; its memory takes the error.
  auto e = k_[1].head(n);
  e = (h * 0.015151515151515152) * k_[6].head(n) - (h * 0.45808210592918697) * k_[5].head(n) +
      (h * 0.5823571654525552) * k_[4].head(n) - (h * 0.1447110071732629) * k_[3].head(n) +
      (h * 0.007880878010261995) * k_[2].head(n) - (h * 0.0008164344596567469) * k_[1].head(n) -
      (h * 0.001780011052225777) * k_[0].head(n);
  return measureError(e.data());
}

double SmoothMotion::measureError(const double* e) const noexcept {
  // All errors are in metres. An error of velocity counts for the springs' response time (a
  // radian), an error of orientation at the surface.
  double worst = 0.0;
  const auto look = [&](const double* values, int count, double scale) {
    for (int i = 0; i < count; ++i) {
      const double size = scale * std::abs(values[i]);
      if (!(size <= worst)) worst = size;
    }
  };
  for (const SmoothForces::Mover& mover : forces_.movers()) {
    const double* values = e + mover.offset;
    look(values, 3, 1.0);
    look(values + 3, 3, answer_);
    if (!mover.turns) continue;
    look(values + SmoothForces::kQ, 4, 2.0 * mover.radius);
    look(values + SmoothForces::kW, 3, answer_ * mover.radius);
  }
  return worst;
}

}  // namespace tandem
