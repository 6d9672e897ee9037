// What `tandem plot` reads and how it sorts runs: tables, summaries, scenes, groups and findings.

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "demos/program/plot/findings.h"
#include "demos/program/plot/grouping.h"
#include "demos/program/plot/html.h"
#include "demos/program/plot/projection.h"
#include "demos/program/plot/reference.h"
#include "demos/program/plot/scene.h"
#include "demos/program/plot/signals.h"
#include "demos/program/plot/smil.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos::plot {
namespace {

using nlohmann::json;

// The message of the UsageError that `action` throws; empty when it throws none.
template <class Action>
std::string messageOf(Action action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

std::string tableError(const std::string& text) {
  return messageOf([&] { (void)Table::parse(text, "a.csv"); });
}

double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1.0p-53;  // [0, 1)
}

// A summary with the settings of the paper's Experiment I (or II for user_contact).
json summary(const std::string& scheme, const std::string& kind = "cooperative_manipulation") {
  const bool is_contact = kind == "user_contact";
  json s = json::parse(R"({
    "scenario": {
      "experiment": {"duration": 1, "axis": [1, 0, 0], "guide": true},
      "contact": {"stiffness": 4000, "damping": 1},
      "coordination": {"stiffness": 200, "damping": 30},
      "object": {"mass": 0.2, "damping": 0, "size": 0.04},
      "proxy": {"mass": 0.1, "damping": 0, "radius": 0.01},
      "device": {"mass": 0.1, "damping": 0.5},
      "site1": {"hand_force": [5, 0, 0]}, "site2": {"hand_force": [0, 0, 0]},
      "network": {"delay": 0.05, "rate": 128, "loss": 0},
      "rates": {"haptic": 1000, "host": 240}},
    "coherency": {"mean_abs": 0.006, "max_abs": 0.01},
    "site1": {"coherency": {"received_mean": 0.012}, "contact_transitions": 1,
              "force": {"max": 7.5, "mean": 4.9}, "device_end": 0.13},
    "site2": {"coherency": {"received_mean": 0.001}, "contact_transitions": 3,
              "force": {"max": 4, "mean": 1}, "device_end": 0.12},
    "state_hash": "00ff", "real_time_factor": 300.0, "scalar": "float64"})");
  s["scenario"]["experiment"]["kind"] = kind;
  s["scenario"]["experiment"]["scheme"] = scheme;
  if (is_contact) {
    s["scenario"]["experiment"]["duration"] = 2;
    s["scenario"]["contact"]["stiffness"] = 2000;
    s["scenario"]["coordination"]["damping"] = 10;
    s["scenario"]["site1"]["hand_force"][0] = 3;
    s["scenario"]["network"]["delay"] = 0.1;
  }
  return s;
}

Run runOf(const json& s, const std::string& name = "run") {
  return parseRun(s.dump(), name, name + "/summary.json");
}

Run runWith(const std::string& scheme, const std::string& pointer, const json& value,
            const std::string& kind = "cooperative_manipulation") {
  json s = summary(scheme, kind);
  s[json::json_pointer("/scenario" + pointer)] = value;
  return runOf(s);
}

TEST(Table, FindsColumnsByNameInAnyOrder) {
  const Table table = Table::parse("force_x, t ,contact\r\n1.5,0,1\r\n-2e-3,0.001,0\r\n", "a.csv");
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.column("t"), (std::vector<double>{0.0, 0.001}));
  EXPECT_EQ(table.column("force_x"), (std::vector<double>{1.5, -2e-3}));
  EXPECT_TRUE(table.has("contact"));
  EXPECT_FALSE(table.has("object_x"));
}

TEST(Table, ReadsNanAndLastLineWithoutNewline) {
  const Table table = Table::parse("t,proxy_x\n0,nan\n1,-nan\n2,3", "a.csv");
  EXPECT_TRUE(std::isnan(table.column("proxy_x")[0]));
  EXPECT_TRUE(std::isnan(table.column("proxy_x")[1]));
  EXPECT_EQ(table.column("proxy_x")[2], 3.0);
}

TEST(Table, NamesFileLineAndColumnOfWhatIsBroken) {
  EXPECT_EQ(tableError("t,x\n0,1\n1,one\n"),
            "a.csv: line 3, column \"x\": \"one\" is not a number");
  EXPECT_EQ(tableError("t,x\n0,\n"), "a.csv: line 2, column \"x\": \"\" is not a number");
  EXPECT_EQ(tableError("t,x\n0,1\n1\n"), "a.csv: line 3: 1 values, but the header names 2 columns");
  EXPECT_EQ(tableError("t,x,t\n"), "a.csv: line 1: column \"t\" appears twice");
  EXPECT_EQ(tableError("t,,x\n"), "a.csv: line 1: a column has no name");
  EXPECT_EQ(tableError(""), "a.csv: line 1: a column has no name");
  EXPECT_EQ(tableError("t,x\n"), "a.csv: no rows below the header");
  EXPECT_EQ(messageOf([] { (void)Table::parse("t\n0\n", "a.csv").column("force_x"); }),
            "a.csv: column \"force_x\" is missing");
}

