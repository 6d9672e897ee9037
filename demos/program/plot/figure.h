#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tandem::demos::plot {

/// A picture of the report: gnuplot commands, or an SVG that needs no drawing.
struct Figure {
  std::string name;      ///< file name without extension
  std::string title;     ///< what is seen; drawn above the picture
  std::string caption;   ///< one or two sentences below it
  int width = 900;       ///< [px]
  int height = 480;      ///< [px]
  std::string data;      ///< gnuplot data blocks
  std::string commands;  ///< gnuplot commands that draw the panels
  std::string svg;       ///< a finished picture; then `data` and `commands` are empty
};

/// A rectangle of a figure [px], y downwards from the figure's top.
struct PanelBox {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;
};

struct Range {
  double low = 0;
  double high = 1;

  /// Covers `values` (NaN ignored) as well.
  void include(const std::vector<double>& values);
  /// Grown at both ends by `share` of its size; never empty.
  [[nodiscard]] Range padded(double share = 0.06) const;
  /// Grown upwards and downwards to a size of `span` at least, so that rounding errors stay small.
  [[nodiscard]] Range atLeast(double span) const;
  [[nodiscard]] static Range nothing();
};

/// A line of the legend: what is drawn, each a gnuplot style (`lines …` or `points …`), and text.
struct LegendEntry {
  std::vector<std::string> styles;
  std::string text;
};

/// Writes the gnuplot commands of one figure of several panels.
class FigureWriter {
 public:
  FigureWriter(std::string name, std::string title, int height);

  /// Stores rows of numbers; gives back the data block's name.
  std::string addData(const std::string& rows);
  /// Stores y over t, thinned so that each spike stays visible.
  std::string addSeries(const std::vector<double>& t, const std::vector<double>& y);

  /// Begins a panel whose axes lie at `box`; settings of earlier panels are forgotten.
  void beginPanel(const PanelBox& box, std::string_view title);
  void setRange(char axis, const Range& range);
  void setLabel(char axis, std::string_view text);
  void hideTicLabels(char axis);
  /// Tics at round values, about `gap` pixels apart or more on an axis that is `length` pixels
  /// long.
  void setTics(char axis, const Range& range, double length, double gap);
  /// One gnuplot command.
  void command(std::string_view text);
  /// Draws what `plots` says, each a clause of gnuplot's `plot`.
  void plot(const std::vector<std::string>& plots);
  /// One centred row of entries.
  void legend(const PanelBox& box, const std::vector<LegendEntry>& entries);

  [[nodiscard]] Figure finish(std::string caption) &&;

 private:
  [[nodiscard]] double screenY(double y) const { return 1.0 - y / figure_.height; }

  Figure figure_;
  PanelBox box_;  // of the panel at hand
  int blocks_ = 0;
};

/// 1, 2 or 5 times a power of ten: the least that cuts `size` into at most `parts` parts.
[[nodiscard]] double niceStep(double size, double parts);

/// `text` in gnuplot's single quotes.
[[nodiscard]] std::string gnuplotText(std::string_view text);

}  // namespace tandem::demos::plot
