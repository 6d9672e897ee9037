#include "plot/coherency_figures.h"

#include <cmath>

#include <fmt/format.h>

#include "plot/findings.h"
#include "plot/labels.h"
#include "plot/reference.h"
#include "plot/signals.h"

namespace tandem::demos::plot {
namespace {

constexpr const char* kReferenceMark = "points pt 4 ps 0.9 lw 1.6 lc rgb '#000000'";
constexpr PanelBox kLegendBox = {82, 40, 802, 26};

double referenceValue(const ReferenceOutcome& reference, std::size_t measure) {
  const double values[] = {reference.mean_coherency, reference.received_mean1,
                           reference.received_mean2};
  return values[measure];
}

std::string titleOf(const SchemeGroup& group, const std::string& title) {
  return group.runs.size() == 1 ? fmt::format("{} ({})", title, schemeLabel(group.first().scheme))
                                : title;
}

// Rows "x low high y value" of one scheme's bars, with every cluster of bars one unit apart.
std::string barRows(const SchemeGroup& group, std::size_t scheme) {
  const double count = static_cast<double>(group.runs.size());
  const double width = 0.8 / count;
  std::string rows;
  for (std::size_t m = 0; m < coherencyMeasures().size(); ++m) {
    const double value = coherencyMeasures()[m].value(*group.runs[scheme]) * 1e3;
    const ReferenceOutcome* reference = referenceOf(*group.runs[scheme]);
    const double x = static_cast<double>(m) - 0.4 + width * (static_cast<double>(scheme) + 0.5);
    if (!std::isfinite(value)) continue;
    rows += fmt::format(
        "{:.6g} {:.6g} {:.6g} {:.6g} {} {}\n", x, x - 0.45 * width, x + 0.45 * width, value,
        numberText(value),
        reference == nullptr ? "NaN" : fmt::format("{:.6g}", referenceValue(*reference, m) * 1e3));
  }
  return rows;
}

Range barRange(const SchemeGroup& group) {
  Range range{0.0, 0.0};
  for (const CoherencyMeasure& measure : coherencyMeasures())
    for (const Run* run : group.runs) range.include({measure.value(*run) * 1e3});
  return {0.0, range.high > 0.0 ? 1.15 * range.high : 1.0};
}

}  // namespace

Figure coherencyBars(const SchemeGroup& group, const std::string& name) {
  FigureWriter writer(name, "Distance between the two copies of the object, by scheme", 432);
  std::vector<LegendEntry> legend;
  std::vector<std::string> bars;
  std::vector<std::string> marks;
  for (std::size_t s = 0; s < group.runs.size(); ++s) {
    const Run& run = *group.runs[s];
    const std::string data = writer.addData(barRows(group, s));
    legend.push_back({{fmt::format("points pt 5 ps 1.6 lc rgb '{}'", schemeColour(run.scheme))},
                      schemeLabel(run.scheme)});
    bars.push_back(
        fmt::format("{} using 1:($4/2):2:3:(0):4 with boxxyerror fs solid noborder lc rgb '{}'",
                    data, schemeColour(run.scheme)));
    marks.push_back(fmt::format("{} using 1:4:5 with labels offset 0,0.9", data));
    if (referenceOf(run) != nullptr)
      marks.push_back(fmt::format("{} using 1:6 with {}", data, kReferenceMark));
  }
  if (marks.size() > bars.size()) legend.push_back({{kReferenceMark}, "the paper’s equations"});
  bars.insert(bars.end(), marks.begin(), marks.end());

  writer.legend(kLegendBox, legend);
  writer.beginPanel({82, 80, 802, 312}, "");
  writer.setLabel('y', "mean distance [mm]");
  writer.setRange('x', {-0.55, 2.55});
  writer.setRange('y', barRange(group));
  writer.command(
      "unset grid; set grid y lt 1 lw 0.7 lc rgb '#dddddd'; set xtics scale 0 "
      "('both at equal time' 0, 'own and received, site 1' 1, 'own and received, site 2' 2)");
  writer.plot(bars);
  return std::move(writer).finish(
      "How far apart the two copies are on average: both at the same instant, and each site’s own "
      "copy against the other copy as it arrives there over the network. Lower is better.");
}

Figure coherencyOverTime(const SchemeGroup& group, const std::string& name) {
  FigureWriter writer(
      name, titleOf(group, "Distance between the two copies of the object over time"), 424);
  std::vector<LegendEntry> legend;
  std::vector<std::string> plots;
  Range time = Range::nothing();
  Range distance{0.0, 1e-3};  // [mm]
  for (const Run* run : group.runs) {
    const std::array<Table, 2> sites = loadSites(*run);
    const Signal& t = sites[0].column("t");
    const Range covered = recordedTime(t);
    time.include({covered.low, covered.high});
    const std::string style = fmt::format("lines lw 2 lc rgb '{}'", schemeColour(run->scheme));
    legend.push_back({{style}, schemeLabel(run->scheme)});
    const Signal separation = scaled(separationOf(sites), 1e3);
    distance.include(separation);
    plots.push_back(fmt::format("{} using 1:2 with {}", writer.addSeries(t, separation), style));
  }
  if (group.runs.size() > 1) writer.legend(kLegendBox, legend);
  writer.beginPanel({82, 80, 802, 280}, "");
  writer.setLabel('x', "time [s]");
  writer.setLabel('y', "|object 1 − object 2| [mm]");
  writer.setRange('x', time);
  writer.setRange('y', {0.0, 1.08 * distance.high});
  writer.plot(plots);
  return std::move(writer).finish(
      "Both copies at the same instant: the distance is zero when the users share one object.");
}

}  // namespace tandem::demos::plot
