// An unmodified program that links dynamically to Bullet, with and without the library in
// LD_PRELOAD. Runs for both widths.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include <gtest/gtest.h>

#include "preload/preload_run.h"

namespace tandem::test {
namespace {

namespace fs = std::filesystem;

/// The first cube is pushed along the floor.
const char* const kPush = R"(object = "box 0.04 0.04 0.04"
log = "push.csv"
[device]
start = [-0.03, 0, 0.02]
force = [5, 0, 0]
)";

struct Width {
  const char* name;
  const char* host;
  const char* attached_host;
  const char* plugin;
  const char* bytes;
};
const Width kWidths[] = {
#ifdef TANDEM_FLOAT_HOST
    {"float", TANDEM_FLOAT_HOST, TANDEM_FLOAT_ATTACHED_HOST, TANDEM_FLOAT_PLUGIN, "4-byte (float)"},
#endif
    {"float64", TANDEM_FLOAT64_HOST, TANDEM_FLOAT64_ATTACHED_HOST, TANDEM_FLOAT64_PLUGIN,
     "8-byte (double)"},
};
const char* const kWorlds[] = {"plain",    "derived", "second",      "removed", "late",
                               "callback", "in_step", "world_first", "leaked",  "none"};

/// Expects `count` lines, each from Tandem.
void expectLines(const std::string& err, long count) {
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), count) << err;
  for (std::size_t at = 0; at < err.size(); at = err.find('\n', at) + 1)
    EXPECT_EQ(err.compare(at, 16, "tandem preload: "), 0) << err;
}

void expectWords(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << '"' << word << "\" in: " << text;
}

class PreloadedHost : public testing::TestWithParam<Width> {
 protected:
  [[nodiscard]] std::string bare(const std::string& world) const {
    return runBare(GetParam().host, {"--world", world}).out;
  }
  [[nodiscard]] Outcome preloaded(const std::string& world, const std::string& config) const {
    return runPreloaded(GetParam().host, {"--world", world}, config);
  }
  /// Expects a host's run as without Tandem, and one line with the reason.
  void expectUntouched(const Outcome& outcome, const std::string& world,
                       const std::vector<std::string>& words) const {
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, bare(world));
    expectLines(outcome.err, 1);
    expectWords(outcome.err, words);
  }

  TempFolder folder_;
};

TEST_P(PreloadedHost, IsTheSameToTheBitWithoutAConfig) {
  for (const std::string world : kWorlds) {
    SCOPED_TRACE(world);
    const Outcome outcome = preloaded(world, "");
    if (world == "none") {
      EXPECT_EQ(outcome.err, "");
    } else {
      expectUntouched(outcome, world, {"TANDEM_PRELOAD names no config"});
    }
  }
}

TEST_P(PreloadedHost, IsTheSameToTheBitWithAConfigThatIsRefused) {
  const std::string config = folder_.write("bad.toml", "object = 1\nmas = 2\n");
  for (const std::string world : kWorlds) {
    SCOPED_TRACE(world);
    if (world == "none") continue;
    expectUntouched(preloaded(world, config), world,
                    {config, "mas", "no such key", "mass", "runs on without Tandem"});
  }
}

TEST_P(PreloadedHost, IsTheSameToTheBitWhileItsObjectIsNotThere) {
  const std::string config = folder_.write("wait.toml", "object = \"sphere 1\"\n");
  const Outcome outcome = preloaded("plain", config);
  EXPECT_EQ(outcome.out, bare("plain"));
  expectLines(outcome.err, 2);
  expectWords(outcome.err, {"waiting for it", "1 box 0.04 0.04 0.04, 0.2 kg; 2 box"});
}

TEST_P(PreloadedHost, MovesItsObjectAsASiteInTheProgramDoes) {
  const Outcome outcome = preloaded("world_first", folder_.write("push.toml", kPush));
  EXPECT_EQ(outcome.status, 0);
  // The mass is restored when the world ends, after the line was printed.
  EXPECT_EQ(outcome.out, runBare(GetParam().attached_host).out);
  EXPECT_NE(outcome.out, bare("world_first"));
  expectWords(outcome.err, {"shares moving body 1 of world 1: box 0.04 0.04 0.04, 0.2 kg",
                            "world 1 ends after 60 steps"});
}

