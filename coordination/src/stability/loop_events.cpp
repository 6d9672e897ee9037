#include "stability/loop_events.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tandem::stability {
namespace {

constexpr int kMostTicks = 2000;  // of a cycle

/// Ticks and packets of a cycle.
struct Ratio {
  int ticks = 1, packets = 1;
};

Ratio findRatio(double haptic_rate, double packet_rate) {
  for (int ticks = 1; ticks <= kMostTicks; ++ticks) {
    const double packets = ticks * packet_rate / haptic_rate;
    const double whole = std::round(packets);
    if (whole >= 1.0 && std::abs(packets - whole) < 1e-9 * whole)
      return {ticks, static_cast<int>(whole)};
  }
  throw std::invalid_argument("packet_rate = " + std::to_string(packet_rate) +
                              ": its ratio to the haptic rate of " + std::to_string(haptic_rate) +
                              " Hz has no short period; choose one that both divide");
}

class CycleMaker {
 public:
  explicit CycleMaker(const LoopModel& model) : model_(model), settings_(model.settings) {}

  Cycle make() {
    const Ratio ratio = findRatio(settings_.haptic_rate, settings_.packet_rate);
    cycle_.length = ratio.ticks / settings_.haptic_rate;
    cycle_.grid = 1.0 / (settings_.haptic_rate * ratio.packets);
    for (int k = 0; k < ratio.ticks; ++k)
      cycle_.events.push_back({k / settings_.haptic_rate, EventKind::kTick, 0});
    for (std::size_t c = 0; c < model_.channels.size(); ++c)
      addPackets(static_cast<int>(c), ratio.packets);
    std::stable_sort(cycle_.events.begin(), cycle_.events.end(), &comesBefore);
    return std::move(cycle_);
  }

 private:
  /// In a lasting run, an arrival of each cycle belongs to a packet of this or an earlier one.
  void addPackets(int c, int packets) {
    const Channel& channel = model_.channels[static_cast<std::size_t>(c)];
    const int before = static_cast<int>(std::ceil(channel.delay * settings_.packet_rate)) + 2;
    int in_flight = 0;
    for (int k = -before; k < packets; ++k) {
      const double sent = (k + channel.phase) / settings_.packet_rate;
      const double arrival = findArrival(sent, channel.delay);
      const bool is_of_cycle = sent > -kOneMoment && sent < cycle_.length - kOneMoment;
      if (is_of_cycle) cycle_.events.push_back({sent, EventKind::kSend, c});
      if (sent <= -kOneMoment && arrival > -kOneMoment) ++in_flight;
      if (arrival > -kOneMoment && arrival < cycle_.length - kOneMoment)
        cycle_.events.push_back({std::max(arrival, 0.0), EventKind::kArrival, c});
    }
    cycle_.in_flight.push_back(in_flight);
  }

  /// A packet is not there in the tick that sent it.
  [[nodiscard]] double findArrival(double sent, double delay) const {
    const double next = std::floor((sent + kOneMoment) * settings_.haptic_rate) + 1.0;
    return std::max(sent + delay, next / settings_.haptic_rate);
  }

  static bool comesBefore(const Event& a, const Event& b) {
    const auto moment_a = std::llround(a.time / kOneMoment);
    const auto moment_b = std::llround(b.time / kOneMoment);
    return moment_a != moment_b ? moment_a < moment_b : a.kind < b.kind;
  }

  const LoopModel& model_;
  const LoopSettings& settings_;
  Cycle cycle_;
};

}  // namespace

Cycle makeCycle(const LoopModel& model) { return CycleMaker(model).make(); }

}  // namespace tandem::stability
