// `tandem peer --publish` as processes on loopback, read by the small program that laboratories
// begin with.

#include <array>
#include <cmath>
#include <csignal>
#include <future>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dds/loopback_domain.h"
#include "program/background.h"
#include "program/process.h"
#include "program/relay_rig.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using test::Columns;
using test::expectLine;
using test::Outcome;
using test::runTandem;
using test::TempFolder;
using Words = std::vector<std::string>;

/// A row of the reader: what, site, tick, time, position, and more.
struct Row {
  std::string what;
  std::vector<double> values;

  [[nodiscard]] bool isOf(const char* one, int site) const {
    return what == one && values.at(0) == site;
  }
  [[nodiscard]] std::size_t tick() const { return static_cast<std::size_t>(values.at(1)); }
};

std::vector<Row> readRows(const std::string& text) {
  std::vector<Row> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    Row row;
    std::getline(cells, row.what, ',');
    for (std::string cell; std::getline(cells, cell, ',');) row.values.push_back(std::stod(cell));
    rows.push_back(row);
  }
  return rows;
}

/// Two sites that publish and record, and a reader beside them.
struct Laboratory {
  Laboratory() { EXPECT_EQ(runTandem({"key", "new", folder / "k"}).status, 0); }

  [[nodiscard]] Outcome runSite(int number) const {
    return runTandem({"peer", "--scenario", test::scenarioPath("experiment1.toml"), "--site",
                      std::to_string(number), "--key", folder / "k", "--carrier", bus, "--publish",
                      bus, "--out", folder / "out"});
  }
  [[nodiscard]] Columns recordOf(int number) const {
    return test::readColumns(folder / ("out/site" + std::to_string(number) + ".csv"));
  }

  TempFolder folder;
  const std::string domain = std::to_string(test::openLoopbackDomain());
  const std::string bus = "dds:" + domain;
};

TEST(DdsPublish, AReaderSeesWhatTheSitesRecord) {
  const Laboratory lab;
  test::Background reader(test::statesReader(), {lab.domain});
  auto other = std::async(std::launch::async, [&] { return lab.runSite(2); });
  const Outcome first = lab.runSite(1), second = other.get();
  ASSERT_EQ(first.status, 0) << first.err;
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_NE(first.err.find("--publish shows hand, force and objects of this site, in clear, to "
                           "everybody on DDS domain " +
                           lab.domain),
            std::string::npos)
      << first.err;
  const std::vector<Row> rows = readRows(reader.finish(SIGTERM).out);
  for (const int site : {1, 2}) {
    const Columns record = lab.recordOf(site);
    const std::vector<double>& t = record.at("t");
    // A tick that comes late first makes up for those that were skipped.
    const auto goesOn = [&](std::size_t tick) {
      return tick > 0 && tick < t.size() && t[tick] - t[tick - 1] < 1.5e-3;
    };
    std::size_t hands = 0, objects = 0;
    for (const Row& row : rows) {
      // Forces belong to the start of the latest tick, places to its end: the next one's start.
      if (row.isOf("hand", site) && row.tick() - 1 < t.size()) {
        EXPECT_EQ(row.values.at(6), record.at("force_x")[row.tick() - 1]);
        ++hands;
      }
      if (row.isOf("object 0", site) && goesOn(row.tick())) {
        EXPECT_NEAR(row.values.at(3), record.at("object_x")[row.tick()], 1e-12);
        EXPECT_EQ(row.values.at(6), record.at("object_qw")[row.tick()]);
        ++objects;
      }
    }
    EXPECT_GT(hands, 0u);
    EXPECT_GT(objects, 0u);
  }
}

// It hands on what it sees, without a force and a number of ticks, which nobody told it.
TEST(DdsPublish, AReaderSeesWhatASpectatorSees) {
  test::RelayRig rig;
  const std::string domain = std::to_string(test::openLoopbackDomain());
  const std::string key = rig.folder / "relay", watch = rig.folder / "watch";
  ASSERT_EQ(runTandem({"key", "new", watch}).status, 0);
  test::Background reader(test::statesReader(), {domain});
  auto spectator = std::async(std::launch::async, [&] {
    return runTandem({"peer", "--watch", "--relay", rig.address, "--relay-key", key, "--watch-key",
                      watch, "--wait", "4", "--out", rig.folder / "seen", "--publish",
                      "dds:" + domain});
  });
  auto second = std::async(std::launch::async, [&] {
    return runTandem(rig.site(2, {"--relay-key", key, "--watch-key", watch}));
  });
  EXPECT_EQ(runTandem(rig.site(1, {"--relay-key", key, "--watch-key", watch})).status, 0);
  EXPECT_EQ(second.get().status, 0);
  const Outcome outcome = spectator.get();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("--publish shows what this spectator sees"), std::string::npos);
  const Columns seen = test::readColumns(rig.folder / "seen/watch.csv");
  const auto wasSeen = [&](const Row& row) {
    for (std::size_t i = 0; i < seen.at("site").size(); ++i)
      if (seen.at("site")[i] == row.values.at(0) &&
          std::abs(seen.at("site_time")[i] - row.values.at(2)) < 1e-6 &&
          std::abs(seen.at("x")[i] - row.values.at(3)) < 1e-6)
        return true;
    return false;
  };
  std::array<int, 3> rows_of{};
  for (const Row& row : readRows(reader.finish(SIGTERM).out)) {
    EXPECT_TRUE(wasSeen(row)) << row.what;
    EXPECT_EQ(row.tick(), 0u);
    EXPECT_TRUE(row.what != "hand" || std::isnan(row.values.at(6)));
    ++rows_of.at(static_cast<std::size_t>(row.values.at(0)));
  }
  EXPECT_GT(rows_of[1], 0);
  EXPECT_GT(rows_of[2], 0);
}

TEST(DdsPublish, BadInputIsALine) {
  const TempFolder folder;
  EXPECT_EQ(runTandem({"key", "new", folder / "k"}).status, 0);
  const auto with = [&](const std::string& word) {
    return runTandem({"peer", "--scenario", test::scenarioPath("experiment1.toml"), "--site", "1",
                      "--key", folder / "k", "--carrier", "dds", "--publish", word});
  };
  for (const std::string word : {"udp", "dds:", "dds:233", "dds:1.5"})
    expectLine(with(word), 2, "--publish " + word + ": must be dds or dds:DOMAIN");
}

}  // namespace
}  // namespace tandem