// Seventeen digits are enough to give back every double exactly.
TEST(Table, GivesBackRandomNumbersExactly) {
  const std::uint64_t seed = 20240917;
  SCOPED_TRACE(fmt::format("seed {}", seed));
  std::mt19937_64 random(seed);
  std::vector<double> a;
  std::vector<double> b;
  std::string text = "a,b\n";
  for (int row = 0; row < 500; ++row) {
    a.push_back((uniform(random) - 0.5) * std::pow(10.0, 40.0 * uniform(random) - 20.0));
    b.push_back(uniform(random));
    text += fmt::format("{:.17g},{:.17g}\n", a.back(), b.back());
  }
  const Table table = Table::parse(text, "a.csv");
  EXPECT_EQ(table.column("a"), a);
  EXPECT_EQ(table.column("b"), b);
}

TEST(Table, RefusesAFolderAndAMissingFile) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  EXPECT_NE(messageOf([&] { (void)readTable(folder); }).find("cannot be read"), std::string::npos);
  EXPECT_NE(messageOf([&] { (void)loadRun(folder / "no-such-run"); }).find("summary.json"),
            std::string::npos);
}

TEST(Run, TakesNumbersFromSummary) {
  const plot::Run run = runOf(summary("kinematic_proxy"), "runs/first");
  EXPECT_EQ(run.kind, RunKind::kCooperation);
  EXPECT_EQ(run.title, "first");
  EXPECT_EQ(run.mean_coherency, 0.006);
  EXPECT_EQ(run.site[1].contact_transitions, 3.0);
  EXPECT_EQ(run.setting("/network/delay"), 0.05);
  EXPECT_EQ(run.setting("/experiment/axis/0"), 1.0);
  EXPECT_TRUE(std::isnan(run.setting("/no/such/key")));
}

TEST(Run, NamesFileAndKeyOfWhatIsBroken) {
  const auto errorWithout = [](const char* pointer, const char* key) {
    json s = summary("kinematic_proxy");
    s[json::json_pointer(pointer)].erase(key);
    return messageOf([&] { (void)runOf(s); });
  };
  EXPECT_EQ(errorWithout("/scenario/experiment", "scheme"),
            "run/summary.json: key \"scenario.experiment.scheme\" is missing");
  EXPECT_EQ(errorWithout("/coherency", "mean_abs"),
            "run/summary.json: key \"coherency.mean_abs\" is missing");
  EXPECT_EQ(messageOf([] { (void)runOf(summary("no_proxy")); }),
            "run/summary.json: key \"scenario.experiment.scheme\" is \"no_proxy\"; allowed are "
            "virtual_coupling, kinematic_proxy and remote_dynamic_proxy");
  EXPECT_EQ(messageOf([] { (void)parseRun("{\"scenario\":", "run", "run/summary.json"); }),
            "run/summary.json: not a JSON object");
}

TEST(Grouping, PutsSchemesOfEqualSettingsTogetherInOneOrder) {
  std::vector<plot::Run> runs = {runOf(summary("remote_dynamic_proxy")),
                                 runOf(summary("virtual_coupling")),
                                 runOf(summary("kinematic_proxy"))};
  for (int rotation = 0; rotation < 3; ++rotation) {
    std::rotate(runs.begin(), runs.begin() + 1, runs.end());
    const Grouping grouping = groupRuns(runs);
    ASSERT_EQ(grouping.cooperation.size(), 1u);
    ASSERT_EQ(grouping.cooperation[0].runs.size(), 3u);
    for (std::size_t s = 0; s < 3; ++s)
      EXPECT_EQ(grouping.cooperation[0].runs[s]->scheme,
                (std::array{"virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"}[s]));
    EXPECT_EQ(grouping.cooperation[0].difference, "");
    EXPECT_TRUE(grouping.sweeps.empty());
  }
}

TEST(Grouping, IgnoresTitlesAndHowANumberIsWritten) {
  json titled = summary("kinematic_proxy");
  titled["scenario"]["name"] = "Second try";
  titled["scenario"]["contact"]["stiffness"] = 4000.0;
  const std::vector<plot::Run> runs = {runOf(summary("kinematic_proxy")), runOf(titled)};
  const Grouping grouping = groupRuns(runs);
  ASSERT_EQ(grouping.cooperation.size(), 1u);
  ASSERT_EQ(grouping.cooperation[0].runs.size(), 1u);
  EXPECT_EQ(grouping.cooperation[0].runs[0], &runs[0]);
}

