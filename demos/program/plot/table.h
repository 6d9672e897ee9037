#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tandem::demos::plot {

/// A CSV file of numbers, read by header name.
///
/// The first line names the columns, in any order; every further line has one number per column
/// (`nan` and `inf` are numbers). Nothing is skipped in silence: a line that does not fit throws.
class Table {
 public:
  /// Reads `text`; `source` is the file name for messages. Throws UsageError with line and column.
  [[nodiscard]] static Table parse(std::string_view text, std::string source);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] bool has(const std::string& column) const { return index_.contains(column); }

  /// Values of one column, top to bottom. Throws UsageError naming file and column.
  [[nodiscard]] const std::vector<double>& column(const std::string& name) const;

  [[nodiscard]] const std::string& source() const { return source_; }

 private:
  void readHeader(std::string_view line);
  void readRow(std::string_view line, std::size_t line_number);

  std::string source_;
  std::unordered_map<std::string, std::size_t> index_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
  std::size_t rows_ = 0;
};

/// The whole file as text. Throws UsageError naming the file.
[[nodiscard]] std::string readText(const std::filesystem::path& file);

/// Reads a CSV file. Throws UsageError naming the file, and the line and column where it is broken.
[[nodiscard]] Table readTable(const std::filesystem::path& file);

}  // namespace tandem::demos::plot
