#include "plot/sweep_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plot/findings.h"
#include "plot/labels.h"

namespace tandem::demos::plot {
namespace {

struct SweepPanel {
  std::string title;
  std::string label;
  std::function<double(const Run&)> value;
  std::string axis;  // gnuplot command for the axis of values
  double threshold = kMissing;
};

constexpr double kWidth = 802;  // of all panels together [px]
constexpr double kGap = 66;     // between panels [px]

std::vector<std::string> schemesOf(const Sweep& sweep) {
  std::vector<std::string> schemes;
  for (const std::string& scheme : knownSchemes())
    if (std::any_of(sweep.points.begin(), sweep.points.end(),
                    [&](const SchemeGroup& point) { return point.find(scheme) != nullptr; }))
      schemes.emplace_back(scheme);
  return schemes;
}

std::string sweepRows(const Sweep& sweep, const std::string& scheme, const SweepPanel& panel) {
  std::string rows;
  for (const SchemeGroup& point : sweep.points)
    if (const Run* run = point.find(scheme); run != nullptr && std::isfinite(panel.value(*run)))
      rows += fmt::format("{:.6g} {:.6g}\n", run->setting("/device/damping"), panel.value(*run));
  return rows;
}

std::string styleOf(const std::string& scheme) {
  return fmt::format("linespoints lc rgb '{}' lw 2 pt {} ps 1.1", schemeColour(scheme),
                     schemePoint(scheme));
}

Range dampingRange(const Sweep& sweep) {
  Range range = Range::nothing();
  for (const SchemeGroup& point : sweep.points)
    range.include({point.first().setting("/device/damping")});
  return range.padded(0.05);
}

void drawPanel(FigureWriter& writer, const Sweep& sweep, const SweepPanel& panel,
               const PanelBox& box) {
  writer.beginPanel(box, panel.title);
  writer.setLabel('x', "device damping b_dev [N s/m]");
  writer.setLabel('y', panel.label);
  writer.setRange('x', dampingRange(sweep));
  writer.command(panel.axis);
  std::vector<std::string> plots;
  if (std::isfinite(panel.threshold))
    plots.push_back(fmt::format("{} with lines lc rgb '#000000' dt (6,4) lw 1.2", panel.threshold));
  for (const std::string& scheme : schemesOf(sweep))
    plots.push_back(fmt::format("{} using 1:2 with {}",
                                writer.addData(sweepRows(sweep, scheme, panel)), styleOf(scheme)));
  writer.plot(plots);
}

std::vector<SweepPanel> panelsOf(RunKind kind) {
  if (kind == RunKind::kUserContact)
    return {{"contact of user 1: on/off changes", "changes (log scale)",
             [](const Run& run) { return run.site[0].contact_transitions; },
             "set logscale y; set yrange [0.8:*]; set ytics (1, 2, 5, 10, 20, 50, 100, 200, 500)",
             kIntermittentChanges},
            {"largest force on user 1", "force [N]",
             [](const Run& run) { return run.site[0].force_max; }, "set yrange [0:*]", kMissing}};
  std::vector<SweepPanel> panels;
  for (const CoherencyMeasure& measure : coherencyMeasures())
    panels.push_back({measure.name, panels.empty() ? "mean distance of copies [mm]" : "[mm]",
                      [value = measure.value](const Run& run) { return value(run) * 1e3; },
                      "set yrange [0:*]", kMissing});
  return panels;
}

}  // namespace

Figure sweepFigure(const Sweep& sweep, const std::string& name) {
  const bool is_contact = sweep.kind() == RunKind::kUserContact;
  FigureWriter writer(name,
                      is_contact ? "User-to-user contact against the device’s own damping"
                                 : "Distance between the object copies against device damping",
                      432);
  std::vector<LegendEntry> legend;
  for (const std::string& scheme : schemesOf(sweep))
    legend.push_back({{fmt::format("lines lc rgb '{}' lw 2", schemeColour(scheme)),
                       fmt::format("points lc rgb '{}' pt {} ps 1.1", schemeColour(scheme),
                                   schemePoint(scheme))},
                      schemeLabel(scheme)});
  if (is_contact)
    legend.push_back(
        {{"lines lc rgb '#000000' dt (6,4) lw 1.2"}, changesText(kIntermittentChanges)});
  writer.legend({82, 42, kWidth, 26}, legend);

  const std::vector<SweepPanel> panels = panelsOf(sweep.kind());
  const double count = static_cast<double>(panels.size());
  const double width = (kWidth - kGap * (count - 1)) / count;
  for (std::size_t p = 0; p < panels.size(); ++p)
    drawPanel(writer, sweep, panels[p],
              {82 + static_cast<double>(p) * (width + kGap), 100, width, 268});
  return std::move(writer).finish(
      is_contact
          ? "How often contact goes on or off, and the largest force, for each damping of the real "
            "device. One change means that the first touch is kept; the dashed line is where this "
            "report begins to call contact intermittent."
          : "Mean distance between the two copies for each damping of the real device, which the "
            "paper does not give: both copies at equal time, and each site’s own copy against the "
            "other as received there.");
}

}  // namespace tandem::demos::plot
