// Folders of --out: one program at a time writes a part, and results are published whole. A killed
// program leaves an older result, none or a new one, and blocks nobody.

#include "demos/program/files/output_folder.h"

#include <algorithm>
#include <barrier>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "demos/program/terminal/usage_error.h"
#include "program/background.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

using demos::FolderPart;
using demos::OutputFolder;
using Words = std::vector<std::string>;

std::vector<std::string> runInto(const std::string& folder, const std::string& duration) {
  return {"run",    scenarioPath("experiment1.toml"),
          "--set",  "experiment.duration=" + duration,
          "--out",  folder,
          "--quiet"};
}

void awaitFile(const std::filesystem::path& file) {
  for (int i = 0; i < 60'000 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(std::filesystem::exists(file));
}

TEST(OutputFolder, SecondProgramIsRefused) {
  const TempFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(runTandem(runInto(out, "0.05")).status, 0);
  const std::string before = readFile(out + "/summary.json");
  const OutputFolder first(out, "--out x");
  const std::vector<Words> others = {runInto(out, "0.1"),
                                     {"plot", out},
                                     {"bench", "stress", "--quick", "--cases", "1", "--out", out}};
  for (const Words& other : others) {
    const Outcome refused = runTandem(other);
    EXPECT_EQ(refused.status, 2) << other[0];
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_NE(refused.err.find(out + ": another tandem is writing"), std::string::npos)
        << refused.err;
  }
  EXPECT_EQ(readFile(out + "/summary.json"), before);
}

TEST(OutputFolder, SecondRecordingOfADeviceIsRefused) {
  const TempFolder folder;
  const std::string file = folder.write("r.csv", "earlier");
  const demos::OutputLock first(file + ".lock", file);
  const Outcome refused = runTandem({"device", "record", file, "--device", "simulated"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find(file + ": another tandem is writing"), std::string::npos)
      << refused.err;
  EXPECT_EQ(readFile(file), "earlier");
}

// Both sites of a live run end at the same moment.
TEST(OutputFolder, LastTwoUsersAtOnceLeaveNoLock) {
  const TempFolder folder;
  const std::string file = folder / "lock";
  const auto use = [&](FolderPart part, std::barrier<>& together) {
    const demos::OutputLock lock(file, file, part);
    together.arrive_and_wait();
  };
  for (int i = 0; i < 500; ++i) {
    std::barrier together(2);
    std::thread other([&] { use(FolderPart{2}, together); });
    use(FolderPart{1}, together);
    other.join();
    ASSERT_FALSE(std::filesystem::exists(file)) << "after " << i << " pairs";
  }
}

TEST(OutputFolder, KilledProgramLeavesTheEarlierResultAndNoLock) {
  const TempFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(runTandem(runInto(out, "0.05")).status, 0);
  const Words names = listFolder(out);
  const std::string before = readFile(out + "/summary.json"), csv = readFile(out + "/site1.csv");
  Background killed(tandemProgram(), runInto(out, "300"));
  awaitFile(out + "/.tandem-unfinished");
  (void)killed.finish(SIGKILL);
  EXPECT_EQ(readFile(out + "/summary.json"), before);
  EXPECT_EQ(readFile(out + "/site1.csv"), csv);

  EXPECT_EQ(runTandem(runInto(out, "0.05")).status, 0);
  EXPECT_EQ(listFolder(out), names);  // and nothing of the killed one
}

TEST(OutputFolder, BothSitesShareIt) {
  const TempFolder folder;
  const OutputFolder one(folder.path(), "--out x", FolderPart{1});
  {
    const OutputFolder two(folder.path(), "--out x", FolderPart{2});
    for (const FolderPart part : {FolderPart::kAll, FolderPart{1}, FolderPart{2}})
      EXPECT_THROW(OutputFolder(folder.path(), "--out x", part), demos::UsageError);
  }
  // The end of one site leaves the other its part.
  EXPECT_THROW(OutputFolder(folder.path(), "--out x"), demos::UsageError);
  EXPECT_NO_THROW(OutputFolder(folder.path(), "--out x", FolderPart{2}));
}

TEST(OutputFolder, ResultOfOneKindReplacesTheOther) {
  const TempFolder folder;
  const auto publish = [&](FolderPart part, const std::string& mark, const Words& others) {
    const OutputFolder out(folder.path(), "--out x", part);
    demos::writeText(out / mark, mark);
    demos::writeText(out / "site1.csv", mark);
    out.publish(mark, others);
  };
  publish(FolderPart::kAll, "summary.json", {"site1.json", "site2.json"});
  publish(FolderPart{1}, "site1.json", {"summary.json"});
  EXPECT_EQ(listFolder(folder.path()), (Words{"site1.csv", "site1.json"}));
  publish(FolderPart::kAll, "summary.json", {"site1.json", "site2.json"});
  EXPECT_EQ(listFolder(folder.path()), (Words{"site1.csv", "summary.json"}));
  EXPECT_EQ(readFile(folder / "site1.csv"), "summary.json");
}

/// Publishes results of three equal files without end. Only a signal stops it.
[[noreturn]] void publishForever(const std::filesystem::path& folder, const std::string& writer) {
  for (std::uint64_t number = 0;; ++number) {
    try {
      const OutputFolder out(folder, "--out x");
      for (const char* name : {"a", "b", "mark"})
        demos::writeText(out / name, writer + std::to_string(number));
      out.publish("mark");
    } catch (const demos::UsageError&) {  // the other one writes
    }
  }
}

/// Time in which two new programs publish something, on this machine under its load [us].
int measurePublishing() {
  const TempFolder folder;
  const auto start = std::chrono::steady_clock::now();
  pid_t writers[2];
  for (pid_t& writer : writers)
    if ((writer = fork()) == 0) publishForever(folder.path(), "first ");
  while (!std::filesystem::exists(folder / "mark"))
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
  for (const pid_t writer : writers) kill(writer, SIGKILL);
  for (const pid_t writer : writers) (void)waitpid(writer, nullptr, 0);
  return static_cast<int>(time.count());
}

// Two programs publish and are killed at random moments, many times.
TEST(OutputFolder, KilledWritersNeverLeaveAMix) {
  constexpr std::uint64_t kSeed = 15;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random(kSeed);
  const TempFolder folder;
  const int longest = std::max(4000, measurePublishing());
  int whole = 0;
  for (int round = 0; round < 300; ++round) {
    pid_t writers[2];
    for (int i = 0; i < 2; ++i) {
      writers[i] = fork();
      ASSERT_GE(writers[i], 0);
      if (writers[i] == 0) publishForever(folder.path(), std::to_string(2 * round + i) + " ");
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500 + random() % longest));
    for (const pid_t writer : writers) kill(writer, SIGKILL);
    for (const pid_t writer : writers) (void)waitpid(writer, nullptr, 0);
    if (!std::filesystem::exists(folder / "mark")) continue;
    ++whole;
    for (const char* name : {"a", "b"})
      ASSERT_EQ(readFile(folder / name), readFile(folder / "mark")) << "round " << round;
  }
  EXPECT_GT(whole, 100);
  EXPECT_NO_THROW(OutputFolder(folder.path(), "--out x"));  // no lock is left over
  EXPECT_FALSE(std::filesystem::exists(folder / ".tandem-lock"));
}

}  // namespace
}  // namespace tandem::test
