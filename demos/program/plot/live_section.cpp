#include "plot/live_section.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "plot/columns.h"
#include "plot/findings.h"
#include "plot/grouping.h"
#include "plot/labels.h"
#include "plot/run_tables.h"
#include "plot/signals.h"

namespace tandem::demos::plot {
namespace {

constexpr const char* kLiveStyle = "lc rgb '#000000' lw 1.4 dt (4,3)";

const char* nameOf(RunKind kind) {
  switch (kind) {
    case RunKind::kCooperation:
      return "cooperation";
    case RunKind::kUserContact:
      return "user-to-user contact";
    case RunKind::kPlayground:
      break;
  }
  return "playground";
}

struct Pair {
  const Run* live;
  const Run* in_virtual_time;  ///< or null
};

std::vector<Pair> findPairs(const std::vector<Run>& runs) {
  std::vector<Pair> pairs;
  for (const Run& live : runs) {
    if (!live.live) continue;
    const auto twin = std::find_if(runs.begin(), runs.end(), [&](const Run& run) {
      return !run.live && haveEqualSettings(run, live);
    });
    pairs.push_back({&live, twin == runs.end() ? nullptr : &*twin});
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    const auto key = [](const Run& run) {
      const double delay = run.setting("/network/delay");
      return std::tuple(run.kind, std::isfinite(delay) ? delay : 0.0, describeWithoutScheme(run),
                        schemeRank(run.scheme));
    };
    return key(*a.live) < key(*b.live);
  });
  return pairs;
}

using Value = double (*)(const Run&);

double inVirtualTime(const Pair& pair, Value value) {
  return pair.in_virtual_time ? value(*pair.in_virtual_time) : kMissing;
}

/// "virtual / live".
std::string bothTexts(const Pair& pair, Value value, int decimals) {
  return fixedText(inVirtualTime(pair, value), decimals) + " / " +
         fixedText(value(*pair.live), decimals);
}

/// Both, and by how many per cent they differ.
void addComparison(std::vector<std::string>& row, const Pair& pair, Value value, int decimals) {
  row.push_back(bothTexts(pair, value, decimals));
  const double percent = 100.0 * (value(*pair.live) / inVirtualTime(pair, value) - 1.0);
  row.push_back(std::isfinite(percent) ? fmt::format("{:+.1f}", percent) : "–");
}

HtmlTable liveTable(const std::vector<Pair>& pairs) {
  HtmlTable table;
  table.note = "Virtual time / live, and by how much live differs.";
  table.header = {"run",
                  "scheme",
                  "delay [ms]",
                  "coherency, mean [mm]",
                  "%",
                  "force, user 1 [N]",
                  "%",
                  "contact changes, site 1",
                  "late ticks [%]",
                  "round trip [ms]"};
  for (const Pair& pair : pairs) {
    const Run& live = *pair.live;
    std::vector<std::string> row = {nameOf(live.kind), schemeCell(live.scheme),
                                    fmt::format("{:g}", 1e3 * live.setting("/network/delay"))};
    if (live.hasObject() && live.kind != RunKind::kUserContact) {
      addComparison(
          row, pair, [](const Run& r) { return 1e3 * r.mean_coherency; }, 2);
    } else {
      row.insert(row.end(), {"–", "–"});
    }
    addComparison(
        row, pair, [](const Run& r) { return r.site[0].force_mean; }, 3);
    row.push_back(bothTexts(
        pair, [](const Run& r) { return r.site[0].contact_transitions; }, 0));
    row.push_back(fixedText(1e2 * live.live->late_share, 1));
    row.push_back(fixedText(1e3 * live.live->round_trip, 1));
    table.rows.push_back(row);
  }
  return table;
}

/// The two rows of a run's curves: what users share, and the force on user 1.
void addCurves(const Run& run, const std::string& style, std::vector<Curve>& shared,
               std::vector<Curve>& force) {
  const std::array<Table, 2> sites = loadSites(run);
  const Signal& t = sites[0].column("t");
  shared.push_back(
      {t,
       scaled(run.kind == RunKind::kUserContact ? sites[0].column("device_x") : separationOf(sites),
              1e3),
       style});
  force.push_back({t, normOf(sites[0], "force"), style});
}

/// Pairs that differ in nothing but the scheme, which have the columns of one figure.
Figure liveFigure(const std::vector<Pair>& pairs, const std::string& name) {
  const Run& first = *pairs.front().live;
  const bool is_contact = first.kind == RunKind::kUserContact;
  ColumnFigure figure;
  figure.name = name;
  figure.title = fmt::format("Live beside virtual time: {}, network delay {:g} ms",
                             nameOf(first.kind), first.setting("/network/delay") * 1e3);
  figure.legend = {{{"lines lc rgb '#888888' lw 4"}, "virtual time (in the scheme’s colour)"},
                   {{std::string("lines ") + kLiveStyle}, "live, over real sockets"}};
  figure.rows = {{is_contact ? "user 1 along x [mm]" : "|object 1 − object 2| [mm]", 190, {}},
                 {"force, user 1 [N]", 150, {}}};
  for (const Pair& pair : pairs) {
    std::vector<Curve> shared, force;
    if (pair.in_virtual_time)
      addCurves(*pair.in_virtual_time,
                fmt::format("lc rgb '{}' lw 4", schemeColour(pair.live->scheme)), shared, force);
    addCurves(*pair.live, kLiveStyle, shared, force);
    figure.schemes.push_back(pair.live->scheme);
    figure.rows[0].panels.push_back(shared);
    figure.rows[1].panels.push_back(force);
  }
  figure.caption =
      "Two programs with a network between them that delays real datagrams, and the same in "
      "virtual "
      "time. Intermittent contact is chaotic: there only its kind can agree.";
  return drawColumns(figure);
}

}  // namespace

void addLive(Report& report, const std::vector<Run>& runs) {
  const std::vector<Pair> pairs = findPairs(runs);
  if (pairs.empty()) return;
  report.addHeading(2, "Live beside virtual time");
  report.addTable(liveTable(pairs));
  int figures = 0;
  for (auto from = pairs.begin(); from != pairs.end();) {
    const auto until = std::find_if(std::next(from), pairs.end(), [&](const Pair& pair) {
      return describeWithoutScheme(*pair.live) != describeWithoutScheme(*from->live);
    });
    report.addFigure(liveFigure({from, until}, fmt::format("live-{}", ++figures)));
    from = until;
  }
}

}  // namespace tandem::demos::plot