TEST(Grouping, NamesWhatTellsCasesApart) {
  const std::vector<plot::Run> runs = {
      runWith("kinematic_proxy", "/network/delay", 0.1, "user_contact"),
      runWith("kinematic_proxy", "/network/delay", 0.2, "user_contact"),
      runWith("kinematic_proxy", "/contact/stiffness", 4000, "user_contact")};
  const Grouping grouping = groupRuns(runs);
  ASSERT_EQ(grouping.contact.size(), 3u);
  EXPECT_EQ(grouping.contact[1].difference, "contact stiffness 2000 N/m, network delay 0.2 s");
  EXPECT_EQ(grouping.contact[2].difference, "contact stiffness 4000 N/m, network delay 0.1 s");
}

TEST(Grouping, FindsASweepAndShowsThePapersPointInDetail) {
  std::vector<plot::Run> runs;
  for (const double damping : {2.0, 0.0, 0.5})
    for (const char* scheme : {"kinematic_proxy", "remote_dynamic_proxy"})
      runs.push_back(runWith(scheme, "/device/damping", damping));
  runs.push_back(runOf(summary("remote_dynamic_proxy", "user_contact")));

  const Grouping grouping = groupRuns(runs);
  ASSERT_EQ(grouping.sweeps.size(), 1u);
  ASSERT_EQ(grouping.sweeps[0].points.size(), 3u);
  EXPECT_EQ(grouping.sweeps[0].points[0].first().setting("/device/damping"), 0.0);
  EXPECT_EQ(grouping.sweeps[0].points[2].first().setting("/device/damping"), 2.0);
  ASSERT_EQ(grouping.cooperation.size(), 1u);
  EXPECT_EQ(grouping.cooperation[0].first().setting("/device/damping"), 0.5);
  EXPECT_EQ(grouping.contact.size(), 1u);
}

TEST(Grouping, ShowsTheFirstGivenPointWhenNoneIsThePapers) {
  std::vector<plot::Run> runs;
  for (const double damping : {2.0, 0.25, 1.0})
    runs.push_back(runWith("kinematic_proxy", "/device/damping", damping));
  const Grouping grouping = groupRuns(runs);
  ASSERT_EQ(grouping.cooperation.size(), 1u);
  EXPECT_EQ(grouping.cooperation[0].runs[0], &runs[0]);
}

TEST(Reference, AppliesToThePapersSettingsOnly) {
  const ReferenceOutcome* reference = referenceOf(runOf(summary("virtual_coupling")));
  ASSERT_NE(reference, nullptr);
  EXPECT_EQ(reference->mean_coherency, 10.94e-3);
  const plot::Run contact = runOf(summary("remote_dynamic_proxy", "user_contact"));
  ASSERT_NE(referenceOf(contact), nullptr);
  EXPECT_EQ(referenceOf(contact)->device_end, 0.1919);
  EXPECT_EQ(referenceOf(runWith("virtual_coupling", "/device/damping", 1.0)), nullptr);
  EXPECT_EQ(referenceOf(runWith("virtual_coupling", "/network/loss", 0.01)), nullptr);
}

TEST(Findings, OrderComesFromTheNumbers) {
  std::vector<plot::Run> runs;
  for (const auto& [scheme, error] : {std::pair{"virtual_coupling", 0.011},
                                      {"kinematic_proxy", 0.003},
                                      {"remote_dynamic_proxy", 0.006}}) {
    json s = summary(scheme);
    s["coherency"]["mean_abs"] = error;
    s["site2"]["coherency"]["received_mean"] = 0.01 - error;
    runs.push_back(runOf(s));
  }
  const Grouping grouping = groupRuns(runs);
  const SchemeOrder equal_time = orderSchemes(grouping.cooperation[0], coherencyMeasures()[0]);
  EXPECT_TRUE(equal_time.is_the_papers);
  EXPECT_EQ(equal_time.text,
            "virtual coupling (11.0 mm) > remote dynamic proxy (6.00 mm) > kinematic proxy "
            "(3.00 mm)");
  EXPECT_FALSE(orderSchemes(grouping.cooperation[0], coherencyMeasures()[2]).is_the_papers);
}

TEST(Findings, SweepSaysWhereContactIsIntermittent) {
  std::vector<plot::Run> runs;
  for (const auto& [damping, changes] : {std::pair{0.0, 103}, {0.5, 20}, {1.0, 19}}) {
    json s = summary("kinematic_proxy", "user_contact");
    s["scenario"]["device"]["damping"] = damping;
    s["site1"]["contact_transitions"] = changes;
    runs.push_back(runOf(s));
  }
  const Grouping grouping = groupRuns(runs);
  EXPECT_EQ(sweepFindings(grouping.sweeps.at(0)),
            (std::vector<std::string>{"Kinematic proxy: contact is intermittent (20 changes or "
                                      "more) only at b_dev = 0 and 0.5 N s/m."}));
}

