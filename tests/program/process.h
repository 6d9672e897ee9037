#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::test {

/// What a program left behind.
struct Outcome {
  int status = -1;  ///< exit status; -1 if a signal ended it
  std::string out;  ///< all of its standard output
  std::string err;  ///< all of its standard error
};

/// How a program is started, beyond its arguments.
struct Start {
  std::string stdout_path;      ///< where standard output goes instead of into Outcome::out
  long long largest_file = -1;  ///< files cannot grow beyond this [bytes]; below 0: no limit
};

/// Runs a program to its end, both outputs being files, so that it sees no terminal.
[[nodiscard]] Outcome runProgram(const std::string& program,
                                 const std::vector<std::string>& arguments,
                                 const Start& start = {});

/// The program on float64 Bullet.
[[nodiscard]] Outcome runTandem(const std::vector<std::string>& arguments, const Start& start = {});

/// Path of a scenario that ships with the program.
[[nodiscard]] std::string scenarioPath(std::string_view name);

/// A folder of its own, gone with all that is in it at the end.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string operator/(std::string_view name) const {
    return (path_ / name).string();
  }
  /// Writes a file and returns its path.
  std::string write(std::string_view name, std::string_view text) const;

 private:
  std::filesystem::path path_;
};

[[nodiscard]] std::string readFile(const std::filesystem::path& path);

/// Names of what is in a folder, sorted; nothing if it is not there.
[[nodiscard]] std::vector<std::string> listFolder(const std::filesystem::path& folder);

/// A CSV file of numbers by column name.
using Columns = std::map<std::string, std::vector<double>, std::less<>>;
[[nodiscard]] Columns readColumns(const std::filesystem::path& path);

}  // namespace tandem::test
