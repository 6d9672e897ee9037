// A free coupler through the plugin. After each host step PyBullet's body is on the closed form, at
// any step, sub-steps, gravity and initial damping of the body.

#include <tuple>

#include "plugin_rig.h"

namespace tandem::test {
namespace {

// The requirement is 1e-6 m; this is the rounding.
constexpr double kExact = 1e-11;

class Coupler : public ::testing::TestWithParam<std::tuple<double, int, double, bool>> {
 protected:
  PluginHost host;

  void SetUp() override {
    host.engine.time_step = 1.0 / std::get<0>(GetParam());
    host.engine.substeps = std::get<1>(GetParam());
    host.engine.gravity = Vec3(0, 0, std::get<2>(GetParam()));
    host.command(kFarHand);
    host.command("site coordination=2000,10 link_loss=0");
    host.command("link kind=manual");
  }
  int add(double mass) {
    StubBody body = makeStubCube();
    body.mass = mass;
    body.is_multibody = std::get<3>(GetParam());
    body.state.p_W.x() = 0.01;
    return host.engine.add(body);
  }
  double findWorst(int body) {
    double worst = 0.0;
    for (int step = 1; step * host.engine.time_step < 0.5; ++step) {
      host.step();
      const double x = host.engine.bodies.at(body).state.p_W.x();
      worst = std::max(worst, std::abs(x - computeRinging(0.01, step * host.engine.time_step)));
    }
    EXPECT_EQ(host.read()[kStatus], 0.0);
    EXPECT_EQ(host.warnings().find("not exact"), std::string::npos);
    return worst;
  }
};

TEST_P(Coupler, MovesAProxyOnTheClosedForm) {
  EXPECT_EQ(host.command("connect peer=2 link=0 start=0.01,0,0"), 0);
  const int sphere = add(7.0);
  host.command("proxy remote=0 body=" + std::to_string(sphere));
  EXPECT_DOUBLE_EQ(host.engine.bodies.at(sphere).mass, 0.1);  // m_h
  EXPECT_EQ(host.askDoubles("push link=0", makePacket(Vec3::Zero())).status, 0);
  EXPECT_LE(findWorst(sphere), kExact);
}

TEST_P(Coupler, MovesASharedBodyOnTheClosedForm) {
  // Gravity pulls at a shared body, and the remote's copy holds it up. The motion across is
  // unchanged.
  const int cube = add(0.2);
  const std::string shape = std::get<3>(GetParam()) ? "" : " shape=box size=0.02,0.02,0.02";
  EXPECT_EQ(host.command("share body=" + std::to_string(cube) + shape), 0);
  host.command("connect peer=2 link=0 start=-5,0,0");
  EXPECT_EQ(host.askDoubles("push link=0", makePacket(Vec3(-5, 0, 0), {Vec3::Zero()})).status, 0);
  EXPECT_LE(findWorst(cube), kExact);
}

INSTANTIATE_TEST_SUITE_P(Steps, Coupler,
                         ::testing::Combine(::testing::Values(60.0, 240.0),
                                            ::testing::Values(0, 1, 4, 16),
                                            ::testing::Values(0.0, -9.81), ::testing::Bool()));

TEST(CouplerOfChangingStep, StaysOnTheClosedForm) {
  PluginHost host;
  host.command(kFarHand);
  host.command("site coordination=2000,10 link_loss=0");
  host.command("link kind=manual");
  host.command("connect peer=2 link=0 start=0.01,0,0");
  host.command("proxy remote=0 body=" + std::to_string(host.engine.add(makeStubCube())));
  EXPECT_EQ(host.askDoubles("push link=0", makePacket(Vec3::Zero())).status, 0);
  double t = 0.0, worst = 0.0;
  for (int step = 0; t < 0.5; ++step) {
    host.engine.time_step = 0.003 + 0.002 * ((step * 7) % 5);
    t += host.engine.time_step;
    host.step();
    const double x = host.engine.bodies.at(0).state.p_W.x();
    worst = std::max(worst, std::abs(x - computeRinging(0.01, t)));
  }
  // Between announced moments the pose is cubic in the tick: w^4 h^4 / 384 of 10 mm is 1e-8 m.
  EXPECT_LT(worst, 1e-8);
}

}  // namespace
}  // namespace tandem::test
