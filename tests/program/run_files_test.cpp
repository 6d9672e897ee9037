// Files written by `tandem run`. summary.json must agree with the tables.

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

using Json = nlohmann::json;

constexpr double kTick = 1e-3;  // haptic period of the scenarios [s]

/// A finished run: both tables and the summary.
struct FinishedRun {
  TempFolder folder;
  Outcome outcome;
  Json summary;
  Columns site[2];

  FinishedRun(std::string_view scenario, std::vector<std::string> overrides,
              const std::string& program = tandemProgram()) {
    std::vector<std::string> arguments = {"run", scenarioPath(scenario), "--json", "--out",
                                          folder / "out"};
    for (const std::string& text : overrides) arguments.insert(arguments.end(), {"--set", text});
    outcome = runProgram(program, arguments);
    if (outcome.status != 0) return;
    summary = Json::parse(readFile(folder / "out/summary.json"));
    for (int s = 0; s < 2; ++s)
      site[s] = readColumns(folder / ("out/site" + std::to_string(s + 1) + ".csv"));
  }
};

double distance(const Columns& a, const std::string& name_a, const Columns& b,
                const std::string& name_b, std::size_t row_a, std::size_t row_b) {
  double square = 0.0;
  for (const char* axis : {"_x", "_y", "_z"})
    square += std::pow(a.at(name_a + axis)[row_a] - b.at(name_b + axis)[row_b], 2);
  return std::sqrt(square);
}

double norm(const Columns& table, const std::string& name, std::size_t row) {
  return std::hypot(table.at(name + "_x")[row], table.at(name + "_y")[row],
                    table.at(name + "_z")[row]);
}

// Sums in another order differ by rounding only.
constexpr double kRounding = 1e-12;

TEST(RunFiles, HaveEveryColumnAndOneRowPerTick) {
  const FinishedRun run("experiment1.toml", {"experiment.duration=0.3"});
  ASSERT_EQ(run.outcome.status, 0) << run.outcome.err;
  std::vector<std::string> names = {"t", "device_vx", "device_vy", "device_vz", "contact"};
  for (const char* vector : {"device", "force", "object", "proxy", "body_object", "body_proxy"}) {
    for (const char* axis : {"_x", "_y", "_z"}) names.push_back(vector + std::string(axis));
  }
  for (const Columns& site : run.site) {
    for (const std::string& name : names) {
      ASSERT_TRUE(site.contains(name)) << name;
      EXPECT_EQ(site.at(name).size(), 300u) << name;
    }
    for (std::size_t i = 0; i < 300; ++i)
      EXPECT_DOUBLE_EQ(site.at("t")[i], static_cast<double>(i) * kTick);
    // Values are displacements from the start, which is at rest and just in contact.
    for (const char* vector : {"device", "force", "object", "proxy", "body_object", "body_proxy"})
      EXPECT_EQ(norm(site, vector, 0), 0.0) << vector;
    EXPECT_EQ(site.at("contact")[0], 0.0);
  }
  EXPECT_EQ(listFolder(run.folder / "out"),
            (std::vector<std::string>{"scene.csv", "site1.csv", "site2.csv", "summary.json"}));
}

TEST(RunFiles, SummaryHasEveryName) {
  const FinishedRun run("experiment2.toml", {"experiment.duration=0.3"});
  ASSERT_EQ(run.outcome.status, 0) << run.outcome.err;
  const Json& s = run.summary;
  for (const char* name : {"/coherency/mean_abs", "/coherency/max_abs", "/real_time_factor"})
    EXPECT_TRUE(s.at(Json::json_pointer(name)).is_number()) << name;
  for (const std::string site : {"/site1", "/site2"}) {
    for (const char* name :
         {"/coherency/received_mean", "/force/max", "/force/mean", "/device_end"})
      EXPECT_TRUE(s.at(Json::json_pointer(site + name)).is_number()) << site << name;
    EXPECT_TRUE(s.at(Json::json_pointer(site + "/contact_transitions")).is_number_integer());
  }
  const std::string hash = s.at("state_hash");
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos) << hash;
}

