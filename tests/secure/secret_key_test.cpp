// Keys are never copied or printed, and are wiped at their end.

#include "tandem/plugin/secret_key.h"

#include <algorithm>
#include <concepts>
#include <cstdlib>
#include <ostream>
#include <type_traits>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "secure/secure_support.h"

namespace tandem::test {
namespace {

template <typename Value>
concept Printable = requires(std::ostream& out, const Value& value) {
  out << value;
};

static_assert(!std::is_copy_constructible_v<SecretKey> && !std::is_copy_assignable_v<SecretKey>);
static_assert(std::is_nothrow_move_constructible_v<SecretKey>);
static_assert(!Printable<SecretKey>);
static_assert(!std::is_copy_constructible_v<secure::TransportKeys>);
static_assert(!std::is_copy_constructible_v<secure::Initiator>);

TEST(SecretKey, IsRandom) {
  const SecretKey one = SecretKey::generate(), two = SecretKey::generate();
  EXPECT_FALSE(one.equals(two));
  EXPECT_TRUE(one.equals(one));
}

TEST(SecretKey, TakesBytesAndWipesWhereTheyWere) {
  std::array<std::uint8_t, SecretKey::kSize> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i + 1);
  const auto copy = bytes;
  const SecretKey key = SecretKey::take(bytes);
  EXPECT_TRUE(std::equal(copy.begin(), copy.end(), key.data()));
  EXPECT_EQ(bytes, decltype(bytes){});
}

TEST(SecretKey, MovesWithoutACopy) {
  SecretKey from = SecretKey::generate();
  const std::uint8_t* const where = from.data();
  SecretKey to = std::move(from);
  EXPECT_EQ(to.data(), where);
  EXPECT_TRUE(from.isEmpty());
  EXPECT_FALSE(from.isLocked());
  EXPECT_FALSE(from.equals(from));
  EXPECT_FALSE(to.equals(from));

  from = std::move(to);
  EXPECT_EQ(from.data(), where);
  EXPECT_TRUE(to.isEmpty());
  SecretKey& same = from;
  from = std::move(same);
  EXPECT_EQ(from.data(), where);
}

// The key's page returns to the system, wiped: reading it ends the program.
TEST(SecretKeyDeathTest, IsGoneAtItsEnd) {
  EXPECT_DEATH(
      {
        const volatile std::uint8_t* where = nullptr;
        {
          const SecretKey key = SecretKey::generate();
          where = key.data();
        }
        std::exit(*where);
      },
      "");
}

TEST(SecretKeyDeathTest, IsGoneWhenAnotherIsMovedOverIt) {
  EXPECT_DEATH(
      {
        SecretKey key = SecretKey::generate();
        const volatile std::uint8_t* const where = key.data();
        key = SecretKey::generate();
        std::exit(*where);
      },
      "");
}

TEST(SecretKeyDeathTest, StandsBeforeAPageThatNobodyMayTouch) {
  EXPECT_DEATH(
      {
        const SecretKey key = SecretKey::generate();
        const volatile std::uint8_t* const where = key.data();
        std::exit(where[SecretKey::kSize]);
      },
      "");
}

/// Returns 0 if keys work where no memory can be locked, and report it. Runs in its own process: it
/// gives up the right to lock.
int useKeysWithoutLocks() {
  const rlimit none{0, 0};
  if (setrlimit(RLIMIT_MEMLOCK, &none) != 0) return 2;
  if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) return 3;
  // Sanitizers replace mlock by a function that does nothing and succeeds.
  alignas(4096) static char page[4096];
  const bool can_lock = mlock(page, sizeof page) == 0;
  const SecretKey key = SecretKey::generate(), other = SecretKey::generate();
  return key.isLocked() == can_lock && key.equals(key) && !key.equals(other) ? 0 : 1;
}

TEST(SecretKeyDeathTest, SaysWhenMemoryCannotBeLockedAndWorksAllTheSame) {
  EXPECT_EXIT(std::exit(useKeysWithoutLocks()), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace tandem::test