TEST(Signals, ContactStretchesCoverTheirLastTick) {
  const Table table = Table::parse("t,contact\n0,0\n1,1\n2,1\n3,0\n4,1\n", "site1.csv");
  EXPECT_EQ(contactStretches(table), "1 3\n4 5\n");
}

TEST(Scene, BodyWithoutARowStaysWhereItWas) {
  const char* const kHeader = "t,site,body,x,y,z,qw,qx,qy,qz\n";
  const std::string text = "0,1,0,1,2,3,1,0,0,0\n0,1,1,0,0,0,1,0,0,0\n0.5,1,1,4,0,0,1,0,0,0\n";
  const SceneMotion motion = readScene(Table::parse(kHeader + text, "scene.csv"), 2);
  ASSERT_EQ(motion.frames(), 2u);
  EXPECT_EQ(motion.poses[0][1].p, Vec3(1, 2, 3));
  EXPECT_EQ(motion.poses[1][1].p, Vec3(4, 0, 0));
  EXPECT_EQ(messageOf([&] { (void)readScene(Table::parse(kHeader + text, "scene.csv"), 1); }),
            "scene.csv: line 3, column \"body\": 1 is not a body of summary.json");
  EXPECT_EQ(messageOf([&] { (void)readScene(Table::parse(kHeader + text, "scene.csv"), 3); }),
            "scene.csv: column \"body\": body 2 of summary.json never appears");
}

// The ball passes from behind the box to before it: it must be drawn first, then last.
TEST(DrawingOrder, FollowsBodiesThatPassEachOther) {
  plot::Run run;
  run.bodies.resize(2);
  run.bodies[0].is_box = true;
  run.bodies[0].half_extents = Vec3::Constant(0.1);  // [m]
  run.bodies[1].radius = 0.05;                       // [m]
  SceneMotion motion;
  motion.times = {0.0, 1.0};
  motion.poses = {{Pose{}, Pose{}}, {Pose{}, Pose{}}};
  motion.poses[1][0].p = Vec3(0, 0.5, 0);
  motion.poses[1][1].p = Vec3(0, -0.5, 0);
  const DrawingOrders drawing = orderForDrawing(run, motion, {0, 1});
  ASSERT_EQ(drawing.orders.size(), 2u);
  EXPECT_EQ(drawing.orders[0], (std::vector<std::size_t>{1, 0}));
  EXPECT_EQ(drawing.orders[1], (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(drawing.begins, (std::vector<std::size_t>{0, 1}));
}

// Straight lines between the key frames must be within the tolerance of every frame.
TEST(KeyFrames, StayWithinToleranceOfARandomWalk) {
  const std::uint64_t seed = 7;
  SCOPED_TRACE(fmt::format("seed {}", seed));
  std::mt19937_64 random(seed);
  std::vector<double> times;
  std::vector<FrameValues> values;
  double x = 0.0;
  for (int frame = 0; frame < 400; ++frame) {
    times.push_back(frame / 30.0);
    x += frame % 100 < 50 ? 0.3 : uniform(random) - 0.5;
    values.push_back({x});
  }
  constexpr double kTolerance = 0.2;  // [px]
  const LoopClock clock(times);
  const std::vector<std::size_t> keys = keyFrames(clock, values, kTolerance);
  ASSERT_EQ(keys.front(), 0u);
  ASSERT_EQ(keys.back(), values.size() - 1);
  EXPECT_LT(keys.size(), values.size());
  for (std::size_t k = 0; k + 1 < keys.size(); ++k)
    for (std::size_t f = keys[k]; f <= keys[k + 1]; ++f) {
      const double share =
          static_cast<double>(f - keys[k]) / static_cast<double>(keys[k + 1] - keys[k]);
      const double line =
          values[keys[k]][0] + share * (values[keys[k + 1]][0] - values[keys[k]][0]);
      EXPECT_NEAR(values[f][0], line, kTolerance + 1e-9);  // rounding of the shares
    }
}

// Test vectors of RFC 4648.
TEST(Html, EncodesBase64AndEscapesMarkup) {
  EXPECT_EQ(encodeBase64(""), "");
  EXPECT_EQ(encodeBase64("f"), "Zg==");
  EXPECT_EQ(encodeBase64("fo"), "Zm8=");
  EXPECT_EQ(encodeBase64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(escapeHtml("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
}

}  // namespace
}  // namespace tandem::demos::plot
