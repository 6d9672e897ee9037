#include "run/site_links.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "tandem/coordination/simulated_link.h"

#include "scenario/site_delays.h"

namespace tandem::demos {
namespace {

/// Time in which both sites of a pair are connected [s].
struct Stay {
  double from = 0.0, until = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool has(double time) const noexcept { return time >= from && time < until; }
};

Stay computeStay(const SiteScenario& one, const SiteScenario& other) {
  const Stay all;
  return {std::max(one.comes.value_or(all.from), other.comes.value_or(all.from)),
          std::min(one.goes.value_or(all.until), other.goes.value_or(all.until))};
}

/// An end of two simulated links, of which each carries one way.
class TwoWayEnd final : public Link {
 public:
  TwoWayEnd(std::unique_ptr<SimulatedLink> out, std::unique_ptr<SimulatedLink> in, Stay stay)
      : out_(std::move(out)), in_(std::move(in)), stay_(stay) {}
  void send(const StatePacket& packet, double now) noexcept override {
    if (stay_.has(now)) out_->send(packet, now);
  }
  /// Drops what comes after the farewell.
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override {
    now_ = from;
    auto arrival = in_->receive(from, until);
    while (arrival && !stay_.has(arrival->time)) arrival = in_->receive(from, until);
    return arrival;
  }
  [[nodiscard]] bool hasLeft() const noexcept override { return now_ >= stay_.until; }

 private:
  std::unique_ptr<SimulatedLink> out_, in_;
  Stay stay_;
  double now_ = 0.0;
};

/// Spreads the bits of a number evenly (the finaliser of splitmix64).
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Pairs are counted (0, 1), (0, 2), (1, 2), (0, 3) and so on, so a further site changes none.
std::uint64_t makeSeed(std::uint64_t seed, std::size_t one, std::size_t other) {
  const std::size_t pair = other * (other - 1) / 2 + one;
  return pair == 0 ? seed : mix(seed + 0x9e3779b97f4a7c15u * pair);
}

}  // namespace

SiteLinks::SiteLinks(const Scenario& scenario)
    : count_(scenario.sites.size()), ends_(count_ * count_) {
  for (std::size_t other = 1; other < count_; ++other)
    for (std::size_t one = 0; one < other; ++one) join(scenario, one, other);
}

void SiteLinks::join(const Scenario& scenario, std::size_t one, std::size_t other) {
  const auto make = [&](std::size_t from, std::size_t to) {
    Impairments network = scenario.network;
    network.delay = computeDelay(scenario, from, to);
    network.seed = makeSeed(scenario.network.seed, one, other);
    const double in_flight = (network.delay + network.jitter) * scenario.site.packet_rate * 2.0;
    return makeSimulatedLinks(network, static_cast<std::size_t>(in_flight) + 64);
  };
  auto [there_out, there_in] = make(one, other);
  auto [back_in, back_out] = make(other, one);
  const Stay stay = computeStay(scenario.sites[one], scenario.sites[other]);
  ends_[one * count_ + other] =
      std::make_unique<TwoWayEnd>(std::move(there_out), std::move(back_in), stay);
  ends_[other * count_ + one] =
      std::make_unique<TwoWayEnd>(std::move(back_out), std::move(there_in), stay);
}

PeerLinks SiteLinks::of(int site) const {
  std::vector<Link*> links;
  for (std::size_t other = 0; other < count_; ++other)
    if (Link* link = ends_[static_cast<std::size_t>(site) * count_ + other].get())
      links.push_back(link);
  return PeerLinks(std::move(links));
}

}  // namespace tandem::demos
