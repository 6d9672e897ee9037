#include "link/link_tally.h"

namespace tandem::demos {
namespace {

double mean(double sum, std::uint64_t count) noexcept {
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

double share(std::uint64_t part, std::uint64_t count) noexcept {
  return mean(static_cast<double>(part), count);
}

struct Spread {
  double mean = 0.0;      // [s]
  double variance = 0.0;  // [s^2]
};

/// Spread of a delay that is uniform in delay +- jitter, with values below 0 set to 0.
Spread spreadOf(double delay, double jitter) noexcept {
  if (jitter <= delay) return {delay, jitter * jitter / 3.0};
  const double longest = delay + jitter;
  const double mean = longest * longest / (4.0 * jitter);
  return {mean, longest * longest * longest / (6.0 * jitter) - mean * mean};
}

}  // namespace

void LinkTally::noteSent(const ChannelConditions& conditions, Entrance entrance) noexcept {
  if (entrance == Entrance::kCutOff || entrance == Entrance::kTooLong) return;
  ++drawn_;
  loss_ += conditions.impairments.loss;
  if (entrance == Entrance::kLost) return;
  ++kept_;
  duplicate_ += conditions.impairments.duplicate;
  reorder_ += conditions.impairments.reorder;
  corrupt_ += conditions.corrupt;
}

void LinkTally::noteDelivered(const Delivery& delivery, double now) noexcept {
  latencies_.add(now - delivery.due);
  if (delivery.is_reordered) return;
  const Spread asked = spreadOf(delivery.delay, delivery.jitter);
  const double delay = now - delivery.sent, deviation = delay - asked.mean;
  delays_.add(delay);
  ++delayed_;
  asked_delay_ += asked.mean;
  asked_variance_ += asked.variance;
  deviation_ += deviation;
  deviation_squared_ += deviation * deviation;
}

LinkFigures LinkTally::asked() const noexcept {
  return {mean(loss_, drawn_),          mean(duplicate_, kept_),
          mean(reorder_, kept_),        mean(corrupt_, kept_),
          mean(asked_delay_, delayed_), std::sqrt(3.0 * mean(asked_variance_, delayed_))};
}

LinkFigures LinkTally::achieved(const DatagramChannelCounts& counts) const noexcept {
  const double off = mean(deviation_, delayed_);
  const double variance = mean(deviation_squared_, delayed_) - off * off;
  const double spread = delayed_ > 0 ? std::sqrt(3.0 * std::max(0.0, variance)) : off;
  return {share(counts.lost, drawn_),         share(counts.duplicated, kept_),
          share(counts.reordered, kept_),     share(counts.corrupted, kept_ + counts.duplicated),
          mean(asked_delay_, delayed_) + off, spread};
}

}  // namespace tandem::demos
