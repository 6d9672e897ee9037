#include "falcon/src/guard/latest_value.h"

#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace tandem {
namespace {

/// A value whose parts must always be of the same write.
struct Parts {
  std::uint64_t a = 0, b = 0, c = 0;
};

TEST(LatestValue, IsTheFirstOneUntilOneIsWritten) {
  LatestValue<int> value(7);
  EXPECT_FALSE(value.isNew());
  EXPECT_EQ(value.read(), 7);
}

TEST(LatestValue, IsTheNewestAndStays) {
  LatestValue<int> value;
  value.write(1);
  value.write(2);
  EXPECT_TRUE(value.isNew());
  EXPECT_EQ(value.read(), 2);
  EXPECT_FALSE(value.isNew());
  EXPECT_EQ(value.read(), 2);
  value.write(3);
  EXPECT_EQ(value.read(), 3);
}

TEST(LatestValue, IsNeverTornAndNeverGoesBack) {
  constexpr std::uint64_t kLast = 200'000;
  LatestValue<Parts> value;
  const std::jthread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) value.write({i, i, i});
  });
  std::uint64_t newest = 0;
  while (newest < kLast) {
    const Parts parts = value.read();
    ASSERT_EQ(parts.a, parts.b);
    ASSERT_EQ(parts.a, parts.c);
    ASSERT_GE(parts.a, newest);
    newest = parts.a;
  }
}

}  // namespace
}  // namespace tandem
