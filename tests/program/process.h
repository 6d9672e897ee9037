#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/temp_folder.h"

namespace tandem::test {

/// Result of a program.
struct Outcome {
  int status = -1;  ///< exit status; -1 if a signal ended it
  std::string out;  ///< all of its standard output
  std::string err;  ///< all of its standard error
};

/// Start options of a program, besides its arguments.
struct Start {
  std::string stdout_path;      ///< file for standard output, instead of Outcome::out
  long long largest_file = -1;  ///< limit of file sizes [bytes]; below 0: no limit
};

/// Runs a program to its end. Both outputs are files, so it sees no terminal.
[[nodiscard]] Outcome runProgram(const std::string& program,
                                 const std::vector<std::string>& arguments,
                                 const Start& start = {});

/// Expects this status and these words on stderr.
void expectLine(const Outcome& outcome, int status, const std::string& words);

/// A loopback address that no other process uses: tests may run twice at a time, with the same
/// ports.
[[nodiscard]] std::string ownLoopback();

[[nodiscard]] std::string readFile(const std::filesystem::path& path);

/// Names of the entries of a folder, sorted; empty if it does not exist.
[[nodiscard]] std::vector<std::string> listFolder(const std::filesystem::path& folder);

/// A CSV file of numbers by column name.
using Columns = std::map<std::string, std::vector<double>, std::less<>>;
[[nodiscard]] Columns readColumns(const std::filesystem::path& path);

}  // namespace tandem::test