TEST_P(PreloadedHost, WritesALineForEachStep) {
  (void)preloaded("plain", folder_.write("push.toml", kPush));
  const std::string log = readFile(folder_ / "push.csv");
  EXPECT_EQ(log.substr(0, log.find('\n')), "t,x,y,z,force_x,force_y,force_z,link");
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 61);
  const std::string last = log.substr(log.rfind('\n', log.size() - 2) + 1);
  double t = 0.0, x = 0.0;
  ASSERT_EQ(std::sscanf(last.c_str(), "%lf,%lf", &t, &x), 2);
  EXPECT_NEAR(t, 1.0, 1e-6);
  double printed = 0.0;
  const std::string out = preloaded("plain", folder_ / "push.toml").out;
  ASSERT_EQ(std::sscanf(out.c_str(), "hash %*s cube %lf", &printed), 1);
  EXPECT_NEAR(x, printed, 1e-6);
}

TEST_P(PreloadedHost, PicksByNumberOfWorldAndBody) {
  std::string text = kPush;
  text.replace(0, text.find('\n'), "world = 2\nobject = 1");
  const Outcome second = preloaded("second", folder_.write("second.toml", text));
  expectWords(second.err, {"shares moving body 1 of world 2"});
  EXPECT_NE(second.out, bare("second"));
  const Outcome only = preloaded("plain", folder_ / "second.toml");
  EXPECT_EQ(only.out, bare("plain"));
}

TEST_P(PreloadedHost, LetsGoOfAnObjectThatLeavesAndTakesItAgain) {
  const Outcome outcome = preloaded("removed", folder_.write("push.toml", kPush));
  EXPECT_EQ(outcome.status, 0);
  expectWords(outcome.err,
              {"shares moving body 1", "was taken out of world 1: waiting for it to come back",
               "shares moving body 3", "world 1 ends after"});
  EXPECT_NE(outcome.out.find("mass 0.200000"), std::string::npos);
}

// The host takes all bodies out before it deletes its world.
TEST_P(PreloadedHost, SaysAtItsEndThatItEnds) {
  const Outcome outcome = preloaded("plain", folder_.write("push.toml", kPush));
  EXPECT_EQ(outcome.status, 0);
  expectLines(outcome.err, 3);
  expectWords(outcome.err, {"shares moving body 1", "world 1 ends after 60 steps with the object"});
  EXPECT_EQ(outcome.err.find("taken out"), std::string::npos) << outcome.err;
}

TEST_P(PreloadedHost, AttachesAgainWhenTheProgramTakesTheCallback) {
  const Outcome outcome = preloaded("callback", folder_.write("push.toml", kPush));
  EXPECT_EQ(outcome.status, 0);
  expectWords(outcome.err, {"has set a tick callback of its own", "world 1 ends after 60 steps"});
  double x = 0.0;
  ASSERT_EQ(std::sscanf(outcome.out.c_str(), "hash %*s cube %lf", &x), 1);
  EXPECT_GT(x, 0.02);
}

TEST_P(PreloadedHost, GoesOnWhateverTheHostDoesWithItsWorld) {
  const std::string config = folder_.write("push.toml", kPush);
  for (const std::string world : {"derived", "late", "in_step", "leaked"}) {
    SCOPED_TRACE(world);
    const Outcome outcome = preloaded(world, config);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expectWords(outcome.err, {"shares moving body 1"});
    EXPECT_NE(outcome.out, bare(world));
  }
}

TEST_P(PreloadedHost, RefusesAnotherWidthThanTheConfigAsksFor) {
  const bool is_float = std::string(GetParam().name) == "float";
  const std::string config =
      folder_.write("other.toml", std::string("object = 1\nbullet = \"") +
                                      (is_float ? "float64" : "float") + "\"\n");
  expectUntouched(preloaded("plain", config), "plain",
                  {"width mismatch", "4-byte (float)", "8-byte (double)", config});
}

TEST_P(PreloadedHost, RefusesWithoutTheAdaptorOfItsWidthOrWithTheOther) {
  const std::string config = folder_.write("push.toml", kPush);
  const fs::path built(TANDEM_PRELOAD_LIBRARY);
  const fs::path own = folder_.path() / built.filename();
  fs::copy_file(built, own);
  expectUntouched(
      runPreloaded(GetParam().host, {}, config, own.string()), "plain",
      {GetParam().bytes, "cannot be loaded", std::string("preload-") + GetParam().name + ".so"});

  for (const Width& other : kWidths) {
    if (std::string(other.name) == GetParam().name) continue;
    fs::create_directory(folder_.path() / "tandem");
    const auto nameOf = [](const Width& width) {
      return std::string("preload-") + width.name + ".so";
    };
    fs::copy_file(built.parent_path() / "tandem" / nameOf(other),
                  folder_.path() / "tandem" / nameOf(GetParam()));
    expectUntouched(runPreloaded(GetParam().host, {}, config, own.string()), "plain",
                    {"width mismatch", "4-byte (float)", "8-byte (double)"});
  }
}

