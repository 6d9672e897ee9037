#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "terminal/usage_error.h"

namespace tandem::demos {

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
