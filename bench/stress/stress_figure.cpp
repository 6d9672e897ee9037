#include "bench/stress/stress_figure.h"

#include <cmath>

#include <fmt/format.h>

namespace tandem::demos::bench {
namespace {

constexpr std::size_t kColumns = 3;
constexpr double kLeft = 82, kGapX = 40, kPanelWidth = 240;  // [px]
constexpr double kTop = 92, kGapY = 74, kPanelHeight = 230;  // [px]

struct Look {
  Stability stability;
  const char* colour;
  const char* text;
};
constexpr Look kLooks[] = {{Stability::kStable, "#56b4e9", "comes to rest"},
                           {Stability::kGrows, "#e69f00", "grows"},
                           {Stability::kNotFinite, "#a50f15", "not finite"}};

/// Half of the distance between two values of a grid in the logarithm, as a factor.
double halfCell(double first, double last, std::size_t count) {
  return std::pow(last / first, 0.5 / static_cast<double>(count - 1));
}

void drawPanel(plot::FigureWriter& writer, const StabilityMap& map, const plot::PanelBox& box,
               bool is_left, bool is_lowest) {
  const double slow = map.host_rates.front(), fast = map.host_rates.back();
  const double wide = halfCell(slow, fast, map.host_rates.size());
  const double high = halfCell(map.stiffness.front(), map.stiffness.back(), map.stiffness.size());
  writer.beginPanel(box, map.method);
  writer.command("set logscale xy; unset grid");
  writer.setRange('x', {1e3 / fast / wide, 1e3 / slow * wide});
  writer.setRange('y', {map.stiffness.front() / high, map.stiffness.back() * high});
  writer.command("set xtics (1, 2, 5, 10, 20, 33); unset mxtics; unset mytics");
  if (is_left) {
    writer.command(
        "set ytics ('10' 10, '100' 100, '10\u00b3' 1e3, '10\u2074' 1e4, "
        "'10\u2075' 1e5, '10\u2076' 1e6)");
    writer.setLabel('y', "stiffness of contact and coupler [N/m]");
  } else {
    writer.command("set ytics ('' 10, '' 100, '' 1e3, '' 1e4, '' 1e5, '' 1e6)");
  }
  if (is_lowest) writer.setLabel('x', "host step [ms]");
  std::vector<std::string> plots;
  for (const Look& look : kLooks) {
    std::string rows;
    for (std::size_t k = 0; k < map.stiffness.size(); ++k)
      for (std::size_t r = 0; r < map.host_rates.size(); ++r) {
        if (map.at(k, r) != look.stability) continue;
        const double step = 1e3 / map.host_rates[r], stiffness = map.stiffness[k];
        rows += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n", step, stiffness,
                            step / wide, step * wide, stiffness / high, stiffness * high);
      }
    if (rows.empty()) continue;
    plots.push_back(
        fmt::format("{} using 1:2:3:4:5:6 with boxxyerror fs solid 1.0 noborder lc rgb '{}'",
                    writer.addData(rows), look.colour));
  }
  if (map.method == "force injection") {
    std::string rows;
    for (const double stiffness : map.stiffness)
      rows += fmt::format("{:.6g} {:.6g}\n", 1e3 * computeInjectionLimit(stiffness), stiffness);
    plots.push_back(
        fmt::format("{} using 1:2 with lines lc rgb '#000000' lw 2", writer.addData(rows)));
  }
  writer.plot(plots);
}

}  // namespace

plot::Figure makeStabilityFigure(const std::vector<StabilityMap>& maps) {
  const std::size_t rows = (maps.size() + kColumns - 1) / kColumns;
  plot::FigureWriter writer(
      "stability", "Stability: stiffness against host step",
      static_cast<int>(kTop + static_cast<double>(rows) * (kPanelHeight + kGapY)));
  std::vector<plot::LegendEntry> entries;
  for (const Look& look : kLooks)
    entries.push_back({{fmt::format("points lc rgb '{}' pt 5 ps 1.6", look.colour)}, look.text});
  plot::LegendEntry limit;
  limit.styles.emplace_back("lines lc rgb '#000000' lw 2");
  limit.text = "limit of injection by analysis";
  entries.push_back(limit);
  writer.legend({kLeft, 36, 3 * kPanelWidth + 2 * kGapX, 26}, entries);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const auto column = static_cast<double>(i % kColumns), row = static_cast<double>(i / kColumns);
    drawPanel(writer, maps[i],
              {kLeft + column * (kPanelWidth + kGapX), kTop + row * (kPanelHeight + kGapY),
               kPanelWidth, kPanelHeight},
              i % kColumns == 0, i + kColumns >= maps.size());
  }
  return std::move(writer).finish(
      "A sphere of 0.1 kg, held by a coupler to a target inside a fixed cube, is released above "
      "it. "
      "Grows: in the second half it has more energy than it was released with.");
}

}  // namespace tandem::demos::bench