TEST_P(PreloadedHost, LeavesOtherProcessesAlone) {
  const std::string config =
      folder_.write("named.toml", std::string("process = \"another\"\n") + kPush);
  const Outcome outcome = preloaded("plain", config);
  EXPECT_EQ(outcome.out, bare("plain"));
  EXPECT_EQ(outcome.err, "");

  const std::string name = fs::path(GetParam().host).filename().string();
  folder_.write("named.toml", "process = \"" + name + "\"\n" + kPush);
  expectWords(preloaded("plain", config).err, {"shares moving body 1"});
}

TEST_P(PreloadedHost, FindsTheBulletOfAPluginThatShowsItToNobody) {
  const std::vector<std::string> arguments{GetParam().plugin, "--", "--world", "world_first"};
  const std::string config = folder_.write("push.toml", kPush);
  EXPECT_EQ(runPreloaded(TANDEM_TWO_WIDTHS_HOST, arguments, "").out, bare("world_first"));
  EXPECT_EQ(runPreloaded(TANDEM_TWO_WIDTHS_HOST, arguments, config).out,
            runBare(GetParam().attached_host).out);
}

INSTANTIATE_TEST_SUITE_P(Widths, PreloadedHost, testing::ValuesIn(kWidths),
                         [](const auto& width) { return std::string(width.param.name); });

TEST(PreloadedProcess, MayHaveBothWidthsInPlugins) {
  if (std::size(kWidths) < 2) GTEST_SKIP() << "built for one width of Bullet";
  for (const bool is_reversed : {false, true}) {
    const Width& first = is_reversed ? *std::rbegin(kWidths) : *std::begin(kWidths);
    const Width& other = is_reversed ? *std::begin(kWidths) : *std::rbegin(kWidths);
    const std::vector<std::string> arguments{first.plugin, other.plugin, "--", "--world",
                                             "derived"};
    const std::string bare = runBare(first.host, {"--world", "derived"}).out +
                             runBare(other.host, {"--world", "derived"}).out;
    EXPECT_EQ(runBare(TANDEM_TWO_WIDTHS_HOST, arguments).out, bare);
    EXPECT_EQ(runPreloaded(TANDEM_TWO_WIDTHS_HOST, arguments, "").out, bare);
  }
}

TEST(PreloadedProcess, IsToldOfAStaticBullet) {
  const TempFolder folder;
  const Outcome outcome = runPreloaded(TANDEM_STATIC_HOST, {}, folder.write("push.toml", kPush));
  EXPECT_EQ(outcome.status, 0);
  expectLines(outcome.err, 1);
  expectWords(outcome.err, {"linked in statically", "preload_static_host"});
  EXPECT_EQ(runPreloaded(TANDEM_STATIC_HOST, {}, "").err, "");
}

TEST(PreloadedProcess, IsToldOfAnotherBulletThanDebians) {
  const TempFolder folder;
  const std::vector<std::string> arguments{TANDEM_OWN_BULLET_PLUGIN, "--"};
  const Outcome outcome =
      runPreloaded(TANDEM_TWO_WIDTHS_HOST, arguments, folder.write("push.toml", kPush));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "3 steps\n");
  expectLines(outcome.err, 1);
  expectWords(outcome.err,
              {"makes its worlds with", TANDEM_OWN_BULLET_PLUGIN, "libBulletDynamics.so.3"});
}

TEST(PreloadedProcess, IsToldThatItMadeNoWorld) {
  const TempFolder folder;
  const Outcome outcome =
      runPreloaded(TANDEM_FLOAT64_HOST, {"--world", "none"}, folder.write("push.toml", kPush));
  EXPECT_EQ(outcome.status, 0);
  expectLines(outcome.err, 1);
  expectWords(outcome.err, {"has made no world with a dynamically linked Bullet"});
}

TEST(PreloadedProcess, OfAShellHasNothingOfBulletInIt) {
  const Outcome outcome = runPreloaded("/bin/sh", {"-c", "cat /proc/self/maps"}, "");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("libtandem-preload.so"), std::string::npos);
  EXPECT_EQ(outcome.out.find("libBullet"), std::string::npos);
  EXPECT_EQ(outcome.out.find("libstdc++"), std::string::npos);
}

}  // namespace
}  // namespace tandem::test
