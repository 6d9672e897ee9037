#include "link/round_trip.h"

#include <cmath>

namespace tandem {
namespace {

/// Weight of a new trip in the smoothed one, as in RFC 6298.
constexpr double kNews = 0.125;
/// A trip slower than the fastest by more than this says little about the clocks [s].
constexpr double kNearFastest = 2e-4;
/// Weight of a fast trip in the offset; their noise averages out.
constexpr double kOffsetNews = 0.1;

}  // namespace

void RoundTrip::add(double t0, double t2, double hold, double t3) noexcept {
  const double trip = (t3 - t0) - hold;
  const double offset = t2 - hold / 2.0 - (t0 + t3) / 2.0;
  if (!(trip >= 0.0) || !(hold >= 0.0) || !std::isfinite(trip) || !std::isfinite(offset)) return;
  const double fastest_before = fastest_.value();
  fastest_.add(trip, t3);
  if (!is_known_) {
    is_known_ = true;
    trip_ = trip;
    offset_ = offset;
    return;
  }
  trip_ += kNews * (trip - trip_);
  if (trip < fastest_before)
    offset_ = offset;
  else if (trip < fastest_.value() + kNearFastest)
    offset_ += kOffsetNews * (offset - offset_);
}

}  // namespace tandem
