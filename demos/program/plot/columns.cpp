#include "plot/columns.h"

#include <fmt/format.h>

#include "plot/labels.h"

namespace tandem::demos::plot {
namespace {

constexpr double kLeft = 82;     // room for the labels of the axis of values [px]
constexpr double kRight = 16;    // [px]
constexpr double kTop = 42;      // room for the figure's title [px]
constexpr double kLegend = 26;   // [px]
constexpr double kHeading = 26;  // room for the schemes' names [px]
constexpr double kRowGap = 20;   // [px]
constexpr double kColumnGap = 18;
constexpr double kRibbon = 16;  // height of the ribbon of contact [px]
constexpr double kBottom = 58;  // room for the axis of time [px]

class Layout {
 public:
  explicit Layout(const ColumnFigure& columns) : columns_(columns) {
    double y = kTop + kLegend + kHeading;
    for (const PanelRow& row : columns.rows) {
      tops_.push_back(y);
      y += row.height + kRowGap;
    }
    if (hasRibbon()) y += kRibbon;
    height_ = y - (hasRibbon() ? 0.0 : kRowGap) + kBottom;
  }

  [[nodiscard]] bool hasRibbon() const { return !columns_.contact.empty(); }
  [[nodiscard]] int height() const { return static_cast<int>(height_); }
  [[nodiscard]] PanelBox legend() const { return {kLeft, kTop, 900 - kLeft - kRight, kLegend}; }

  [[nodiscard]] PanelBox panel(std::size_t row, std::size_t column) const {
    return {columnLeft(column), tops_[row], columnWidth(), columns_.rows[row].height};
  }

  [[nodiscard]] PanelBox ribbon(std::size_t column) const {
    return {columnLeft(column), height_ - kBottom - kRibbon, columnWidth(), kRibbon};
  }

 private:
  [[nodiscard]] double columnWidth() const {
    const double count = static_cast<double>(columns_.schemes.size());
    return (900 - kLeft - kRight - kColumnGap * (count - 1)) / count;
  }
  [[nodiscard]] double columnLeft(std::size_t column) const {
    return kLeft + static_cast<double>(column) * (columnWidth() + kColumnGap);
  }

  const ColumnFigure& columns_;
  std::vector<double> tops_;
  double height_ = 0;
};

Range timeRange(const ColumnFigure& columns) {
  Range range = Range::nothing();
  for (const std::vector<Curve>& panel : columns.rows.front().panels)
    for (const Curve& curve : panel) {
      const Range covered = recordedTime(curve.t);
      range.include({covered.low, covered.high});
    }
  return range;
}

Range valueRange(const PanelRow& row) {
  Range range = Range::nothing();
  for (const std::vector<Curve>& panel : row.panels)
    for (const Curve& curve : panel) range.include(curve.y);
  return range.padded().atLeast(1.0);
}

void drawCurves(FigureWriter& writer, const std::vector<Curve>& curves) {
  std::vector<std::string> plots;
  for (const Curve& curve : curves)
    plots.push_back(
        fmt::format("{} using 1:2 with lines {}", writer.addSeries(curve.t, curve.y), curve.style));
  writer.plot(plots);
}

// Axis of time: tic labels and label under the lowest panel of a column only.
void finishTimeAxis(FigureWriter& writer, const Range& time, double width, bool is_lowest) {
  writer.setRange('x', time);
  writer.setTics('x', time, width, 44);
  if (is_lowest)
    writer.setLabel('x', "time [s]");
  else
    writer.hideTicLabels('x');
}

void drawRibbon(FigureWriter& writer, const Layout& layout, const ColumnFigure& columns,
                std::size_t column, const Range& time) {
  const PanelBox box = layout.ribbon(column);
  writer.beginPanel(box, "");
  finishTimeAxis(writer, time, box.width, true);
  writer.setRange('y', {0, 1});
  writer.command("unset grid; set border 15");
  writer.command(column == 0 ? "set ytics ('contact' 0.5) scale 0" : "unset ytics");
  writer.plot({fmt::format(
      "{} using (($1+$2)/2):(0.5):1:2:(0):(1) with boxxyerror fs solid noborder "
      "lc rgb '{}'",
      writer.addData(columns.contact[column]), schemeColour(columns.schemes[column]))});
}

}  // namespace

Figure drawColumns(const ColumnFigure& columns) {
  const Layout layout(columns);
  FigureWriter writer(columns.name, columns.title, layout.height());
  const Range time = timeRange(columns);

  writer.legend(layout.legend(), columns.legend);
  for (std::size_t r = 0; r < columns.rows.size(); ++r) {
    const PanelRow& row = columns.rows[r];
    const Range values = valueRange(row);
    const bool is_lowest = r + 1 == columns.rows.size() && !layout.hasRibbon();
    for (std::size_t c = 0; c < columns.schemes.size(); ++c) {
      const PanelBox box = layout.panel(r, c);
      writer.beginPanel(box, r == 0 ? schemeLabel(columns.schemes[c]) : "");
      finishTimeAxis(writer, time, box.width, is_lowest);
      writer.setRange('y', values);
      writer.setTics('y', values, box.height, 26);
      if (c == 0)
        writer.setLabel('y', row.label);
      else
        writer.hideTicLabels('y');
      drawCurves(writer, row.panels[c]);
    }
  }
  if (layout.hasRibbon())
    for (std::size_t c = 0; c < columns.schemes.size(); ++c)
      drawRibbon(writer, layout, columns, c, time);
  return std::move(writer).finish(columns.caption);
}

}  // namespace tandem::demos::plot
