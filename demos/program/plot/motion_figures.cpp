#include "plot/motion_figures.h"

#include <fmt/format.h>

#include "plot/columns.h"
#include "plot/labels.h"

namespace tandem::demos::plot {
namespace {

std::string lineStyle(std::string_view colour, bool is_dashed, double width = 1.8) {
  return fmt::format("lc rgb '{}' lw {} dt {}", colour, width, is_dashed ? "(9,5)" : "1");
}

}  // namespace

Figure cooperationMotion(const SchemeGroup& group, const std::string& name) {
  ColumnFigure figure;
  figure.name = name;
  figure.title = "Positions of users and object copies, and force on user 1";
  figure.legend = {{{"lines " + lineStyle(kUser1Colour, false)}, "user 1"},
                   {{"lines " + lineStyle(kUser2Colour, true)}, "user 2"},
                   {{"lines " + lineStyle("#000000", false, 2.4)}, "object, site 1"},
                   {{"lines " + lineStyle("#000000", true, 2.4)}, "object, site 2"}};
  figure.rows = {
      {"along x [mm]", 170, {}}, {"from mean object [mm]", 190, {}}, {"force [N]", 130, {}}};
  for (const Run* run : group.runs) {
    const std::array<Table, 2> sites = loadSites(*run);
    const Signal& t = sites[0].column("t");
    const std::string_view colour = schemeColour(run->scheme);
    const auto along = [&](std::size_t site, const char* column) {
      return scaled(sites[site].column(column), 1e3);
    };
    const std::vector<Curve> positions = {{t, along(0, "device_x"), lineStyle(kUser1Colour, false)},
                                          {t, along(1, "device_x"), lineStyle(kUser2Colour, true)},
                                          {t, along(0, "object_x"), lineStyle(colour, false, 2.4)},
                                          {t, along(1, "object_x"), lineStyle(colour, true, 2.4)}};
    const Signal mean = average(positions[2].y, positions[3].y);
    std::vector<Curve> relative = positions;
    for (Curve& curve : relative) curve.y = difference(curve.y, mean);

    figure.schemes.push_back(run->scheme);
    figure.rows[0].panels.push_back(positions);
    figure.rows[1].panels.push_back(relative);
    figure.rows[2].panels.push_back(
        {{t, normOf(sites[0], "force"), lineStyle(colour, false, 1.4)}});
  }
  figure.caption =
      "Top: displacement from the start along the axis from user 1 to user 2. Middle: the same, "
      "measured from the mean of the two copies (copies in the scheme’s colour). Bottom: size of "
      "the force on user 1.";
  return drawColumns(figure);
}

Figure spatialMotion(const Run& run, const std::string& name) {
  const std::array<Table, 2> sites = loadSites(run);
  const Signal& t = sites[0].column("t");
  FigureWriter writer(name, "Motion of users and object copies, and forces", 640);
  std::vector<LegendEntry> styles = {{{"lines " + lineStyle(kUser1Colour, false)}, "user 1"},
                                     {{"lines " + lineStyle(kUser2Colour, true)}, "user 2"}};
  if (run.hasObject())
    for (const bool is_dashed : {false, true})
      styles.push_back({{"lines " + lineStyle(schemeColour(run.scheme), is_dashed)},
                        is_dashed ? "object, site 2" : "object, site 1"});
  writer.legend({82, 42, 802, 26}, styles);

  const auto drawPanel = [&](const PanelBox& box, const std::string& title,
                             const std::string& label, const std::vector<Signal>& signals) {
    writer.beginPanel(box, title);
    writer.setLabel('x', "time [s]");
    writer.setLabel('y', label);
    writer.setRange('x', recordedTime(t));
    Range values = Range::nothing();
    for (const Signal& signal : signals) values.include(signal);
    values = values.padded().atLeast(1.0);
    writer.setRange('y', values);
    writer.setTics('y', values, box.height, 26);
    std::vector<std::string> plots;
    for (std::size_t i = 0; i < signals.size(); ++i)
      plots.push_back(fmt::format("{} using 1:2 with {}", writer.addSeries(t, signals[i]),
                                  styles[i].styles.front()));
    writer.plot(plots);
  };
  const auto coordinates = [&](const std::string& axis) {
    std::vector<Signal> signals = {scaled(sites[0].column("device_" + axis), 1e3),
                                   scaled(sites[1].column("device_" + axis), 1e3)};
    if (run.hasObject())
      for (const Table& site : sites) signals.push_back(scaled(site.column("object_" + axis), 1e3));
    return signals;
  };
  drawPanel({82, 98, 345, 190}, "along x", "displacement [mm]", coordinates("x"));
  drawPanel({539, 98, 345, 190}, "along y", "displacement [mm]", coordinates("y"));
  drawPanel({82, 388, 345, 190}, "along z", "displacement [mm]", coordinates("z"));
  drawPanel({539, 388, 345, 190}, "force on the users", "force [N]",
            {normOf(sites[0], "force"), normOf(sites[1], "force")});
  return std::move(writer).finish(
      "Displacements from the start in the scene’s frame, solid at site 1 and dashed at site 2, "
      "and the size of the force on each user.");
}

}  // namespace tandem::demos::plot
