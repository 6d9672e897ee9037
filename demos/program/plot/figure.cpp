#include "plot/figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tandem::demos::plot {
namespace {

// More points than this are not seen in a panel 250 to 800 px wide.
constexpr std::size_t kBuckets = 500;

void addPoint(std::string& rows, double t, double y) {
  if (std::isfinite(y))
    rows += fmt::format("{:.6g} {:.6g}\n", t, y);
  else
    rows += fmt::format("{:.6g} NaN\n", t);
}

// The smallest and the largest value of [begin, end), in their order in time.
void addExtremes(std::string& rows, const std::vector<double>& t, const std::vector<double>& y,
                 std::size_t begin, std::size_t end) {
  const auto first = y.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = y.begin() + static_cast<std::ptrdiff_t>(end);
  const auto [low, high] = std::minmax_element(first, last);
  const auto [early, late] = std::minmax(low, high);
  addPoint(rows, t[static_cast<std::size_t>(early - y.begin())], *early);
  if (late != early) addPoint(rows, t[static_cast<std::size_t>(late - y.begin())], *late);
}

// About how wide a text is in the figures' font [px].
double textWidth(std::string_view text) {
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;  // not a later byte of UTF-8
  });
  return 7.4 * static_cast<double>(characters);
}

}  // namespace

void Range::include(const std::vector<double>& values) {
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
}

Range Range::padded(double share) const {
  if (!(low <= high)) return {0.0, 1.0};
  const double size = high - low;
  const double grow = size > 0.0 ? share * size : std::max(0.1 * std::abs(low), 1e-3);
  return {low - grow, high + grow};
}

Range Range::atLeast(double span) const {
  const double missing = std::max(0.0, span - (high - low));
  return {low - 0.5 * missing, high + 0.5 * missing};
}

Range Range::nothing() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {kInfinity, -kInfinity};
}

FigureWriter::FigureWriter(std::string name, std::string title, int height) {
  figure_.name = std::move(name);
  figure_.title = std::move(title);
  figure_.height = height;
}

std::string FigureWriter::addData(const std::string& rows) {
  const std::string name = fmt::format("$d{}", blocks_++);
  figure_.data +=
      fmt::format("{} << EOD\n{}EOD\n", name, rows.empty() ? "NaN NaN NaN NaN\n" : rows);
  return name;
}

std::string FigureWriter::addSeries(const std::vector<double>& t, const std::vector<double>& y) {
  const std::size_t count = std::min(t.size(), y.size());
  const std::size_t buckets = std::min(kBuckets, count);
  std::string rows;
  for (std::size_t b = 0; b < buckets; ++b)
    addExtremes(rows, t, y, b * count / buckets, (b + 1) * count / buckets);
  if (count > 0) addPoint(rows, t[count - 1], y[count - 1]);
  return addData(rows);
}

void FigureWriter::beginPanel(const PanelBox& box, std::string_view title) {
  const double w = figure_.width;
  const double h = figure_.height;
  command("reset");
  command(fmt::format("set lmargin at screen {:.5f}; set rmargin at screen {:.5f}", box.left / w,
                      (box.left + box.width) / w));
  command(fmt::format("set tmargin at screen {:.5f}; set bmargin at screen {:.5f}",
                      1.0 - box.top / h, 1.0 - (box.top + box.height) / h));
  command("set border 3 lc rgb '#555555'; set tics nomirror out scale 0.6");
  command("set grid lt 1 lw 0.7 lc rgb '#dddddd'; set samples 2; unset key; set format '%g'");
  box_ = box;
  if (!title.empty())
    command(fmt::format("set label {} at graph 0.5, screen {:.5f} center", gnuplotText(title),
                        screenY(box.top - 14)));
}

void FigureWriter::setRange(char axis, const Range& range) {
  command(fmt::format("set {}range [{:.7g}:{:.7g}]", axis, range.low, range.high));
}

void FigureWriter::setLabel(char axis, std::string_view text) {
  // Placed by pixel: gnuplot's own places differ between SVG and PNG.
  if (axis == 'x')
    command(fmt::format("set label {} at graph 0.5, screen {:.5f} center", gnuplotText(text),
                        screenY(box_.top + box_.height + 45)));
  else
    command(fmt::format("set label {} at screen {:.5f}, graph 0.5 center rotate by 90",
                        gnuplotText(text), (box_.left - 56) / figure_.width));
}

void FigureWriter::setTics(char axis, const Range& range, double length, double gap) {
  command(fmt::format("set {}tics {:.7g}", axis, niceStep(range.high - range.low, length / gap)));
}

void FigureWriter::hideTicLabels(char axis) { command(fmt::format("set format {} ''", axis)); }

void FigureWriter::command(std::string_view text) {
  figure_.commands += text;
  figure_.commands += '\n';
}

void FigureWriter::plot(const std::vector<std::string>& plots) {
  command(fmt::format("plot {}", fmt::join(plots, ", \\\n     ")));
}

void FigureWriter::legend(const PanelBox& box, const std::vector<LegendEntry>& entries) {
  constexpr double kSample = 34;  // length of a line's sample [px]
  constexpr double kSpace = 8;    // between sample and text [px]
  constexpr double kGap = 26;     // between entries [px]
  double width = -kGap;
  for (const LegendEntry& entry : entries) width += kSample + kSpace + textWidth(entry.text) + kGap;

  // Coordinates are pixels from the box's lower left corner.
  beginPanel(box, "");
  command("unset border; unset tics; unset grid");
  setRange('x', {0, box.width});
  setRange('y', {0, box.height});
  const double y = 0.5 * box.height;
  double x = 0.5 * (box.width - width);
  std::vector<std::string> plots;
  for (const LegendEntry& entry : entries) {
    for (const std::string& style : entry.styles) {
      const std::string rows = style.starts_with("points")
                                   ? fmt::format("{} {}\n", x + 0.5 * kSample, y)
                                   : fmt::format("{} {}\n{} {}\n", x, y, x + kSample, y);
      plots.push_back(fmt::format("{} with {}", addData(rows), style));
    }
    x += kSample + kSpace;
    command(fmt::format("set label {} at {:.1f},{:.1f} left", gnuplotText(entry.text), x, y));
    x += textWidth(entry.text) + kGap;
  }
  plot(plots);
}

Figure FigureWriter::finish(std::string caption) && {
  figure_.caption = std::move(caption);
  return std::move(figure_);
}

double niceStep(double size, double parts) {
  const double raw = size / parts;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw * 0.999) return factor * power;
  return 10.0 * power;
}

std::string gnuplotText(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';  // gnuplot writes a quote inside single quotes twice
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + "'";
}

}  // namespace tandem::demos::plot
