#include "simulated/force_recording.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "guard/settings_check.h"

namespace tandem::falcon_detail {
namespace {

constexpr std::string_view kHeader = "t,force_x,force_y,force_z";
constexpr double kMostForce = 1e6;  // [N]; of a scenario's hand_force, too
constexpr std::array<std::string_view, 4> kColumns = {"t", "force_x", "force_y", "force_z"};

/// Makes text of the file fit for a one-line message: short, without control characters.
std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string quoted = "'";
  for (const char c : text.substr(0, kLongest)) quoted += (c >= ' ' && c <= '~') ? c : '?';
  return quoted + (text.size() > kLongest ? "...'" : "'");
}

/// Reads the file line by line, and adds the line number to its errors.
class LineReader {
 public:
  explicit LineReader(const std::string& path) : path_(path) {
    // A pipe would wait for its writer, and a device may never end.
    std::error_code ignored;
    const auto type = std::filesystem::status(path, ignored).type();
    if (type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::socket ||
        type == std::filesystem::file_type::character || type == std::filesystem::file_type::block)
      throw Error(path_ + ": is a device or a pipe; give the path of a CSV file");
    stream_.open(path);
    if (!stream_) refuseFile();
  }

  /// Takes the next line, without its end. Returns false at the end of the file.
  bool next() {
    errno = 0;
    const bool found = static_cast<bool>(std::getline(stream_, line_));
    if (stream_.bad()) refuseFile();  // for example a folder: it opens, but cannot be read
    ++number_;
    if (found && !line_.empty() && line_.back() == '\r') line_.pop_back();
    return found;
  }

  [[nodiscard]] std::string_view line() const noexcept { return line_; }

  [[noreturn]] void refuseLine(const std::string& wrong, const std::string& remedy) const {
    throw Error(path_ + ":" + std::to_string(number_) + ": " + wrong + "; " + remedy);
  }

 private:
  [[noreturn]] void refuseFile() const {
    const int cause = errno != 0 ? errno : EIO;
    throw Error(path_ + ": cannot be read (" + std::generic_category().message(cause) +
                "); give the path of a readable CSV file");
  }

  std::string path_;
  std::ifstream stream_;
  std::string line_;
  std::size_t number_ = 0;
};

double parseNumber(const LineReader& reader, std::string_view column, std::string_view text) {
  const std::string what = std::string(column) + " is " + quote(text);
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) {
    reader.refuseLine(what + ", out of range", "write a number that fits a double");
  }
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    reader.refuseLine(what + ", not a number", "write a plain number such as -0.25, no spaces");
  }
  if (!std::isfinite(value)) {
    reader.refuseLine(what + ", not finite", "write a finite number or remove the row");
  }
  if (column != kColumns[0] && std::abs(value) > kMostForce)
    reader.refuseLine(what + ", above 1e6 N", "write a force of at most 1e6 N");
  return value;
}

std::array<double, kColumns.size()> parseRow(const LineReader& reader) {
  std::array<double, kColumns.size()> values{};
  std::size_t found = 0;
  std::string_view rest = reader.line();
  for (bool more = true; more; ++found) {
    const std::size_t comma = rest.find(',');
    if (found < values.size()) {
      values[found] = parseNumber(reader, kColumns[found], rest.substr(0, comma));
    }
    more = comma != std::string_view::npos;
    if (more) rest.remove_prefix(comma + 1);
  }
  if (found != values.size()) {
    reader.refuseLine("row has " + std::to_string(found) + " columns",
                      "write the 4 of the header, " + std::string(kHeader));
  }
  return values;
}

void requireHeader(LineReader& reader) {
  const std::string remedy = "the first line must be " + std::string(kHeader);
  if (!reader.next()) reader.refuseLine("the file is empty", remedy);
  if (reader.line() != kHeader) reader.refuseLine("header is " + quote(reader.line()), remedy);
}

void requireGrowingTime(const LineReader& reader, double before, double t) {
  if (t > before && std::isfinite(t - before)) return;
  reader.refuseLine("t is " + toText(t) + " after " + toText(before),
                    "sort the rows so that t grows, and remove doubles");
}

}  // namespace

std::vector<ForceRow> readForceRecording(const std::string& csv_path) {
  LineReader reader(csv_path);
  requireHeader(reader);
  std::vector<ForceRow> rows;
  while (reader.next()) {
    if (reader.line().empty()) reader.refuseLine("line is empty", "remove it");
    const auto [t, x, y, z] = parseRow(reader);
    if (!rows.empty()) requireGrowingTime(reader, rows.back().t, t);
    rows.push_back({t, Vec3(x, y, z)});
  }
  if (rows.empty()) reader.refuseLine("no rows after the header", "add one row or more");
  return rows;
}

}  // namespace tandem::falcon_detail
