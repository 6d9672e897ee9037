// A mouse allocates nothing after construction, at the window and in the haptic thread.

#include <gtest/gtest.h>

#include "tandem/falcon/mouse_device.h"

#include "realtime/allocation_count.h"

namespace tandem {
namespace {

TEST(MouseAllocation, NoneInTenThousandTicks) {
  MouseDevice mouse;
  bool is_valid = true;
  const test::AllocationCount count;
  for (int tick = 0; tick < 10'000; ++tick) {
    const double t = tick * 1e-3;
    if (tick % 8 == 0) (void)mouse.moveTo(Vec3(0.01 * (tick % 30), 0.1, 0), t);
    is_valid = mouse.read(t).valid && is_valid;
    mouse.write(Vec3(1, 2, 3));
    (void)mouse.view();
  }
  EXPECT_EQ(count.count(), 0u);
  EXPECT_TRUE(is_valid);
}

}  // namespace
}  // namespace tandem
