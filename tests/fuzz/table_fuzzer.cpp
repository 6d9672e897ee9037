// CSV tables that `tandem plot` reads: a table with equally long columns, or a UsageError.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "demos/program/plot/table.h"
#include "demos/program/terminal/usage_error.h"

namespace tandem::demos::plot {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// The name of the first column, as the file spells it.
std::string firstName(std::string_view text) {
  const std::string_view cell = text.substr(0, text.find_first_of(",\n"));
  const std::size_t first = cell.find_first_not_of(" \t\r");
  return std::string(cell.substr(first, cell.find_last_not_of(" \t\r") - first + 1));
}

void read(std::string_view text) {
  try {
    const Table table = Table::parse(text, "fuzz.csv");
    require(table.rows() > 0);
    require(table.has(firstName(text)));
    require(table.column(firstName(text)).size() == table.rows());
    require(!table.has("no such column,"));
  } catch (const UsageError& error) {
    require(std::string_view(error.what()).starts_with("fuzz.csv: "));
  }
}

}  // namespace
}  // namespace tandem::demos::plot

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  tandem::demos::plot::read(text);
  return 0;
}