/// A scenario, overrides, and the program that runs them.
struct Case {
  const char* name;
  const char* scenario;
  std::vector<std::string> overrides;
  std::string program = tandemProgram();
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

class RunTables : public ::testing::TestWithParam<Case> {
 protected:
  FinishedRun run_{GetParam().scenario, GetParam().overrides, GetParam().program};
  void SetUp() override { ASSERT_EQ(run_.outcome.status, 0) << run_.outcome.err; }
};

TEST_P(RunTables, GiveTheSummarysCoherency) {
  double sum = 0.0, largest = 0.0;
  const std::size_t ticks = run_.site[0].at("t").size();
  for (std::size_t i = 0; i < ticks; ++i) {
    const double error = distance(run_.site[0], "object", run_.site[1], "object", i, i);
    sum += error;
    largest = std::max(largest, error);
  }
  EXPECT_NEAR(run_.summary["coherency"]["mean_abs"].get<double>(), sum / static_cast<double>(ticks),
              kRounding);
  EXPECT_NEAR(run_.summary["coherency"]["max_abs"].get<double>(), largest, kRounding);
}

TEST_P(RunTables, GiveTheSummarysForcesAndContactChanges) {
  for (int s = 0; s < 2; ++s) {
    const Columns& site = run_.site[s];
    const Json& summary = run_.summary[s == 0 ? "site1" : "site2"];
    double sum = 0.0, largest = 0.0, contact_before = 0.0;
    int changes = 0;
    const std::size_t ticks = site.at("t").size();
    for (std::size_t i = 0; i < ticks; ++i) {
      const double force = norm(site, "force", i), contact = site.at("contact")[i];
      sum += force;
      largest = std::max(largest, force);
      EXPECT_EQ(contact == 1.0, force > 0.0) << "row " << i;
      changes += contact != contact_before;
      contact_before = contact;
    }
    EXPECT_NEAR(summary["force"]["mean"].get<double>(), sum / static_cast<double>(ticks),
                kRounding);
    EXPECT_NEAR(summary["force"]["max"].get<double>(), largest, kRounding);
    EXPECT_EQ(summary["contact_transitions"].get<int>(), changes);
  }
}

// The device moves once more after the last row: one tick of a damped mass under the last force.
TEST_P(RunTables, GiveTheSummarysDeviceEnd) {
  const double mass = run_.summary["scenario"]["device"]["mass"];
  const double damping = run_.summary["scenario"]["device"]["damping"];
  for (int s = 0; s < 2; ++s) {
    const Columns& site = run_.site[s];
    const Json& hand = run_.summary["scenario"][s == 0 ? "site1" : "site2"]["hand_force"];
    const double force = hand[0].get<double>() + site.at("force_x").back();
    const double v_end = force / damping;  // [m/s], where damping balances the force
    const double grown = (1.0 - std::exp(-damping * kTick / mass)) * mass / damping;
    const double end =
        site.at("device_x").back() + v_end * kTick + (site.at("device_vx").back() - v_end) * grown;
    EXPECT_NEAR(run_.summary[s == 0 ? "site1" : "site2"]["device_end"].get<double>(), end, 1e-12);
  }
}

// The btRigidBody's state after the latest host step is at most one host step old.
TEST_P(RunTables, BodiesAreBulletsAndFollowTheIsland) {
  const bool is_float = run_.summary["scalar"] == "float";
  const double rate = run_.summary["scenario"]["rates"]["host"];
  const double rounding = is_float ? 1e-7 : 1e-14;  // rounding of positions below 1 m
  bool any_body = false;
  for (const Columns& site : run_.site) {
    for (const std::string name : {"object", "proxy"}) {
      double fastest = 0.0, farthest = 0.0, body_farthest = 0.0;
      const std::size_t ticks = site.at("t").size();
      for (std::size_t i = 1; i < ticks; ++i) {
        fastest = std::max(fastest, distance(site, name, site, name, i, i - 1) / kTick);
        farthest = std::max(farthest, norm(site, name, i));
        body_farthest = std::max(body_farthest, norm(site, "body_" + name, i));
      }
      for (std::size_t i = 0; i < ticks; ++i) {
        ASSERT_LE(distance(site, name, site, "body_" + name, i, i), fastest / rate + rounding)
            << name << ", row " << i;
      }
      EXPECT_GE(body_farthest, farthest - fastest / rate - rounding) << name;
      any_body |= body_farthest > 0.01;
    }
  }
  EXPECT_TRUE(any_body);
}

const std::vector<Case> kCases = {
    {"CooperationByRdp", "experiment1.toml", {}},
    {"CooperationByVirtualCoupling", "experiment1.toml", {"experiment.scheme=virtual_coupling"}},
    {"CooperationByKinematicProxy", "experiment1.toml", {"experiment.scheme=kinematic_proxy"}},
    {"CooperationByImpulse", "experiment1.toml", {"bridge.injection=impulse", "rates.host=1000"}},
    {"UsersByRdp", "experiment2.toml", {}},
    {"UsersByKinematicProxy", "experiment2.toml", {"experiment.scheme=kinematic_proxy"}},
#ifdef TANDEM_WITH_FLOAT
    {"CooperationOnFloat", "experiment1.toml", {}, tandemFloatProgram()},
    {"UsersOnFloat", "experiment2.toml", {}, tandemFloatProgram()},
#endif
};
INSTANTIATE_TEST_SUITE_P(Contract, RunTables, ::testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

// One packet is sent per tick and arrives in the middle of a tick, 50.5 ticks later. The received
// copy before tick k is then the other's copy at tick k - 51.
TEST(RunFiles, ReceivedCoherencyIsAgainstTheOthersDelayedCopy) {
  const FinishedRun run("experiment1.toml", {"network.rate=1000", "network.delay=0.0505"});
  ASSERT_EQ(run.outcome.status, 0) << run.outcome.err;
  for (int s = 0; s < 2; ++s) {
    const Columns &own = run.site[s], &other = run.site[1 - s];
    double sum = 0.0;
    const std::size_t ticks = own.at("t").size();
    for (std::size_t i = 0; i < ticks; ++i)
      sum += distance(own, "object", other, "object", i, i >= 51 ? i - 51 : 0);
    EXPECT_NEAR(run.summary[s == 0 ? "site1" : "site2"]["coherency"]["received_mean"].get<double>(),
                sum / static_cast<double>(ticks), kRounding);
  }
}

// If a scheme or an experiment lacks a body, its columns exist and are zero.
TEST(RunFiles, BodiesThatAreNotThereHaveZeros) {
  const FinishedRun users("experiment2.toml", {"experiment.duration=0.3"});
  const FinishedRun coupling("experiment1.toml",
                             {"experiment.duration=0.3", "experiment.scheme=virtual_coupling"});
  ASSERT_EQ(users.outcome.status + coupling.outcome.status, 0);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ(norm(users.site[0], "object", i) + norm(users.site[0], "body_object", i), 0.0);
    EXPECT_EQ(norm(coupling.site[1], "proxy", i) + norm(coupling.site[1], "body_proxy", i), 0.0);
  }
  EXPECT_EQ(users.summary["coherency"]["max_abs"], 0.0);
}

}  // namespace
}  // namespace tandem::test
