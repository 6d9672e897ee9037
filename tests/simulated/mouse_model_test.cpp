// The mouse's model in numbers: lag and ripple of a stroke, and the force against walls.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tandem/falcon/mouse_device.h"

#include "simulated/mouse_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr double kTurn = 2.0 * 3.14159265358979323846;  // one stroke a second [rad/s]

/// Events of a pointer that strokes 100 mm to and fro once a second, as a window sees them: each
/// arrives up to `jitter` early or late and is taken at the next poll.
struct Stroke {
  double rate;    // [Hz]
  double jitter;  // [s]
  double lag;     // expected [s]
  double ripple;  // expected rms of the hand's force beside its fundamental [N]
};

/// Handle and hand over five strokes at 1 kHz.
struct Course {
  Eigen::MatrixX3d turns;  // sine, cosine and 1 at each tick
  Eigen::VectorXd x;       // handle [m]
  Eigen::VectorXd f;       // mean force of the hand in the tick [N]
};

double strokeAt(double t) { return 0.05 * std::sin(kTurn * t); }

Course recordStroke(const Stroke& stroke) {
  constexpr int kWarmUp = 2000, kTicks = 5000;
  const MouseSettings settings;
  MouseDevice mouse(settings);
  test::Random random(30);
  Course course{Eigen::MatrixX3d(kTicks, 3), Eigen::VectorXd(kTicks), Eigen::VectorXd(kTicks)};
  PointState last;
  int events = 0;
  double next = 0.0;
  for (int tick = 0; tick < kWarmUp + kTicks; ++tick) {
    const double t = tick * 1e-3;
    for (; next <= t; ++events) {
      const double seen_at = stroke.jitter > 0.0 ? next : t;
      EXPECT_TRUE(mouse.moveTo(Vec3(strokeAt(seen_at), 0, 0), seen_at));
      const double due = (events + 1) / stroke.rate;
      next = std::max(next, due + stroke.jitter * random.uniform(-1.0, 1.0));
    }
    const PointState hip = mouse.read(t).hip;
    if (const int row = tick - kWarmUp; row >= 0) {
      course.turns.row(row) << std::sin(kTurn * t), std::cos(kTurn * t), 1.0;
      course.x[row] = hip.p_W.x();
      // Newton, over the tick: f_hand = m x'' + b x'.
      course.f[row] = settings.mass * (hip.v_W - last.v_W).x() / 1e-3 +
                      settings.handle_damping * (hip.p_W - last.p_W).x() / 1e-3;
    }
    last = hip;
  }
  return course;
}

Eigen::Vector3d fitTurns(const Course& course, const Eigen::VectorXd& values) {
  return course.turns.colPivHouseholderQr().solve(values);
}

class MouseStroke : public ::testing::TestWithParam<Stroke> {};

TEST_P(MouseStroke, LagsAndRipplesAsMeasured) {
  const Course course = recordStroke(GetParam());
  const Eigen::Vector3d x = fitTurns(course, course.x);
  const double lag = std::atan2(-x[1], x[0]) / kTurn;
  const Eigen::VectorXd rest = course.f - course.turns * fitTurns(course, course.f);
  const double ripple = std::sqrt(rest.squaredNorm() / static_cast<double>(rest.size()));
  RecordProperty("lag_ms", std::to_string(1e3 * lag));
  RecordProperty("ripple_N", std::to_string(ripple));

  EXPECT_NEAR(lag, GetParam().lag, 0.1 * GetParam().lag);
  EXPECT_NEAR(ripple, GetParam().ripple, 0.1 * GetParam().ripple + 1e-3);
  EXPECT_NEAR(std::hypot(x[0], x[1]), 0.05, 0.01 * 0.05) << "the stroke keeps its size";
}
INSTANTIATE_TEST_SUITE_P(Events, MouseStroke,
                         ::testing::Values(Stroke{30, 0.0, 0.048, 0.11},
                                           Stroke{60, 0.0, 0.027, 0.09},
                                           Stroke{125, 0.0, 0.023, 0.025},
                                           Stroke{1000, 0.0, 0.022, 0.0},
                                           Stroke{1000, 0.3e-3, 0.022, 0.035}));

