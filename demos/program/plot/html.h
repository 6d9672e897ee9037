#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tandem::demos::plot {

/// `text` with the characters that mean something in HTML written as entities.
[[nodiscard]] std::string escapeHtml(std::string_view text);

[[nodiscard]] std::string encodeBase64(std::string_view bytes);

/// A table of ready-made HTML cells. Columns of numbers are aligned right.
struct HtmlTable {
  /// Optional row above the header: text and how many columns it spans.
  std::vector<std::pair<std::string, std::size_t>> groups;
  std::string note;  ///< above the table: what holds for all rows
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  [[nodiscard]] std::string toHtml() const;
};

/// A whole page around `body`: style, title, nothing from elsewhere.
[[nodiscard]] std::string htmlPage(std::string_view title, std::string_view body);

}  // namespace tandem::demos::plot
