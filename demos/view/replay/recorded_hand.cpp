#include "replay/recorded_hand.h"

#include <algorithm>

#include "replay/number_table.h"

namespace tandem::view {

std::vector<HandMoment> readRecordedHand(const std::filesystem::path& file) {
  NumberTable table(file,
                    {"t", "device_x", "device_y", "device_z", "force_x", "force_y", "force_z"});
  std::vector<HandMoment> hand;
  while (table.next()) {
    if (!hand.empty() && !(table[0] > hand.back().time)) table.refuse("the time does not grow");
    hand.push_back(
        {table[0], Vec3(table[1], table[2], table[3]), Vec3(table[4], table[5], table[6])});
  }
  if (hand.empty()) table.refuse("there is no tick");
  return hand;
}

const HandMoment& findMoment(const std::vector<HandMoment>& hand, double time) {
  const auto after = std::ranges::upper_bound(hand, time, {}, &HandMoment::time);
  return after == hand.begin() ? hand.front() : *std::prev(after);
}

}  // namespace tandem::view
