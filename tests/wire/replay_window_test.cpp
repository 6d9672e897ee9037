#include "coordination/src/wire/replay_window.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();

/// The window of the standard, implemented by remembering every number.
class PlainWindow {
 public:
  [[nodiscard]] bool check(std::uint64_t sequence) const {
    if (taken_.empty()) return true;
    const std::uint64_t newest = *taken_.rbegin();
    if (sequence < newest && newest - sequence >= ReplayWindow::kSize) return false;
    return taken_.count(sequence) == 0;
  }

  bool commit(std::uint64_t sequence) { return check(sequence) && taken_.insert(sequence).second; }

 private:
  std::set<std::uint64_t> taken_;
};

/// The next incoming number: near the sender's position, or a jump.
std::uint64_t drawSequence(std::mt19937_64& random, std::uint64_t around) {
  switch (random() % 8) {
    case 0:
      return around + random() % (3 * ReplayWindow::kSize);
    case 1:
      return around - std::min(around, random() % (2 * ReplayWindow::kSize));
    case 2:
      return around - std::min(around, ReplayWindow::kSize - 2 + random() % 4);
    default:
      return around + random() % 70 - std::min<std::uint64_t>(around, 64);
  }
}

TEST(ReplayWindow, AgreesWithASetOfAllNumbers) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    std::mt19937_64 random(seed);
    ReplayWindow window;
    PlainWindow plain;
    std::uint64_t around = seed == 4 ? kLast - 200000 : 0;
    for (int i = 0; i < 50000; ++i) {
      const std::uint64_t sequence = drawSequence(random, around);
      const bool fresh = plain.check(sequence);
      ASSERT_EQ(window.check(sequence), fresh) << "seed " << seed << ", number " << i;
      if (random() % 4 == 0) continue;  // the datagram did not open
      ASSERT_EQ(plain.commit(sequence), fresh);
      ASSERT_EQ(window.commit(sequence), fresh) << "seed " << seed << ", number " << i;
      if (fresh) around = std::max(around, sequence);
      // Stops before the last number.
      if (around > kLast - 10 * ReplayWindow::kSize) break;
    }
  }
}

TEST(ReplayWindow, ForgedNumberFarAheadMovesNothing) {
  ReplayWindow window;
  for (std::uint64_t n = 0; n < 100; n += 2) ASSERT_TRUE(window.commit(n));
  const std::uint64_t before_the_last = kLast - 1;
  for (const std::uint64_t forged : {std::uint64_t{5000}, before_the_last, kLast})
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(window.check(forged)) << "and does not open";
  for (std::uint64_t n = 0; n < 100; ++n) EXPECT_EQ(window.check(n), n % 2 == 1) << n;
}

TEST(ReplayWindow, IsExactlyAsLongAsItSays) {
  for (const std::uint64_t newest : {std::uint64_t{1023}, std::uint64_t{1024}, kLast}) {
    ReplayWindow window;
    ASSERT_TRUE(window.commit(newest));
    EXPECT_FALSE(window.check(newest));
    EXPECT_TRUE(window.check(newest - 1023));
    if (newest >= 1024) {
      EXPECT_FALSE(window.check(newest - 1024));
    }
    EXPECT_TRUE(window.commit(newest - 1023));
    EXPECT_FALSE(window.commit(newest - 1023));
  }
}

TEST(ReplayWindow, TakesTheFirstWhateverItIs) {
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{1} << 40, kLast}) {
    ReplayWindow window;
    EXPECT_TRUE(window.check(first));
    EXPECT_TRUE(window.commit(first));
    EXPECT_FALSE(window.commit(first));
  }
}

TEST(ReplayWindow, BitsAreNotInheritedOverAJump) {
  for (const std::uint64_t jump : {1U, 63U, 64U, 1023U, 1024U, 1025U, 5000U}) {
    ReplayWindow window;
    for (std::uint64_t n = 0; n < 1024; ++n) ASSERT_TRUE(window.commit(n));
    ASSERT_TRUE(window.commit(1023 + jump));
    for (std::uint64_t n = 0; n < 1023 + jump; ++n)
      ASSERT_EQ(window.check(n), n > 1023 && 1023 + jump - n < 1024) << jump << ", " << n;
  }
}

}  // namespace
}  // namespace tandem
