// Contacts that Tandem solves, as the script reads them.

#include "plugin_rig.h"

namespace tandem::test {
namespace {

// A shared cube of 0.2 kg rests on an obstacle: four points carry m g.
TEST(Contacts, CarryTheWeightOfASharedCube) {
  Pressed pressed;
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  pressed.host.step(120);
  const std::vector<double> answer = pressed.host.ask("contacts").doubles();
  ASSERT_EQ(answer.size(), 1u + 4u * 16u);
  double force = 0.0;
  for (std::size_t at = 1; at < answer.size(); at += 16) {
    const double* const point = &answer[at];
    const bool is_cube_first = point[0] == pressed.cube;
    EXPECT_EQ(point[is_cube_first ? 1 : 0], pressed.floor);
    EXPECT_NEAR(point[10], is_cube_first ? 1.0 : -1.0, 1e-6);  // normal, up
    EXPECT_NEAR(point[11], 0.0, 1e-3);                         // distance
    force += point[12];
  }
  EXPECT_NEAR(force, 0.2 * 9.81, 0.01);
}

}  // namespace
}  // namespace tandem::test
