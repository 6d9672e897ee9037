#include "site/told_objects.h"

#include <algorithm>

namespace tandem {
namespace {

/// Rates at which a moving object is told, by its nearness, and one that has come to rest [Hz].
constexpr double kNearRate = 32.0, kFarRate = 8.0, kRestRate = 4.0;
/// An object is due if it would be late with the next packet: after its period, and the rounding of
/// packets' times.
constexpr double kLate = 1.01;
/// Way after which an object is twice as urgent [m].
constexpr double kLongWay = 0.01;
/// Times that an object is told once it has come to rest, and its most urgency then: below that of
/// a moving one that is due.
constexpr int kRepeats = 3;
constexpr double kMostRestUrgency = 0.5;

}  // namespace

void ToldObjects::setCount(std::size_t count) {
  told_.resize(count);
  urgent_.reserve(kMaxObjectsPerPacket + 1);
  chosen_.reserve(kMaxObjectsPerPacket);
}

void ToldObjects::forget(double time) noexcept {
  for (Told& told : told_) {
    told.at = time - 1.0 / kRestRate;
    told.repeats = kRepeats;
  }
}

/// At which the object is to be told [Hz]; 0 if the peer knows it as it is.
double ToldObjects::computeRate(const Told& told, const ObjectMotion& motion) const noexcept {
  if (motion.changedAt() <= told.at) return told.repeats > 0 ? kRestRate : 0.0;
  switch (told.nearness.value()) {
    case Nearness::kTouch:
      return packet_rate_;
    case Nearness::kNear:
      return kNearRate;
    case Nearness::kFar:
      break;
  }
  return kFarRate;
}

/// Finds the most urgent objects, the last place left out.
void ToldObjects::findUrgent(const std::vector<ObjectMotion>& motions, const PacketRoom& room,
                             double time) noexcept {
  urgent_.clear();
  for (std::size_t i = 0; i < told_.size(); ++i) {
    const double rate = computeRate(told_[i], motions[i]), since = time - told_[i].at;
    if (rate == 0.0 || (!room.fills && rate * (since + room.next) < kLate)) continue;
    const double way = motions[i].travelled() - told_[i].travelled;
    const double urgency =
        (room.prefers_nearest ? rate : kFarRate) * since * (1.0 + way / kLongWay);
    const bool rests = motions[i].changedAt() <= told_[i].at;
    add({i, rests ? std::min(urgency, kMostRestUrgency) : urgency}, room.places - 1);
  }
}

/// Keeps the `most` most urgent, sorted.
void ToldObjects::add(const Candidate& candidate, std::size_t most) noexcept {
  const auto place = std::find_if(urgent_.begin(), urgent_.end(), [&](const Candidate& other) {
    return other.urgency < candidate.urgency;
  });
  urgent_.insert(place, candidate);
  if (urgent_.size() > most) urgent_.pop_back();
}

void ToldObjects::choose(std::size_t object) noexcept {
  told_[object].is_chosen = true;
  chosen_.push_back(object);
}

/// Goes on until `until` objects are chosen, or all.
void ToldObjects::goRound(std::size_t until) noexcept {
  for (std::size_t i = 0; i < told_.size() && chosen_.size() < until; ++i) {
    const std::size_t object = next_;
    next_ = (next_ + 1) % told_.size();
    if (!told_[object].is_chosen) choose(object);
  }
}

const std::vector<std::size_t>& ToldObjects::choose(const std::vector<ObjectMotion>& motions,
                                                    const PacketRoom& room, double time) noexcept {
  chosen_.clear();
  findUrgent(motions, room, time);
  for (const Candidate& candidate : urgent_) choose(candidate.object);
  goRound(room.fills ? kMaxObjectsPerPacket : chosen_.size() + 1);
  std::sort(chosen_.begin(), chosen_.end());
  for (const std::size_t object : chosen_) {
    Told& told = told_[object];
    const bool has_changed = motions[object].changedAt() > told.at;
    told.repeats = has_changed ? kRepeats : std::max(told.repeats - 1, 0);
    told.at = time;
    told.travelled = motions[object].travelled();
    told.is_chosen = false;
  }
  return chosen_;
}

}  // namespace tandem
