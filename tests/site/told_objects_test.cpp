// Private header of the plugin: what a peer has been told of the objects.
#include "plugin/src/site/told_objects.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr double kPeriod = 1.0 / 128.0;  // of packets [s]

/// Objects that stand or move along x, and the packets to one peer.
struct Telling {
  explicit Telling(std::size_t count) : speeds(count), motions(count, ObjectMotion(0.0)) {
    told.setCount(count);
    told.forget(0.0);
    waits.resize(count);
    longest.resize(count);
  }
  /// One packet; counts for each object the packets since it was told.
  const std::vector<std::size_t>& tell(const PacketRoom& room) {
    ++packets;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      RigidState state;
      state.p_W.x() = speeds[i] * now();
      motions[i].note(state, now());
    }
    const auto& chosen = told.choose(motions, room, now());
    for (int& wait : waits) ++wait;
    for (const std::size_t i : chosen) waits[i] = 0;
    for (std::size_t i = 0; i < waits.size(); ++i) longest[i] = std::max(longest[i], waits[i]);
    return chosen;
  }
  void run(int count, const PacketRoom& room) {
    for (int n = 0; n < count; ++n) tell(room);
  }
  void forget() { std::fill(longest.begin(), longest.end(), 0); }
  [[nodiscard]] double now() const { return packets * kPeriod; }

  std::vector<double> speeds;  // [m/s]
  std::vector<ObjectMotion> motions;
  ToldObjects told{1.0 / kPeriod};
  std::vector<int> waits, longest;
  int packets = 0;
};

PacketRoom due(std::size_t places) { return {places, false, true, kPeriod}; }

TEST(ToldObjects, AllGoIfAllFit) {
  Telling telling(8);
  telling.speeds[3] = 0.1;
  for (int n = 0; n < 20; ++n) {
    const std::vector<std::size_t>& chosen = telling.tell(PacketRoom{});
    ASSERT_EQ(chosen, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7})) << n;
  }
}

// 128 Hz within reach, 32 Hz near, 8 Hz far. A place more goes round all 100 objects.
TEST(ToldObjects, RatesGoByNearness) {
  Telling telling(100);
  for (const std::size_t moving : {10u, 20u, 30u}) telling.speeds[moving] = 1e-3;
  telling.told.look(10, Nearness::kTouch, 0.0);
  telling.told.look(20, Nearness::kNear, 0.0);
  telling.run(300, due(8));
  telling.forget();
  telling.run(300, due(8));
  EXPECT_EQ(telling.longest[10], 0);
  EXPECT_EQ(telling.longest[20], 3);
  EXPECT_EQ(telling.longest[30], 15);
  EXPECT_GE(*std::max_element(telling.longest.begin(), telling.longest.end()), 90);
}

// 60 objects within reach move fast, and there are only two places: the last one still has its
// turn.
TEST(ToldObjects, NoneWaitsForEver) {
  Telling telling(100);
  for (std::size_t i = 0; i < 60; ++i) {
    telling.speeds[i] = 10.0;
    telling.told.look(i, Nearness::kTouch, 0.0);
  }
  telling.run(1000, due(2));
  EXPECT_LE(*std::max_element(telling.longest.begin(), telling.longest.end()), 100);
}

// There are places for 384 a second, and 60 objects want eight a second each.
TEST(ToldObjects, WhatMovedFurtherGoesEarlier) {
  Telling telling(60);
  for (std::size_t i = 0; i < 60; ++i) telling.speeds[i] = i == 7 ? 1.0 : 1e-3;
  telling.run(100, due(3));
  telling.forget();
  telling.run(200, due(3));
  EXPECT_EQ(telling.longest[7], 15);
  EXPECT_GT(telling.longest[8], 16);
}

// Packets get lost, so the last state of an object is told four times.
TEST(ToldObjects, RestIsToldAFewTimes) {
  Telling telling(200);
  telling.run(800, due(8));
  telling.speeds[150] = 0.1;
  telling.run(20, due(8));
  telling.speeds[150] = 0.0;
  int times = 0;
  for (int n = 0; n < 128; ++n) {
    const auto& chosen = telling.tell(due(8));
    times += std::find(chosen.begin(), chosen.end(), 150u) != chosen.end() ? 1 : 0;
  }
  EXPECT_GE(times, 4);
  EXPECT_LE(times, 5);  // its turn may be among them
}

// A peer that has begun anew knows nothing: each is told within twelve packets.
TEST(ToldObjects, AllAreToldAnewOnceForgotten) {
  Telling telling(64);
  telling.run(400, due(8));
  telling.told.forget(telling.now());
  telling.run(12, due(8));
  EXPECT_LT(*std::max_element(telling.waits.begin(), telling.waits.end()), 12);
}

}  // namespace
}  // namespace tandem
