#include "plot/html.h"

#include <cstdint>

#include <fmt/format.h>

namespace tandem::demos::plot {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.2rem clamp(0.8rem, 3vw, 2rem) 3rem; max-width: 72rem;
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif;
  color: #1c2126; background: #fff; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0.4rem 0 0.6rem; }
h2 { font-size: 1.3rem; margin: 2.4rem 0 0.5rem; padding-top: 0.6rem; border-top: 2px solid #e3e7ea; }
h3 { font-size: 1.08rem; margin: 1.6rem 0 0.4rem; }
p, ul { max-width: 46rem; margin: 0.5rem 0; }
ul { padding-left: 1.3rem; }
.wide { overflow-x: auto; margin: 0.8rem 0; -webkit-overflow-scrolling: touch; }
table { border-collapse: collapse; font-size: 0.88rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.3rem 0.5rem; text-align: left; vertical-align: top;
  border-bottom: 1px solid #e3e7ea; }
td { white-space: nowrap; }
.n { text-align: right; }
th.n { min-width: 4rem; }
thead th { background: #f4f6f8; font-weight: 600; vertical-align: bottom; }
thead .group { text-align: center; border-left: 2px solid #fff; }
.scheme { display: inline-block; width: 0.7em; height: 0.7em; margin-right: 0.45em; }
.reference { display: block; color: #5d6770; font-size: 0.92em; }
figure { margin: 1.2rem 0 1.6rem; max-width: 900px; }
figure img, figure svg { display: block; width: 100%; height: auto; min-width: 640px; }
figcaption { color: #414b54; font-size: 0.92rem; margin-top: 0.35rem; max-width: 46rem; }
button { font: inherit; padding: 0.2rem 0.9rem; border: 1px solid #9aa4ad; border-radius: 0.3rem;
  background: #f4f6f8; cursor: pointer; }
@media print { figure img, figure svg { min-width: 0; } figure, tr { break-inside: avoid; }
  button { display: none; } }
)";

bool isNumber(std::string_view cell) {
  const std::string_view text = cell.substr(0, cell.find('<'));
  return text == "–" ||
         (!text.empty() && text.find_first_not_of("0123456789.-/ ") == std::string_view::npos);
}

std::string rowHtml(const std::vector<std::string>& cells, const std::vector<bool>& is_number,
                    std::string_view tag) {
  std::string html = "<tr>";
  for (std::size_t c = 0; c < cells.size(); ++c)
    html += fmt::format("<{0}{1}>{2}</{0}>", tag, is_number[c] ? " class=\"n\"" : "", cells[c]);
  return html + "</tr>\n";
}

}  // namespace

std::string escapeHtml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string encodeBase64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

std::string HtmlTable::toHtml() const {
  std::vector<bool> is_number(header.size(), true);
  for (const std::vector<std::string>& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) is_number[c] = is_number[c] && isNumber(row[c]);

  std::string html = note.empty() ? "" : fmt::format("<p>{}</p>\n", note);
  html += "<div class=\"wide\"><table>\n<thead>";
  if (!groups.empty()) {
    html += "<tr>";
    for (const auto& [text, span] : groups)
      html += fmt::format("<th class=\"group\" colspan=\"{}\">{}</th>", span, text);
    html += "</tr>\n";
  }
  html += rowHtml(header, is_number, "th") + "</thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : rows) html += rowHtml(row, is_number, "td");
  return html + "</tbody></table></div>\n";
}

std::string htmlPage(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      escapeHtml(title), kStyle, body);
}

}  // namespace tandem::demos::plot
