#include "bench/accuracy/accuracy_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bench/methods/all_methods.h"

namespace tandem::demos::bench {
namespace {

using plot::PanelBox;

constexpr int kColumns = 3;
constexpr double kLeft = 82, kGapX = 62, kPanelWidth = 226;  // [px]
constexpr double kTop = 52, kGapY = 74, kPanelHeight = 176;  // [px]
constexpr double kLegendRow = 26;                            // [px]
constexpr std::size_t kLegendColumns = 4;

/// What a figure shows of a run.
struct Measure {
  std::string name;
  std::string title;
  std::string label;
  double (*value)(const AccuracyRun& run);
  double floor;  // below this is rounding, and drawn there
};

const Measure kMeasures[] = {
    {"accuracy", "Run time against position error", "largest position error [mm]",
     [](const AccuracyRun& run) { return 1e3 * run.errors.position(); }, 1e-11},
    {"accuracy_force", "Run time against force error", "largest force error [N]",
     [](const AccuracyRun& run) { return run.errors.force; }, 1e-11}};

std::string lineStyle(const Method& method) {
  return fmt::format("lines lc rgb '{}' lw 1.6", method.style().colour);
}
std::string pointStyle(const Method& method, double size) {
  return fmt::format("points lc rgb '{}' pt {} ps {}", method.style().colour, method.style().point,
                     size);
}

bool isShown(const Measure& measure, const AccuracyRun& run) {
  return run.isGood() && measure.value(run) > 0.0;
}

/// Powers of ten around all that is shown.
struct Decades {
  int low = std::numeric_limits<int>::max();
  int high = std::numeric_limits<int>::min();

  void include(double value) {
    low = std::min(low, static_cast<int>(std::floor(std::log10(value) - 0.1)));
    high = std::max(high, static_cast<int>(std::ceil(std::log10(value) + 0.1)));
  }
  [[nodiscard]] plot::Range range() const { return {std::pow(10.0, low), std::pow(10.0, high)}; }
};

/// "10\u207b\u2075" for -5: the figures' terminals have no markup.
std::string powerText(int exponent) {
  constexpr const char* kDigits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "10\u207b" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

/// A logarithmic axis with tics at every decade, or at every second or third where there are many.
void setAxis(plot::FigureWriter& writer, char axis, const Decades& decades) {
  constexpr int kMostTics = 6;
  const int step = (decades.high - decades.low + kMostTics - 1) / kMostTics;
  std::vector<std::string> tics;
  for (int exponent = decades.low; exponent <= decades.high; exponent += std::max(step, 1))
    tics.push_back(fmt::format("'{}' 1e{}", powerText(exponent), exponent));
  writer.command(fmt::format("set logscale {}", axis));
  writer.setRange(axis, decades.range());
  writer.command(fmt::format("set {}tics ({}); unset m{}tics", axis, fmt::join(tics, ", "), axis));
}

void drawPanel(plot::FigureWriter& writer, const SceneAccuracy& scene, const Measure& measure,
               const Decades& times, const PanelBox& box, bool is_left, bool is_lowest) {
  Decades errors;
  for (const AccuracyRun& run : scene.runs)
    if (isShown(measure, run)) errors.include(std::max(measure.value(run), measure.floor));
  writer.beginPanel(box, scene.title);
  setAxis(writer, 'x', times);
  setAxis(writer, 'y', errors);
  if (is_left) writer.setLabel('y', measure.label);
  if (is_lowest) writer.setLabel('x', "run time per simulated second [\u00b5s]");
  std::vector<std::string> plots;
  for (const auto& method : allMethods()) {
    std::string rows;
    for (const AccuracyRun& run : scene.runs)
      if (run.method == method->name() && isShown(measure, run))
        rows += fmt::format("{:.6g} {:.6g}\n", run.us_per_second,
                            std::max(measure.value(run), measure.floor));
    if (rows.empty()) continue;
    const std::string data = writer.addData(rows);
    plots.push_back(fmt::format("{} using 1:2 with {}", data, lineStyle(*method)));
    plots.push_back(fmt::format("{} using 1:2 with {}", data, pointStyle(*method, 0.7)));
  }
  writer.plot(plots);
}

/// Rows of the legend: every method that any panel shows.
void drawLegend(plot::FigureWriter& writer, const std::vector<SceneAccuracy>& scenes) {
  std::vector<plot::LegendEntry> entries;
  for (const auto& method : allMethods()) {
    const bool is_seen = std::any_of(scenes.begin(), scenes.end(), [&](const auto& scene) {
      return std::any_of(scene.runs.begin(), scene.runs.end(), [&](const AccuracyRun& run) {
        return run.method == method->name() && run.isGood();
      });
    });
    if (is_seen)
      entries.push_back({{lineStyle(*method), pointStyle(*method, 1.0)}, method->name()});
  }
  double top = 38;
  for (std::size_t first = 0; first < entries.size(); first += kLegendColumns) {
    const std::size_t last = std::min(first + kLegendColumns, entries.size());
    writer.legend({kLeft, top, kColumns * (kPanelWidth + kGapX) - kGapX, kLegendRow},
                  {entries.begin() + static_cast<std::ptrdiff_t>(first),
                   entries.begin() + static_cast<std::ptrdiff_t>(last)});
    top += kLegendRow;
  }
}

plot::Figure makeFigure(const std::vector<SceneAccuracy>& all, const Measure& measure) {
  std::vector<SceneAccuracy> scenes;
  Decades times;
  for (const SceneAccuracy& scene : all) {
    const auto shown = [&](const AccuracyRun& run) { return isShown(measure, run); };
    if (std::none_of(scene.runs.begin(), scene.runs.end(), shown)) continue;
    scenes.push_back(scene);
    for (const AccuracyRun& run : scene.runs)
      if (shown(run)) times.include(run.us_per_second);
  }
  const auto rows = (scenes.size() + kColumns - 1) / kColumns;
  const double legend_rows =
      std::ceil(static_cast<double>(allMethods().size()) / static_cast<double>(kLegendColumns));
  const double top = kTop + kLegendRow * legend_rows + 14;
  plot::FigureWriter writer(
      measure.name, measure.title,
      static_cast<int>(top + static_cast<double>(rows) * (kPanelHeight + kGapY)));
  drawLegend(writer, scenes);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto column = static_cast<double>(i % kColumns), row = static_cast<double>(i / kColumns);
    drawPanel(writer, scenes[i], measure, times,
              {kLeft + column * (kPanelWidth + kGapX), top + row * (kPanelHeight + kGapY),
               kPanelWidth, kPanelHeight},
              i % kColumns == 0, i + kColumns >= scenes.size());
  }
  return std::move(writer).finish(
      "Each line is a method, its points the host's step rates, slower ones to the left. Left and "
      "below is better; rates at which a method diverges have no point.");
}

}  // namespace

std::vector<plot::Figure> makeAccuracyFigures(const std::vector<SceneAccuracy>& scenes) {
  std::vector<plot::Figure> figures;
  for (const Measure& measure : kMeasures) {
    const bool has_points =
        std::any_of(scenes.begin(), scenes.end(), [&](const SceneAccuracy& scene) {
          return std::any_of(scene.runs.begin(), scene.runs.end(),
                             [&](const AccuracyRun& run) { return isShown(measure, run); });
        });
    if (has_points) figures.push_back(makeFigure(scenes, measure));
  }
  return figures;
}

}  // namespace tandem::demos::bench
