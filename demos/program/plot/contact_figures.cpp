#include "plot/contact_figures.h"

#include <algorithm>

#include <fmt/format.h>

#include "plot/columns.h"
#include "plot/findings.h"
#include "plot/labels.h"

namespace tandem::demos::plot {

Figure contactMotion(const SchemeGroup& group, const std::string& name) {
  ColumnFigure figure;
  figure.name = name;
  figure.title = fmt::format("User 1 pushes user 2: contact {:g} N/m, network delay {:g} ms",
                             group.first().setting("/contact/stiffness"),
                             group.first().setting("/network/delay") * 1e3);
  const std::string user_style = fmt::format("lc rgb '{}' lw 2", kUser1Colour);
  const std::string proxy_style = fmt::format("lc rgb '{}' lw 2 dt (9,5)", kUser2Colour);
  figure.legend = {{{"lines " + user_style}, "user 1"},
                   {{"lines " + proxy_style}, "proxy of user 2"},
                   {{"lines lc rgb '#000000' lw 1.2"}, "force on user 1"}};
  figure.rows = {{"along x [mm]", 190, {}}, {"force [N]", 150, {}}};
  for (const Run* run : group.runs) {
    const Table site = readTable(run->dir / "site1.csv");
    const Signal& t = site.column("t");
    std::vector<Curve> positions = {{t, scaled(site.column("device_x"), 1e3), user_style}};
    if (run->scheme != "virtual_coupling")
      positions.push_back({t, scaled(site.column("proxy_x"), 1e3), proxy_style});
    figure.schemes.push_back(run->scheme);
    figure.rows[0].panels.push_back(positions);
    figure.rows[1].panels.push_back(
        {{t, normOf(site, "force"), fmt::format("lc rgb '{}' lw 1.2", schemeColour(run->scheme))}});
    figure.contact.push_back(contactStretches(site));
  }

  std::vector<std::string> verdicts;
  for (const Run* run : group.runs)
    verdicts.push_back(fmt::format("{}: {} ({})", schemeLabel(run->scheme),
                                   contactVerdict(run->site[0].contact_transitions),
                                   changesText(run->site[0].contact_transitions)));
  figure.caption = fmt::format(
      "Displacement from the start of user 1 and of user 2’s proxy at site 1, force on user 1, and "
      "contact (filled) over time. Contact by scheme – {}.",
      fmt::join(verdicts, "; "));
  return drawColumns(figure);
}

}  // namespace tandem::demos::plot
