// Times at which keys are due for renewal, and at which they are refused.

#include "secure/rekey_policy.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tandem::secure {
namespace {

constexpr double kBorn = 1000.0;  // [s]

TEST(RekeyPolicy, ByAge) {
  constexpr RekeyPolicy policy(kBorn);
  EXPECT_EQ(policy.age(kBorn, 0), KeyAge::kGood);
  EXPECT_EQ(policy.age(kBorn + 119.99, 0), KeyAge::kGood);
  EXPECT_EQ(policy.age(kBorn + 120.0, 0), KeyAge::kDue);
  EXPECT_EQ(policy.age(kBorn + 179.99, 0), KeyAge::kDue);
  EXPECT_EQ(policy.age(kBorn + 180.0, 0), KeyAge::kExpired);
  EXPECT_EQ(policy.age(kBorn + 1e9, 0), KeyAge::kExpired);
}

TEST(RekeyPolicy, ByDatagrams) {
  constexpr RekeyPolicy policy(kBorn);
  constexpr RekeyLimits limits;
  EXPECT_EQ(policy.age(kBorn, limits.due_packets - 1), KeyAge::kGood);
  EXPECT_EQ(policy.age(kBorn, limits.due_packets), KeyAge::kDue);
  EXPECT_EQ(policy.age(kBorn, kSealLimit - 1), KeyAge::kDue);
  EXPECT_EQ(policy.age(kBorn, kSealLimit), KeyAge::kExpired);
}

TEST(RekeyPolicy, IsDueBeforeTheSealerRefuses) {
  constexpr RekeyLimits limits;
  EXPECT_LT(limits.due_packets, kSealLimit);
  EXPECT_LT(limits.due_after, limits.refuse_after);
}

TEST(RekeyPolicy, TakesOtherLimits) {
  const RekeyPolicy policy(kBorn, {1.0, 2.0, 10, 20});
  EXPECT_EQ(policy.age(kBorn + 0.5, 9), KeyAge::kGood);
  EXPECT_EQ(policy.age(kBorn + 1.5, 9), KeyAge::kDue);
  EXPECT_EQ(policy.age(kBorn + 0.5, 15), KeyAge::kDue);
  EXPECT_EQ(policy.age(kBorn + 2.5, 9), KeyAge::kExpired);
  EXPECT_EQ(policy.age(kBorn + 0.5, 20), KeyAge::kExpired);
}

TEST(RekeyPolicy, ATimeThatIsNoNumberExpires) {
  constexpr RekeyPolicy policy(kBorn);
  EXPECT_EQ(policy.age(std::nan(""), 0), KeyAge::kExpired);
}

}  // namespace
}  // namespace tandem::secure
