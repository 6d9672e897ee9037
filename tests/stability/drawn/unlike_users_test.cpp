// Users who differ grow in the simulator as the analysis says.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tandem/coordination/stability_advice.h"

#include "stability/drawn/simulated_growth.h"
#include "support/random.h"

namespace tandem {
namespace {

/// Devices, contacts and delays of all users by chance.
LoopSettings draw(test::Random& random, int row) {
  LoopSettings settings;
  settings.stand_in = static_cast<StandInKind>(row % 3);
  settings.users = row % 2 == 0 ? 2 : 3;
  settings.mode = CoordinationMode::kAverage;
  settings.object_mass = 0.1 * settings.users;
  settings.delay = random.uniform(0.02, 0.12);
  settings.device_damping = random.uniform(2.0, 8.0);
  settings.contact.stiffness = random.uniform(500.0, 3000.0);
  settings.coordination = {random.uniform(100.0, 500.0), random.uniform(10.0, 40.0)};
  for (int i = 0; i < settings.users; ++i) {
    LoopUser& user = settings.each.emplace_back();
    user.device_mass = random.uniform(0.4, 1.0);
    user.device_damping = random.uniform(0.2, 1.0);
    user.contact_stiffness = random.uniform(0.5, 1.0);
    user.contact_damping = random.uniform(0.5, 1.0);
    for (int k = 0; k < settings.users; ++k) user.delays.push_back(random.uniform(0.3, 1.0));
  }
  return settings;
}

TEST(UnlikeUsersInRuns, GrowAsPredicted) {
  constexpr std::uint64_t kSeed = 77;
  constexpr int kRows = 6, kDecided = 5;
  test::Random random(kSeed);
  int decided = 0;
  for (int row = 0; row < kRows; ++row) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", row " << row);
    LoopSettings settings;
    double predicted = 0.0;
    do {
      settings = draw(random, row);
      predicted = computeWorstRate(settings);
    } while (std::abs(predicted) < 0.02 || std::abs(predicted) > 2.5);
    const auto seen = test::simulateGrowth(settings, 12.0);
    if (!seen || seen->worst().spread > 3e-3 * std::abs(seen->worst().rate)) continue;
    ++decided;
    EXPECT_NEAR(seen->worst().rate, predicted, 1e-2 * std::abs(predicted));
    std::printf("row %d: predicted %.6g, run %.6g 1/s\n", row, predicted, seen->worst().rate);
  }
  EXPECT_GE(decided, kDecided);
}

}  // namespace
}  // namespace tandem
