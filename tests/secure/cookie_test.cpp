// A cookie is valid for its question and one to two slots only.

#include "secure/cookie.h"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "secure/secure_support.h"

namespace tandem::test {
namespace {

using secure::Cookie;
using secure::CookieMaker;
using secure::CookieSubject;

constexpr double kSlot = 10.0;  // [s]
constexpr CookieSubject kSubject{1, 2, 0x0123456789abcdef};

TEST(Cookie, HoldsForOneToTwoSlots) {
  const CookieMaker maker(SecretKey::generate(), kSlot);
  for (const double made : {0.0, 3.0, 9.999, 1e6, -3.0}) {
    SCOPED_TRACE(made);
    const double slot_end = (std::floor(made / kSlot) + 1) * kSlot;
    const Cookie cookie = maker.make(kSubject, made);
    EXPECT_TRUE(maker.accepts(cookie, kSubject, made));
    EXPECT_TRUE(maker.accepts(cookie, kSubject, slot_end + kSlot - 1e-3));
    EXPECT_FALSE(maker.accepts(cookie, kSubject, slot_end + kSlot + 1e-3));
    EXPECT_FALSE(maker.accepts(cookie, kSubject, slot_end - kSlot - 1e-3));  // not yet made
  }
}

TEST(Cookie, IsAPureFunctionOfTheTimeGiven) {
  const SecretKey secret = SecretKey::generate();
  const CookieMaker one(copyOf(secret), kSlot), two(copyOf(secret), kSlot);
  const Cookie cookie = one.make(kSubject, 25.0);
  (void)one.make(kSubject, 1e9);
  EXPECT_EQ(one.make(kSubject, 25.0), cookie);
  EXPECT_EQ(two.make(kSubject, 20.0), cookie);
  EXPECT_NE(two.make(kSubject, 30.0), cookie);
}

TEST(Cookie, BelongsToOneSubject) {
  const CookieMaker maker(SecretKey::generate(), kSlot);
  const Cookie cookie = maker.make(kSubject, 1.0);
  CookieSubject other = kSubject;
  const auto expectRefused = [&](const char* what) {
    EXPECT_FALSE(maker.accepts(cookie, other, 1.0)) << what;
    other = kSubject;
  };
  other.from ^= 1;
  expectRefused("from");
  other.to ^= 1;
  expectRefused("to");
  std::swap(other.from, other.to);
  expectRefused("from and to");
  other.nonce ^= std::uint64_t{1} << 63;
  expectRefused("nonce");
  EXPECT_TRUE(maker.accepts(cookie, kSubject, 1.0));
}

TEST(Cookie, BelongsToOneMaker) {
  const CookieMaker one, two;
  EXPECT_FALSE(two.accepts(one.make(kSubject, 1.0), kSubject, 1.0));
}

TEST(Cookie, ForgedOnesAreRefused) {
  constexpr std::uint64_t kSeed = 17;
  Draw draw(kSeed);
  const CookieMaker maker(draw.key(), kSlot);
  const Cookie right = maker.make(kSubject, 1.0);
  for (std::size_t bit = 0; bit < 8 * right.size(); ++bit) {
    Cookie wrong = right;
    wrong[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_FALSE(maker.accepts(wrong, kSubject, 1.0)) << "bit " << bit;
  }
  for (int trial = 0; trial < 100000; ++trial) {
    Cookie wrong;
    for (std::uint8_t& byte : wrong) byte = static_cast<std::uint8_t>(draw.number());
    ASSERT_FALSE(maker.accepts(wrong, kSubject, 1.0)) << "seed " << kSeed << ", trial " << trial;
  }
}

TEST(Cookie, TakesAnyTime) {
  const CookieMaker maker;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double now : {kInfinity, -kInfinity, std::nan(""), 1e300, -1e300})
    EXPECT_TRUE(maker.accepts(maker.make(kSubject, now), kSubject, now)) << now;
}

TEST(Cookie, RefusesSlotsThatAreNone) {
  for (const double length : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(CookieMaker(SecretKey::generate(), length), std::invalid_argument) << length;
  SecretKey key = SecretKey::generate();
  const SecretKey taken = std::move(key);
  EXPECT_THROW(CookieMaker(std::move(key)), std::invalid_argument);
}

}  // namespace
}  // namespace tandem::test
