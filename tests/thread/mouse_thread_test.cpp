// A window's thread moves a mouse and looks at it, while a haptic thread reads and writes.

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/falcon/mouse_device.h"

namespace tandem {
namespace {

// Targets are on the diagonal x = y = z, and so is everything that follows them. A torn target or a
// torn view would leave it.
bool isOnDiagonal(const Vec3& a_W) { return a_W.x() == a_W.y() && a_W.y() == a_W.z(); }

TEST(MouseThreads, NeitherATargetNorAViewIsTorn) {
  constexpr int kEvents = 20'000;
  MouseDevice mouse;
  std::atomic<bool> has_begun = false, is_over = false;
  bool is_valid = true, is_straight = true;
  std::thread haptic([&] {
    for (int tick = 0; !is_over; ++tick) {
      const DeviceSample sample = mouse.read(tick * 1e-3);
      is_valid = is_valid && sample.valid;
      is_straight = is_straight && isOnDiagonal(sample.hip.p_W);
      mouse.write(-10.0 * sample.hip.p_W);
      has_begun = true;
    }
  });
  while (!has_begun) std::this_thread::yield();

  bool is_whole = true, is_taken = true, is_held = true;
  for (int event = 0; event < kEvents; ++event) {
    const double t = event * 1e-3;
    is_taken = mouse.moveTo(Vec3::Constant(0.003 * (event % 64)), t) && is_taken;
    mouse.hold();
    is_held = !mouse.moveTo(Vec3::Zero(), t) && is_held;
    mouse.release();
    const MouseView view = mouse.view();
    is_whole = is_whole && isOnDiagonal(view.handle_W) && isOnDiagonal(view.cursor_W) &&
               isOnDiagonal(view.force_W);
  }
  is_over = true;
  haptic.join();

  EXPECT_TRUE(is_valid);
  EXPECT_TRUE(is_straight);
  EXPECT_TRUE(is_whole);
  EXPECT_TRUE(is_taken);
  EXPECT_TRUE(is_held);
}

TEST(MouseThreads, TheLastTargetArrives) {
  MouseDevice mouse;
  std::thread window([&] {
    for (int i = 1; i <= 1000; ++i) (void)mouse.moveTo(Vec3(1e-4 * i, 0, 0), 1e-3 * i);
  });
  int tick = 0;
  for (; tick < 500; ++tick) (void)mouse.read(tick * 1e-3);
  window.join();
  for (const int end = tick + 2000; tick < end; ++tick) (void)mouse.read(tick * 1e-3);
  EXPECT_NEAR(mouse.view().handle_W.x(), 0.1, 1e-9);
}

}  // namespace
}  // namespace tandem
