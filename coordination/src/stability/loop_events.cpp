#include "stability/loop_events.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace tandem::stability {
namespace {

constexpr int kMostTicks = 2000;  // of a cycle

/// Ticks and packets of a cycle.
struct Ratio {
  int ticks = 1, packets = 1;
};

/// The shortest cycle whose packet rate is off by at most `error` of itself.
std::optional<Ratio> findRatio(double haptic_rate, double packet_rate, double error) {
  for (int ticks = 1; ticks <= kMostTicks; ++ticks) {
    const double packets = ticks * packet_rate / haptic_rate;
    const double whole = std::round(packets);
    if (whole >= 1.0 && std::abs(packets - whole) < error * whole)
      return Ratio{ticks, static_cast<int>(whole)};
  }
  return std::nullopt;
}

Ratio findRatio(double haptic_rate, double packet_rate) {
  for (const double error : {1e-9, 1e-6, 1e-5, 1e-4, 1e-3})
    if (const auto ratio = findRatio(haptic_rate, packet_rate, error)) return *ratio;
  throw std::invalid_argument("packet_rate = " + std::to_string(packet_rate) +
                              ": its ratio to the haptic rate of " + std::to_string(haptic_rate) +
                              " Hz has no period of at most 2000 ticks; choose a higher one");
}

class CycleMaker {
 public:
  explicit CycleMaker(const LoopModel& model)
      : model_(model), settings_(model.settings), rate_(roundPacketRate(settings_)) {}

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
    const int before = static_cast<int>(std::ceil(channel.delay * rate_)) + 2;
    int in_flight = 0;
    for (int k = -before; k < packets; ++k) {
      const double sent = (k + channel.phase) / rate_;
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
  double rate_;  ///< of packets [Hz]
  Cycle cycle_;
};

}  // namespace

double roundPacketRate(const LoopSettings& settings) {
  const Ratio ratio = findRatio(settings.haptic_rate, settings.packet_rate);
  return ratio.packets * settings.haptic_rate / ratio.ticks;
}

Cycle makeCycle(const LoopModel& model) { return CycleMaker(model).make(); }

}  // namespace tandem::stability
