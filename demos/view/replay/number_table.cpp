#include "replay/number_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "replay/run_file.h"

namespace tandem::view {
namespace {

void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

NumberTable::NumberTable(std::filesystem::path file, const std::vector<std::string>& columns)
    : file_(std::move(file)), names_(columns), values_(columns.size()), stream_(file_) {
  number_ = 1;
  if (!std::filesystem::is_regular_file(file_) || !std::getline(stream_, line_))
    refuseRunFile(file_, "cannot be read");
  findColumns();
}

void NumberTable::findColumns() {
  split(line_, cells_);
  width_ = cells_.size();
  for (const std::string& name : names_) {
    const auto cell = std::ranges::find(cells_, name);
    if (cell == cells_.end()) refuse(fmt::format("there is no column \"{}\"", name));
    places_.push_back(static_cast<std::size_t>(cell - cells_.begin()));
  }
}

bool NumberTable::next() {
  ++number_;
  if (!std::getline(stream_, line_)) return false;
  split(line_, cells_);
  if (cells_.size() != width_)
    refuse(fmt::format("{} values, but the first line names {} columns", cells_.size(), width_));
  // A file that was cut off ends within a number.
  if (stream_.eof()) refuse("the line has no end");
  for (std::size_t i = 0; i < names_.size(); ++i) values_[i] = parse(i, cells_[places_[i]]);
  return true;
}

double NumberTable::parse(std::size_t column, std::string_view text) const {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    refuse(fmt::format("{} = {}: must be a finite number", names_[column], text.substr(0, 40)));
  return value;
}

void NumberTable::refuse(const std::string& problem) const {
  refuseRunFile(fmt::format("{}:{}", file_.string(), number_), problem);
}

}  // namespace tandem::view
