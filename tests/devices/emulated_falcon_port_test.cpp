#include "tandem/falcon/emulated_falcon_port.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tandem/coordination/types.h"

namespace tandem {
namespace {

/// Changes the folder of temporary files while it lives.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& path) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", path.c_str(), 1);
  }
  ~TemporaryFolder() {
    if (before_.empty())
      ::unsetenv("TMPDIR");
    else
      ::setenv("TMPDIR", before_.c_str(), 1);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  std::string before_;
};

TEST(EmulatedFalconPort, WithoutAFolderForItsLinkItSaysSo) {
  const TemporaryFolder none("/no-such-folder");
  EXPECT_THROW((void)EmulatedFalconPort(), Error);
}

TEST(EmulatedFalconPort, LeavesNothingBehind) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "tandem_falcon_port_test";
  fs::remove_all(folder);
  fs::create_directory(folder);
  {
    const TemporaryFolder temporary(folder.string());
    EmulatedFalconPort one, other;
    EXPECT_NE(one.path(), other.path());
    EXPECT_TRUE(fs::is_symlink(one.path()));
    // Only the owner may put a link in its place.
    EXPECT_EQ(fs::status(fs::path(one.path()).parent_path()).permissions(), fs::perms::owner_all);
    one.unplug();
    EXPECT_FALSE(fs::is_symlink(one.path()));
    one.plugIn();
    EXPECT_TRUE(fs::is_symlink(one.path()));
  }
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace tandem