/// Least and greatest force in the fourth second of a press 60 mm into a wall.
struct Press {
  double least = 1e9, greatest = 0.0;  // [N]
  double sunk = 0.0;                   // [m]
  bool is_always_slack = true;
};

Press pressInto(const test::MouseWall& wall) {
  MouseSettings settings;
  settings.start_W = Vec3(-0.02, 0, 0);
  MouseDevice mouse(settings);
  Press press;
  for (int tick = 0; tick <= 4000; ++tick) {
    const double t = tick * 1e-3;
    const double wanted = std::min(-0.02 + 0.25 * t, 0.06);  // at 250 mm/s
    if (tick % 16 == 0) mouse.moveTo(Vec3(wanted, 0, 0), t);
    const PointState hip = mouse.read(t).hip;
    mouse.write(wall.push(hip));
    if (tick <= 3000) continue;
    const MouseView view = mouse.view();
    press.least = std::min(press.least, view.force_W.norm());
    press.greatest = std::max(press.greatest, view.force_W.norm());
    press.sunk = hip.p_W.x();
    press.is_always_slack = press.is_always_slack && view.is_slack;
  }
  return press;
}

TEST(MouseDevice, PressesAWallSteadilyWithTheForceOfTheHand) {
  const test::MouseWall steady[] = {{1000, 0}, {1000, 1}, {1000, 5}, {2000, 0}, {2000, 1},
                                    {2000, 5}, {4000, 1}, {4000, 5}, {8000, 5}};
  for (const test::MouseWall& wall : steady) {
    SCOPED_TRACE(std::to_string(wall.stiffness) + ", " + std::to_string(wall.damping));
    const Press press = pressInto(wall);
    EXPECT_NEAR(press.least, 8.0, 0.001);
    EXPECT_NEAR(press.greatest, 8.0, 0.001);
    EXPECT_NEAR(press.sunk, 8.0 / wall.stiffness, 1e-3 / wall.stiffness);
    EXPECT_TRUE(press.is_always_slack) << "the band is 52 mm and more long, the limit is 27 mm";
  }
}

// A force that is held for a period h acts h/2 late, as a damping of -K h/2. The hand at its limit
// damps nothing, so the sum b + B_vc - K h/2 decides. It is 0, -2 and -1 N s/m here.
TEST(MouseDevice, SwingsAtWallsThatOvercomeTheHandlesDamping) {
  const Press edge = pressInto({4000, 0});
  EXPECT_NEAR(edge.least, 7.7, 0.1 * 7.7);
  EXPECT_NEAR(edge.greatest, 8.3, 0.1 * 8.3);
  EXPECT_GT(edge.greatest - edge.least, 0.1);
  for (const test::MouseWall& wall : {test::MouseWall{8000, 0}, test::MouseWall{8000, 1}}) {
    const Press press = pressInto(wall);
    EXPECT_LT(press.least, 4.0) << wall.damping;
    EXPECT_EQ(press.greatest, 10.0) << wall.damping << ": max_force";
  }
}

TEST(MouseDevice, AtRestTheStretchShowsTheForce) {
  const MouseSettings settings;
  MouseDevice mouse(settings);
  const Vec3 f_W(0, -3, 0);
  for (int tick = 0; tick <= 2000; ++tick) {
    (void)mouse.read(tick * 1e-3);
    mouse.write(f_W);
  }
  const MouseView view = mouse.view();
  // The simulated device takes the spring's force at h^2/8 f/m beside the handle, h = 0.25 ms.
  const double part = settings.stiffness * 0.25e-3 * 0.25e-3 / (8.0 * settings.mass);
  EXPECT_LT((settings.stiffness * (view.cursor_W - view.handle_W) + f_W).norm(), 3.0 * 1.01 * part);
  EXPECT_FALSE(view.is_slack);
}

}  // namespace
}  // namespace tandem
