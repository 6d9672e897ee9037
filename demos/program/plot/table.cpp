#include "plot/table.h"

#include <charconv>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::demos::plot {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Cuts the part before `separator` off the front of `rest`.
std::string_view takeUntil(char separator, std::string_view& rest) {
  const std::size_t end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return part;
}

std::vector<std::string_view> cellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  std::size_t begin = 0;
  for (std::size_t end = line.find(','); end != std::string_view::npos;
       end = line.find(',', begin)) {
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  cells.push_back(trimmed(line.substr(begin)));
  return cells;
}

bool readNumber(std::string_view cell, double& value) {
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
}

}  // namespace

Table Table::parse(std::string_view text, std::string source) {
  Table table;
  table.source_ = std::move(source);
  table.readHeader(takeUntil('\n', text));
  for (std::size_t line_number = 2; !text.empty(); ++line_number) {
    const std::string_view line = takeUntil('\n', text);
    if (!trimmed(line).empty()) table.readRow(line, line_number);
  }
  if (table.rows_ == 0)
    throw UsageError(fmt::format("{}: no rows below the header", table.source_));
  return table;
}

void Table::readHeader(std::string_view line) {
  for (const std::string_view cell : cellsOf(line)) {
    if (cell.empty()) throw UsageError(fmt::format("{}: line 1: a column has no name", source_));
    if (!index_.emplace(cell, names_.size()).second)
      throw UsageError(fmt::format("{}: line 1: column \"{}\" appears twice", source_, cell));
    names_.emplace_back(cell);
  }
  columns_.resize(names_.size());
}

void Table::readRow(std::string_view line, std::size_t line_number) {
  const std::vector<std::string_view> cells = cellsOf(line);
  if (cells.size() != names_.size())
    throw UsageError(fmt::format("{}: line {}: {} values, but the header names {} columns", source_,
                                 line_number, cells.size(), names_.size()));
  for (std::size_t c = 0; c < cells.size(); ++c) {
    double value = 0.0;
    if (!readNumber(cells[c], value))
      throw UsageError(fmt::format("{}: line {}, column \"{}\": \"{}\" is not a number", source_,
                                   line_number, names_[c], cells[c]));
    columns_[c].push_back(value);
  }
  ++rows_;
}

const std::vector<double>& Table::column(const std::string& name) const {
  const auto found = index_.find(name);
  if (found == index_.end())
    throw UsageError(fmt::format("{}: column \"{}\" is missing", source_, name));
  return columns_[found->second];
}

std::string readText(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || std::filesystem::is_directory(file) || (in.peek() != EOF && !(text << in.rdbuf())))
    throw UsageError(fmt::format("{}: cannot be read; give folders that `tandem run --out` wrote",
                                 file.string()));
  return text.str();
}

Table readTable(const std::filesystem::path& file) {
  return Table::parse(readText(file), file.string());
}

}  // namespace tandem::demos::plot
