// Inputs of `tandem link`: quantities with units, and scripts.

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "demos/program/link/link_script.h"
#include "demos/program/link/units.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos {
namespace {

TEST(Units, ReadTimes) {
  EXPECT_EQ(parseSeconds("50ms"), 0.05);
  EXPECT_EQ(parseSeconds("0.05s"), 0.05);
  EXPECT_EQ(parseSeconds("0.05"), 0.05);
  EXPECT_EQ(parseSeconds("200us"), 0.0002);
  EXPECT_EQ(parseSeconds(".5ms"), 0.0005);
  EXPECT_EQ(parseSeconds("1e-3s"), 0.001);
  EXPECT_EQ(parseSeconds("0"), 0.0);
  EXPECT_EQ(parseSeconds("3600"), 3600.0);
}

TEST(Units, RefuseWhatIsNoTime) {
  for (const char* text :
       {"",    "ms", "s",   ".",   "-1ms", "+1ms",  "1 ms",   " 1ms",  "1ms ", "1m", "1mss",
        "1MS", "1%", "inf", "nan", "infs", "0x10s", "1e999s", "1,5ms", "5ms5", "1e", "--5"})
    EXPECT_FALSE(parseSeconds(text)) << '"' << text << '"';
  EXPECT_FALSE(parseSeconds(std::string_view("1\0ms", 4)));
}

TEST(Units, ReadShares) {
  EXPECT_EQ(parseShare("2%"), 0.02);
  EXPECT_EQ(parseShare("0.02"), 0.02);
  EXPECT_EQ(parseShare("0.1%"), 0.001);
  EXPECT_EQ(parseShare("0%"), 0.0);
  EXPECT_EQ(parseShare("100%"), 1.0);
  EXPECT_EQ(parseShare("1"), 1.0);
}

TEST(Units, RefuseWhatIsNoShare) {
  for (const char* text :
       {"", "%", "-1%", "1 %", "1%%", "2", "1.001", "100.1%", "2ms", "nan", "inf%", "1e999%"})
    EXPECT_FALSE(parseShare(text)) << '"' << text << '"';
}

TEST(Units, DelaysAreBounded) {
  EXPECT_EQ(parseDelay("10s"), 10.0);
  EXPECT_FALSE(parseDelay("50"));  // the unit is missing
  EXPECT_FALSE(parseDelay("10.001s"));
}

TEST(LinkScriptFile, ReadsEveryKey) {
  const auto changes = parseLinkScript(
      "[[change]]\n"
      "at = 1\n"
      "delay = \"100ms\"\njitter = 0.005\nloss = \"2%\"\nduplicate = 0.01\nreorder = \"0.5%\"\n"
      "corrupt = 0\nkeep_order = true\noutage = true\ncut = \"forward\"\nrebind = true\n"
      "[[change]]\n"
      "at = \"1500ms\"\noutage = false\ncut = \"none\"\n"
      "[[change]]\n"
      "at = 1.5\ncut = \"back\"\n",
      "s.toml");
  ASSERT_EQ(changes.size(), 3U);
  const LinkChange& all = changes[0];
  EXPECT_EQ(all.at, 1.0);
  EXPECT_EQ(all.delay, 0.1);
  EXPECT_EQ(all.jitter, 0.005);
  EXPECT_EQ(all.loss, 0.02);
  EXPECT_EQ(all.duplicate, 0.01);
  EXPECT_EQ(all.reorder, 0.005);
  EXPECT_EQ(all.corrupt, 0.0);
  EXPECT_EQ(all.keep_order, true);
  EXPECT_EQ(all.outage, true);
  EXPECT_EQ(all.cut, LinkCut::kForward);
  EXPECT_TRUE(all.rebind);
  EXPECT_EQ(changes[1].at, 1.5);
  EXPECT_EQ(changes[1].outage, false);
  EXPECT_EQ(changes[1].cut, LinkCut::kNone);
  EXPECT_FALSE(changes[1].delay);
  EXPECT_FALSE(changes[1].rebind);
  EXPECT_EQ(changes[2].cut, LinkCut::kBack);
}

TEST(LinkScriptFile, RefusesMalformedOnesInOneLine) {
  const std::string change = "[[change]]\nat = 1.0\n";
  const std::vector<std::pair<std::string, std::vector<std::string>>> scripts = {
      {"", {"no [[change]]"}},
      {"# nothing\n", {"no [[change]]"}},
      {"[[change]\n", {":1", "not TOML"}},
      {"\xff\xfe", {"not TOML"}},
      {std::string("a = \0", 5), {"not TOML"}},
      {"[change]\nat = 1.0\n", {"change = ", "two brackets"}},
      {"change = 3\n", {"change = 3", "two brackets"}},
      {"change = [1, 2]\n", {"change 1 = 1", "[[change]]"}},
      {"change = []\nseed = 3\n", {"seed = 3", "no such key", "[[change]]"}},
      {"[[changes]]\nat = 1.0\n", {"changes", "no such key"}},
      {"[[change]]\ndelay = \"1ms\"\n", {"change 1.at", "missing"}},
      {"[[change]]\nat = -1\n", {"change 1.at = -1", "after the start"}},
      {"[[change]]\nat = nan\n", {"change 1.at = nan", "after the start"}},
      {"[[change]]\nat = 2000000\n", {"change 1.at", "1e6"}},
      {"[[change]]\nat = true\n", {"change 1.at = true", "after the start"}},
      {"[[change]]\nat = 2\n" + change, {"change 2.at = 1", "after the change before", "2 s"}},
      {change + "delay = \"50\"\n", {"change 1.delay", "50", "0s to 10s"}},
      {change + "delay = 50\n", {"change 1.delay = 50", "0s to 10s"}},
      {change + "jitter = \"fast\"\n", {"change 1.jitter", "fast", "50ms"}},
      {change + "loss = \"200%\"\n", {"change 1.loss", "200%", "0% to 100%"}},
      {change + "loss = -0.1\n", {"change 1.loss = -0.1", "0% to 100%"}},
      {change + "duplicate = [1]\n", {"change 1.duplicate", "0% to 100%"}},
      {change + "reorder = inf\n", {"change 1.reorder = inf", "0% to 100%"}},
      {change + "corrupt = { a = 1 }\n", {"change 1.corrupt", "0% to 100%"}},
      {change + "outage = 1\n", {"change 1.outage = 1", "true or false"}},
      {change + "keep_order = \"yes\"\n", {"change 1.keep_order", "true or false"}},
      {change + "rebind = 2020-01-01\n", {"change 1.rebind", "true or false"}},
      {change + "cut = \"both\"\n", {"change 1.cut", "both", "\"forward\", \"back\", \"none\""}},
      {change + "cut = true\n", {"change 1.cut = true", "one of"}},
      {change + "dealy = 1\n", {"change 1.dealy = 1", "no such key", "delay", "rebind"}},
      {change + "at = 2.0\n", {"not TOML"}},
  };
  for (const auto& [text, words] : scripts) {
    SCOPED_TRACE(text);
    try {
      (void)parseLinkScript(text, "s.toml");
      ADD_FAILURE() << "was taken";
    } catch (const UsageError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find("s.toml"), 0U) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << '"' << word << "\" in: " << message;
    }
  }
}

}  // namespace
}  // namespace tandem::demos
