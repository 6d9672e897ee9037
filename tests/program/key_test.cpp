// `tandem key new FILE` writes a key file that only its owner may read, and overwrites none.

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "tandem/plugin/key_file.h"

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

void expectRefused(const Outcome& outcome, const Words& words) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& word : words)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << '"' << word << "\" in: " << outcome.err;
}

TEST(KeyNew, WritesAFileThatReadsBack) {
  const TempFolder folder;
  const std::string one = folder / "one.key", two = folder / "two.key";
  const Outcome outcome = runTandem({"key", "new", one});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find(one), std::string::npos) << outcome.out;
  EXPECT_EQ(runTandem({"key", "new", two}).status, 0);

  EXPECT_EQ(fs::status(one).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(readFile(one).starts_with("tandem-key-1 "));
  EXPECT_FALSE(readKeyFile(one).equals(readKeyFile(two)));
}

TEST(KeyNew, DoesNotShowTheKey) {
  const TempFolder folder;
  const Outcome outcome = runTandem({"key", "new", folder / "a.key"});
  const std::string text = readFile(folder / "a.key");
  const std::string digits = text.substr(text.find('\n') + 1, 64);
  EXPECT_EQ(outcome.out.find(digits.substr(0, 8)), std::string::npos) << outcome.out;
}

TEST(KeyNew, RefusesAFileThatIsThere) {
  const TempFolder folder;
  const std::string file = folder.write("a.key", "precious");
  expectRefused(runTandem({"key", "new", file}), {file, "never overwritten", "another name"});
  EXPECT_EQ(readFile(file), "precious");
}

TEST(KeyNew, RefusesAFolderThatIsNotThere) {
  const TempFolder folder;
  const std::string file = folder / "missing/a.key";
  expectRefused(runTandem({"key", "new", file}), {file, "No such file", "folder"});
}

TEST(KeyNew, RefusesBadUse) {
  expectRefused(runTandem({"key"}), {"--help"});
  expectRefused(runTandem({"key", "new"}), {"file", "--help"});
  expectRefused(runTandem({"key", "old"}), {"--help"});
  expectRefused(runTandem({"keys"}), {"keys", "no such command", "key"});
}

}  // namespace
}  // namespace tandem::test
