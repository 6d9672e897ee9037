#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/speed/speed_report.h"

namespace tandem::demos::bench {
namespace {

struct WayStyle {
  SpeedWay way;
  const char* colour;
  int point;
};
const WayStyle kStyles[] = {{SpeedWay::kBare60, "#999999", 6},
                            {SpeedWay::kBare240, "#e69f00", 4},
                            {SpeedWay::kWhole, "#d55e00", 5},
                            {SpeedWay::kIsland, "#0072b2", 7}};

/// One panel: the cases it shows, over one of their numbers.
struct Panel {
  std::string title;
  std::string x_label;
  bool over_objects;
  SpeedTouch touch;
  bool awake;
};
const Panel kPanels[] = {
    {"active boxes, cube pressed", "boxes of the host", false, SpeedTouch::kCube, true},
    {"sleeping boxes, cube pressed", "boxes of the host", false, SpeedTouch::kCube, false},
    {"many shared, one pressed", "shared objects", true, SpeedTouch::kCube, false},
    {"many shared, none touched", "shared objects", true, SpeedTouch::kNothing, false}};

constexpr double kLeft = 96, kTop = 90, kGapX = 74, kGapY = 82, kWidth = 340,
                 kHeight = 210;  // [px]

bool isShown(const Panel& panel, const SpeedCase& c) {
  if (c.scene.touch != panel.touch || c.scene.awake != panel.awake) return false;
  // Sweeps over objects are in a world of their own size.
  const bool is_objects_sweep = c.name.find("shared") != std::string::npos;
  return is_objects_sweep == panel.over_objects;
}

std::string lines(const WayStyle& style) {
  return fmt::format("lines lc rgb '{}' lw 1.8", style.colour);
}
std::string points(const WayStyle& style) {
  return fmt::format("points lc rgb '{}' pt {} ps 0.9", style.colour, style.point);
}

/// The decades of run time that any panel needs.
plot::Range findTimes(const SpeedReport& report) {
  double low = 1e300, high = 0.0;
  for (const SpeedCase& c : report.cases)
    for (const SpeedResult& result : c.results) {
      if (std::none_of(std::begin(kPanels), std::end(kPanels),
                       [&](const Panel& panel) { return isShown(panel, c); }))
        continue;
      low = std::min(low, result.us_per_second);
      high = std::max(high, result.us_per_second);
    }
  return {std::pow(10.0, std::floor(std::log10(low))), std::pow(10.0, std::ceil(std::log10(high)))};
}

void drawPanel(plot::FigureWriter& writer, const SpeedReport& report, const Panel& panel,
               const plot::PanelBox& box, const plot::Range& times) {
  writer.beginPanel(box, panel.title);
  writer.command("set logscale xy; unset mxtics; unset mytics");
  writer.setRange('y', {0.999 * times.low, 1.001 * times.high});
  writer.setLabel('x', panel.x_label);
  if (box.left == kLeft) {
    // Farther out than FigureWriter::setLabel() has it: tics here are words.
    writer.command(fmt::format(
        "set label 'run time per simulated second' at screen {:.5f}, graph 0.5 center rotate by 90",
        (kLeft - 80.0) / 900.0));
  }
  std::vector<std::string> x_tics, plots;
  double last = 1.0;
  for (const SpeedCase& c : report.cases) {
    if (!isShown(panel, c)) continue;
    const int x = panel.over_objects ? c.scene.objects : c.scene.bodies;
    x_tics.push_back(fmt::format("'{}' {}", x, x));
    last = std::max(last, static_cast<double>(x));
  }
  writer.setRange('x', {panel.over_objects ? 0.8 : 1.5, 1.4 * last});
  writer.command(fmt::format("set xtics ({})", fmt::join(x_tics, ", ")));
  std::vector<std::string> y_tics;
  for (double t = times.low; t < 1.5 * times.high; t *= 10.0)
    y_tics.push_back(t < 1e3   ? fmt::format("'{:.0f} µs' {}", t, t)
                     : t < 1e6 ? fmt::format("'{:.0f} ms' {}", t / 1e3, t)
                               : fmt::format("'{:.0f} s' {}", t / 1e6, t));
  writer.command(fmt::format("set ytics ({})", fmt::join(y_tics, ", ")));
  for (const WayStyle& style : kStyles) {
    std::string rows;
    for (const SpeedCase& c : report.cases)
      if (const SpeedResult* result = c.find(style.way); result && isShown(panel, c))
        rows += fmt::format("{} {:.6g}\n", panel.over_objects ? c.scene.objects : c.scene.bodies,
                            result->us_per_second);
    if (rows.empty()) continue;
    const std::string data = writer.addData(rows);
    plots.push_back(fmt::format("{} using 1:2 with {}", data, lines(style)));
    plots.push_back(fmt::format("{} using 1:2 with {}", data, points(style)));
  }
  plots.push_back("1e6 with lines lc rgb '#bbbbbb' dt 2");
  writer.plot(plots);
}

}  // namespace

plot::Figure makeSpeedFigure(const SpeedReport& report) {
  plot::FigureWriter writer("speed", "Run time against the size of the world",
                            static_cast<int>(kTop + 2 * (kHeight + kGapY)));
  std::vector<plot::LegendEntry> entries;
  for (const WayStyle& style : kStyles)
    entries.push_back({{lines(style), points(style)}, nameOf(style.way)});
  writer.legend({kLeft, 38, 2 * kWidth + kGapX, 26}, entries);
  const plot::Range times = findTimes(report);
  int i = 0;
  for (const Panel& panel : kPanels) {
    drawPanel(
        writer, report, panel,
        {kLeft + (i % 2) * (kWidth + kGapX), kTop + (i / 2) * (kHeight + kGapY), kWidth, kHeight},
        times);
    ++i;
  }
  return std::move(writer).finish(
      "Lower is better. Above the dashed line a processor core cannot keep up. Bullet alone "
      "feels no hand; it is there to compare with.");
}

}  // namespace tandem::demos::bench
