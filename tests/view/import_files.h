#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "terminal/usage_error.h"

namespace tandem::demos {

/// A folder of its own for files of a test.
class ImportFiles {
 public:
  ImportFiles() { std::filesystem::create_directories(folder_); }
  ~ImportFiles() { std::filesystem::remove_all(folder_); }
  ImportFiles(const ImportFiles&) = delete;
  ImportFiles& operator=(const ImportFiles&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("tandem_import_" +
       std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

/// `import` must throw a UsageError of one line that begins with the file and has the word.
template <typename Import>
void expectRefused(const std::filesystem::path& file, const std::string& word, Import import) {
  try {
    (void)import(file);
    ADD_FAILURE() << "not refused: " << file;
  } catch (const UsageError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.rfind(file.string() + ": ", 0), 0u) << line;
    EXPECT_NE(line.find(word), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

}  // namespace tandem::demos
