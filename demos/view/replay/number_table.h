#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::view {

/// Numbers of some columns of a CSV file, read row by row.
class NumberTable {
 public:
  /// Throws UsageError, one line with the remedy, if the file cannot be read or lacks a column.
  NumberTable(std::filesystem::path file, const std::vector<std::string>& columns);

  /// Reads the next row; false after the last. Throws UsageError with file and line if a row is
  /// short, or a value is no finite number.
  [[nodiscard]] bool next();
  /// A value of the row, in the order of the columns that were asked for.
  [[nodiscard]] double operator[](std::size_t column) const { return values_[column]; }
  /// Throws UsageError: what is wrong in this row, and the remedy.
  [[noreturn]] void refuse(const std::string& problem) const;

 private:
  [[nodiscard]] double parse(std::size_t column, std::string_view text) const;
  void findColumns();

  std::filesystem::path file_;
  std::vector<std::string> names_;
  std::vector<std::size_t> places_;  ///< in a line, of each name
  std::vector<double> values_;
  std::size_t width_ = 0;  ///< values of a line
  std::ifstream stream_;
  std::string line_;
  std::uint64_t number_ = 0;  ///< of the line, from 1
  std::vector<std::string_view> cells_;
};

}  // namespace tandem::view
