// Pictures as PNG files: whole, or as they were before.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stb_image.h>
#include <unistd.h>

#include "gl/picture.h"
#include "support/temp_folder.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

std::size_t countFiles(const fs::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& file : fs::directory_iterator(folder)) ++count;
  return count;
}

Picture makeSmallPicture() {
  Picture picture{.size = {.width = 3, .height = 2}, .rgba = {}};
  for (int i = 0; i < 24; ++i)
    picture.rgba.push_back(static_cast<std::uint8_t>(i % 4 == 3 ? 255 : 10 * i));
  return picture;
}

TEST(Png, IsReadBackAsItWas) {
  const tandem::test::TempFolder folder;
  const fs::path file = folder.path() / "picture.png";
  const Picture picture = makeSmallPicture();
  EXPECT_EQ(writePng(picture, file), std::nullopt);
  EXPECT_EQ(countFiles(folder.path()), 1U);
  int width = 0, height = 0, channels = 0;
  stbi_uc* const bytes = stbi_load(file.c_str(), &width, &height, &channels, 4);
  ASSERT_NE(bytes, nullptr);
  EXPECT_EQ(width, 3);
  EXPECT_EQ(height, 2);
  EXPECT_EQ(std::vector<std::uint8_t>(bytes, bytes + 24), picture.rgba);
  stbi_image_free(bytes);
}

TEST(Png, SaysWhyItCannotBeWritten) {
  const tandem::test::TempFolder folder;
  const auto no_folder = writePng(makeSmallPicture(), folder.path() / "missing" / "picture.png");
  ASSERT_TRUE(no_folder);
  EXPECT_NE(no_folder->find("missing/picture.png: the picture cannot be written"),
            std::string::npos);
  EXPECT_EQ(no_folder->find('\n'), std::string::npos);
  // A folder that is not empty cannot be replaced; nothing half-written stays beside it.
  fs::create_directories(folder.path() / "taken.png" / "inside");
  EXPECT_TRUE(writePng(makeSmallPicture(), folder.path() / "taken.png"));
  EXPECT_EQ(countFiles(folder.path()), 1U);
  EXPECT_TRUE(writePng({}, folder.path() / "empty.png"));
}

// A full disk is noticed, and an older picture stays.
TEST(Png, LeavesTheOlderPictureIfTheDiskIsFull) {
  ASSERT_TRUE(fs::exists("/dev/full"));
  const tandem::test::TempFolder folder;
  const fs::path file = folder.path() / "picture.png";
  std::ofstream(file) << "older";
  fs::create_symlink("/dev/full", folder.path() / ("picture.png.part" + std::to_string(getpid())));
  EXPECT_TRUE(writePng(makeSmallPicture(), file));
  EXPECT_EQ(fs::file_size(file), 5U);
  EXPECT_EQ(countFiles(folder.path()), 1U);
}

}  // namespace
}  // namespace tandem::view
