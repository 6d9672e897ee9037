#include "session/paced_time.h"

#include <algorithm>

namespace tandem::view {
namespace {

constexpr double kSettle = 0.02;      // before a pause [s]
constexpr double kMostBehind = 0.02;  // [s]
constexpr double kSameTime = 1e-9;    // rounding of times [s]

}  // namespace

PacedTime::PacedTime(SitePair& pair, double clock, const Pace& pace) : pair_(pair) {
  if (pace.is_paused)
    for (const double end = pair.time() + kSettle; pair.time() < end;) pair.tick();
  begin(clock, {});
  advance(clock, pace);
}

void PacedTime::begin(double clock, const Pace& pace) {
  pace_ = pace;
  clock_ = clock;
  time_ = pair_.time();
}

void PacedTime::advance(double clock, const Pace& pace, int steps) {
  if (pace.is_paused && !pace_.is_paused) pair_.tickOneHostStep();
  if (pace.is_paused)
    for (int step = 0; step < steps; ++step) pair_.tickOneHostStep();
  if (pace.is_paused || pace != pace_) return begin(clock, pace);
  const double due = time_ + pace.speed * (clock - clock_);
  const double most = pair_.time() + kMostBehind;
  const double until = std::min(due, most) + kSameTime;
  while (pair_.time() + pair_.period() <= until) pair_.tick();
  if (due > most) begin(clock, pace);
}

}  // namespace tandem::view
