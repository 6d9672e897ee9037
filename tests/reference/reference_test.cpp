#include <cmath>
#include <cstddef>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/reference/paper_reference.h"
#include "bench/reference/sampling.h"

namespace tandem::reference {
namespace {

// The tables use the device's own position as HIP and have three or four digits. Another integrator
// must agree to 0.2 %. Extrapolating the HIP over a millisecond is a slightly different system, and
// changes smooth values by less than 1 %.
constexpr double kTableTolerance = 0.002;
constexpr double kExtrapolatedTolerance = 0.01;

struct HipCase {
  HipMotion motion;
  double tolerance;
  std::string name;
};

std::ostream& operator<<(std::ostream& out, const HipCase& hip) { return out << hip.name; }

class PaperTables : public ::testing::TestWithParam<HipCase> {
 protected:
  [[nodiscard]] static PaperSummary run(PaperParameters parameters) {
    parameters.hip_motion = GetParam().motion;
    return runPaperModel(parameters).summary;
  }
  static void expectClose(double actual, double expected) {
    EXPECT_NEAR(actual, expected, GetParam().tolerance * expected);
  }
};

INSTANTIATE_TEST_SUITE_P(
    Hip, PaperTables,
    ::testing::Values(HipCase{HipMotion::kContinuous, kTableTolerance, "Continuous"},
                      HipCase{HipMotion::kExtrapolated, kExtrapolatedTolerance, "Extrapolated"}),
    [](const auto& hip) { return hip.param.name; });

TEST_P(PaperTables, CooperativeManipulation) {
  struct Row {
    Scheme scheme;
    double mean, max;               // [m]
    double received_1, received_2;  // [m]
    double force;                   // [N]
  };
  const std::vector<Row> rows{
      {Scheme::kVirtualCoupling, 10.94e-3, 13.40e-3, 20.7e-3, 0.59e-3, 4.876},
      {Scheme::kKinematicProxy, 3.16e-3, 12.83e-3, 7.3e-3, 1.30e-3, 4.955},
      {Scheme::kRemoteDynamicProxy, 6.31e-3, 10.07e-3, 12.7e-3, 0.40e-3, 4.921}};
  for (const Row& row : rows) {
    SCOPED_TRACE(static_cast<int>(row.scheme));
    const PaperSummary summary = run(makeCooperativeManipulation(row.scheme));
    expectClose(summary.coherency_mean, row.mean);
    expectClose(summary.coherency_max, row.max);
    expectClose(summary.force_mean[0], row.force);
    // These values have fewer digits: half of the last digit is added.
    const double relative = GetParam().tolerance;
    EXPECT_NEAR(summary.received_mean[0], row.received_1, 0.05e-3 + relative * row.received_1);
    EXPECT_NEAR(summary.received_mean[1], row.received_2, 0.005e-3 + relative * row.received_2);
  }
}

TEST_P(PaperTables, UserContactIsKeptByRemoteDynamicProxies) {
  struct Row {
    double stiffness, delay;  // [N/m], [s]
    double force, end;        // [N], [m]
  };
  for (const Row& row : {Row{2000.0, 0.1, 3.52, 0.1919}, Row{2000.0, 0.2, 3.52, 0.1150},
                         Row{4000.0, 0.1, 3.60, 0.1790}}) {
    SCOPED_TRACE(row.end);
    PaperParameters parameters = makeUserContact(Scheme::kRemoteDynamicProxy);
    parameters.contact.stiffness = row.stiffness;
    parameters.sampling.delay = row.delay;
    const PaperSummary summary = run(parameters);
    EXPECT_EQ(summary.contact_transitions[0], 1);
    expectClose(summary.force_max[0], row.force);
    expectClose(summary.device_end[0], row.end);
  }
}

// Bouncing is chaotic, so count and force have wide tolerances. 30 % separates the soft cases
// (about 24 changes, 8 N) from the stiff one (88, 14 N). It also separates them from lasting
// contact (1).
TEST_P(PaperTables, UserContactIsIntermittentWithKinematicProxies) {
  struct Row {
    double stiffness, delay;  // [N/m], [s]
    int transitions;
    double force;  // [N]
  };
  for (const Row& row :
       {Row{2000.0, 0.1, 25, 8.7}, Row{2000.0, 0.2, 23, 7.8}, Row{4000.0, 0.1, 88, 14.2}}) {
    SCOPED_TRACE(row.transitions);
    PaperParameters parameters = makeUserContact(Scheme::kKinematicProxy);
    parameters.contact.stiffness = row.stiffness;
    parameters.sampling.delay = row.delay;
    const PaperSummary summary = run(parameters);
    EXPECT_NEAR(summary.contact_transitions[0], row.transitions, 0.3 * row.transitions);
    EXPECT_NEAR(summary.force_max[0], row.force, 0.3 * row.force);
  }
}

// A contact made inside a step misses its damper's impulse for up to a step. At 0.3 m/s and 4 us
// that is B v h / m = 1.2e-5 m/s on a body. The coordination coupling brakes it within m / B_t =
// 1/300 s, so each make costs at most 4e-8 m. There are about a dozen.
TEST(PaperModel, ConvergesWithTheStep) {
  PaperParameters coarse = makeCooperativeManipulation(Scheme::kRemoteDynamicProxy);
  PaperParameters fine = coarse;
  coarse.step = 4e-6;
  fine.step = 1e-6;
  const PaperResult a = runPaperModel(coarse);
  const PaperResult b = runPaperModel(fine);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t k = 0; k < a.rows.size(); ++k) {
    ASSERT_NEAR(a.rows[k].x1, b.rows[k].x1, 1e-6) << "tick " << k;
    ASSERT_NEAR(a.rows[k].xo2, b.rows[k].xo2, 1e-6) << "tick " << k;
    ASSERT_NEAR(a.rows[k].x21, b.rows[k].x21, 1e-6) << "tick " << k;
  }
}

// m v' = F - b v from rest: v = F/b (1 - e^(-b t / m)), x = F/b (t - m/b (1 - e^(-b t / m))).
TEST(PaperModel, DeviceThatLeavesTheCubeMovesAlone) {
  PaperParameters parameters = makeCooperativeManipulation(Scheme::kRemoteDynamicProxy);
  parameters.hand_force_1 = -2.0;  // [N]
  const PaperResult result = runPaperModel(parameters);
  const double b = parameters.device_damping;
  const double rate = b / parameters.proxy_mass;
  const auto position = [&](double t) {
    return parameters.hand_force_1 / b * (t + std::expm1(-rate * t) / rate);
  };
  for (const PaperRow& row : result.rows) {
    ASSERT_NEAR(row.x1, position(row.t), 1e-11);
    ASSERT_NEAR(row.v1, -parameters.hand_force_1 / b * std::expm1(-rate * row.t), 1e-11);
    ASSERT_EQ(row.force_1, 0.0);
  }
  EXPECT_NEAR(result.summary.device_end[0], position(1.0), 1e-11);
  EXPECT_EQ(result.summary.contact_transitions[0], 0);
}

// User 2 pushing towards -x mirrors user 1 pushing towards +x.
TEST(PaperModel, UsersAreInterchangeable) {
  PaperParameters first = makeCooperativeManipulation(Scheme::kRemoteDynamicProxy);
  first.sampling.duration = 0.3;
  PaperParameters second = first;
  second.hand_force_1 = 0.0;
  second.hand_force_2 = -first.hand_force_1;
  const PaperResult a = runPaperModel(first);
  const PaperResult b = runPaperModel(second);
  for (std::size_t k = 0; k < a.rows.size(); ++k) {
    ASSERT_NEAR(a.rows[k].x1, -b.rows[k].x2, 1e-12);
    ASSERT_NEAR(a.rows[k].xo1, -b.rows[k].xo2, 1e-12);
    ASSERT_NEAR(a.rows[k].x21, -b.rows[k].x12, 1e-12);
    ASSERT_NEAR(a.rows[k].force_1, -b.rows[k].force_2, 1e-8);
  }
}

TEST(PaperModel, NothingReachesTheOtherSiteBeforeTheDelay) {
  const PaperParameters parameters = makeCooperativeManipulation(Scheme::kRemoteDynamicProxy);
  const PaperResult result = runPaperModel(parameters);
  // Packet 0 carries the start; the first packet with motion leaves one packet period later.
  const double news = parameters.sampling.delay + 1.0 / parameters.sampling.packet_rate;
  for (const PaperRow& row : result.rows) {
    ASSERT_EQ(row.x12 != 0.0, row.t > news) << "t = " << row.t;
  }
}

TEST(PaperModel, VirtualCouplingLeavesUsersOfExperimentTwoAlone) {
  const PaperSummary summary = runPaperModel(makeUserContact(Scheme::kVirtualCoupling)).summary;
  EXPECT_EQ(summary.contact_transitions[0], 0);
  EXPECT_EQ(summary.device_end[1], 0.0);
}

TEST(PaperModel, RefusesParametersWithoutMeaning) {
  PaperParameters massless;
  massless.proxy_mass = 0.0;
  EXPECT_THROW((void)runPaperModel(massless), std::invalid_argument);
  PaperParameters stepless;
  stepless.step = 0.0;
  EXPECT_THROW((void)runPaperModel(stepless), std::invalid_argument);
}

TEST(SampleClock, MeetsEveryInstantOnceAndInOrder) {
  const Sampling sampling{.haptic_rate = 1000.0, .packet_rate = 128.0, .delay = 0.05};
  SampleClock clock(sampling);
  int ticks = 0;
  int sent = 0;
  int received = 0;
  double last = -1.0;
  Instant now = clock.next();
  for (; !now.ends; now = clock.next()) {
    ASSERT_GT(now.t, last);
    last = now.t;
    if (now.ticks) {
      ASSERT_NEAR(now.t, ticks++ / 1000.0, 1e-12);
    }
    if (now.sends) {
      ASSERT_NEAR(now.t, sent++ / 128.0, 1e-12);
    }
    if (now.receives) {
      ASSERT_NEAR(now.t, received++ / 128.0 + 0.05, 1e-12);
    }
  }
  EXPECT_NEAR(now.t, 1.0, 1e-12);
  EXPECT_EQ(ticks, 1000);
  EXPECT_EQ(sent, 128);
  EXPECT_EQ(received, 122);  // those with n / 128 + 0.05 < 1
}

TEST(SampleClock, PacketThatArrivesAtATickIsSeenByIt) {
  SampleClock clock({.haptic_rate = 1000.0, .packet_rate = 1000.0, .delay = 0.003});
  for (Instant now = clock.next(); !now.ends; now = clock.next()) {
    EXPECT_TRUE(now.ticks && now.sends) << "t = " << now.t;
    EXPECT_EQ(now.receives, now.t > 0.0025);
  }
}

TEST(SampleClock, RefusesSamplingWithoutMeaning) {
  EXPECT_THROW(SampleClock({.haptic_rate = 0.0}), std::invalid_argument);
  EXPECT_THROW(SampleClock({.packet_rate = -1.0}), std::invalid_argument);
  EXPECT_THROW(SampleClock({.delay = -0.01}), std::invalid_argument);
  EXPECT_THROW(SampleClock({.duration = 0.0005}), std::invalid_argument);
  EXPECT_THROW(SampleClock({.duration = std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace tandem::reference
