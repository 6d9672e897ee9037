#pragma once

#include <cstdint>
#include <vector>

#include "stability/loop_model.h"

namespace tandem::stability {

/// Kinds of events. Those of one moment happen in this order.
enum class EventKind { kArrival, kTick, kSend };

struct Event {
  double time = 0.0;  ///< from the start of the cycle [s]
  EventKind kind = EventKind::kTick;
  int channel = 0;  ///< of an arrival or send
};

/// The events of one cycle, after which ticks and packets meet again as at its start.
struct Cycle {
  double length = 0.0;  ///< [s]
  double grid = 0.0;    ///< ticks and sends of sites in phase are multiples of it [s]
  std::vector<Event> events;
  std::vector<int> in_flight;  ///< packets of each channel on their way at its start
};

/// Moments closer than this are one [s].
inline constexpr double kOneMoment = 1e-10;

/// The rate of packets that is analysed: with the haptic rate it has a period of at most 2000
/// ticks. Throws std::invalid_argument if none is within 0.1 % [Hz].
[[nodiscard]] double roundPacketRate(const LoopSettings& settings);

/// Throws as roundPacketRate() does.
[[nodiscard]] Cycle makeCycle(const LoopModel& model);

}  // namespace tandem::stability
