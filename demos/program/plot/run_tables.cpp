#include "plot/run_tables.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "plot/findings.h"
#include "plot/labels.h"
#include "plot/reference.h"

namespace tandem::demos::plot {
namespace {

struct RunColumn {
  std::string header;
  std::function<double(const Run&)> value;
  int decimals = 2;
  std::function<double(const ReferenceOutcome&)> reference;  // may be empty
};

// A setting, or two that belong together, as a column of what was asked.
struct AskedColumn {
  std::string header;
  std::string unit;
  std::function<std::string(const Run&)> text;
};

std::string settingCell(const Run& run, const char* pointer, double factor = 1.0) {
  const double value = run.setting(pointer) * factor;
  return std::isfinite(value) ? fmt::format("{:g}", value) : "–";
}

std::string pairCell(const Run& run, const char* first, const char* second) {
  return settingCell(run, first) + " / " + settingCell(run, second);
}

// The constant force of a user's hand along x, or how the hand moves when its force is another.
std::string handCell(const Run& run, const std::string& site) {
  const std::string hand = run.settingText("/" + site + "/hand");
  if (!hand.empty() && hand != "constant") return escapeHtml(schemeLabel(hand));
  return settingCell(run, ("/" + site + "/hand_force/0").c_str());
}

std::vector<AskedColumn> askedColumns() {
  return {{"time", "s", [](const Run& r) { return settingCell(r, "/experiment/duration"); }},
          {"hands", "N",
           [](const Run& r) { return handCell(r, "site1") + " / " + handCell(r, "site2"); }},
          {"K_vc / B_vc", "N/m, N s/m",
           [](const Run& r) { return pairCell(r, "/contact/stiffness", "/contact/damping"); }},
          {"K_t / B_t", "N/m, N s/m",
           [](const Run& r) {
             return pairCell(r, "/coordination/stiffness", "/coordination/damping");
           }},
          {"delay", "ms", [](const Run& r) { return settingCell(r, "/network/delay", 1e3); }},
          {"b_dev", "N s/m", [](const Run& r) { return settingCell(r, "/device/damping"); }}};
}

// Settings that all runs share are said once, above the table; columns are for those that differ.
struct AskedSettings {
  std::string shared;
  std::vector<AskedColumn> columns;
};

AskedSettings splitAsked(const std::vector<const Run*>& runs) {
  AskedSettings settings;
  for (const AskedColumn& column : askedColumns()) {
    const std::string first = column.text(*runs.front());
    if (std::any_of(runs.begin(), runs.end(),
                    [&](const Run* run) { return column.text(*run) != first; }))
      settings.columns.push_back(column);
    else
      settings.shared += fmt::format("{}{} = {} {}", settings.shared.empty() ? "" : "; ",
                                     column.header, first, column.unit);
  }
  return settings;
}

std::vector<RunColumn> coherencyColumns() {
  return {{"mean [mm]", [](const Run& r) { return r.mean_coherency * 1e3; }, 2,
           [](const ReferenceOutcome& o) { return o.mean_coherency * 1e3; }},
          {"largest [mm]", [](const Run& r) { return r.max_coherency * 1e3; }, 2,
           [](const ReferenceOutcome& o) { return o.max_coherency * 1e3; }},
          {"received, site 1 [mm]", [](const Run& r) { return r.site[0].received_mean * 1e3; }, 2,
           [](const ReferenceOutcome& o) { return o.received_mean1 * 1e3; }},
          {"received, site 2 [mm]", [](const Run& r) { return r.site[1].received_mean * 1e3; }, 2,
           [](const ReferenceOutcome& o) { return o.received_mean2 * 1e3; }}};
}

RunColumn meanForce() {
  return {"mean force, user 1 [N]", [](const Run& r) { return r.site[0].force_mean; }, 3,
          [](const ReferenceOutcome& o) { return o.force_mean; }};
}
RunColumn largestForce() {
  return {"largest force, user 1 [N]", [](const Run& r) { return r.site[0].force_max; }, 2,
          [](const ReferenceOutcome& o) { return o.force_max; }};
}
RunColumn contactChanges(std::size_t site) {
  return {
      fmt::format("contact changes, site {}", site + 1),
      [site](const Run& r) { return r.site[site].contact_transitions; }, 0,
      [site](const ReferenceOutcome& o) { return site == 0 ? o.contact_transitions : kMissing; }};
}
RunColumn deviceEnd(std::size_t site) {
  return {fmt::format("user {} at the end [m]", site + 1),
          [site](const Run& r) { return r.site[site].device_end; }, 4,
          [site](const ReferenceOutcome& o) { return site == 0 ? o.device_end : kMissing; }};
}
RunColumn realTimeFactor() {
  return {"times real time", [](const Run& r) { return r.real_time_factor; }, 0, {}};
}

std::vector<RunColumn> reachedColumns(RunKind kind) {
  std::vector<RunColumn> columns;
  if (kind == RunKind::kUserContact) {
    columns = {contactChanges(0), contactChanges(1), largestForce(),
               meanForce(),       deviceEnd(0),      deviceEnd(1)};
  } else {
    columns = coherencyColumns();
    columns.push_back(meanForce());
    columns.push_back(contactChanges(0));
    columns.push_back(deviceEnd(0));
    columns.push_back(deviceEnd(1));
  }
  columns.push_back(realTimeFactor());
  return columns;
}

std::string reachedCell(const Run& run, const RunColumn& column) {
  std::string cell = fixedText(column.value(run), column.decimals);
  const ReferenceOutcome* reference = referenceOf(run);
  if (reference == nullptr || !column.reference) return cell;
  const double expected = column.reference(*reference);
  if (std::isfinite(expected))
    cell += fmt::format("<span class=\"reference\">{}</span>", fmt::format("{:g}", expected));
  return cell;
}

std::string yesNo(bool holds) { return holds ? "✓ yes" : "✗ no"; }

void addCooperationRows(HtmlTable& table, const Sweep& sweep) {
  table.header = {"b_dev [N s/m]"};
  for (const CoherencyMeasure& measure : coherencyMeasures()) {
    table.header.push_back(measure.name + " [mm], worst first");
    table.header.push_back("the paper’s order?");
  }
  for (const SchemeGroup& point : sweep.points) {
    std::vector<std::string> row = {fmt::format("{:g}", point.first().setting("/device/damping"))};
    for (const CoherencyMeasure& measure : coherencyMeasures()) {
      const SchemeOrder order = orderSchemes(point, measure);
      std::string list;
      for (const Run* run : order.worst_first)
        list += fmt::format("{}{}{}", list.empty() ? "" : "<br>", schemeCell(run->scheme),
                            numberText(measure.value(*run) * 1e3));
      row.push_back(list);
      row.push_back(order.is_complete ? yesNo(order.is_the_papers) : "–");
    }
    table.rows.push_back(row);
  }
}

void addContactRows(HtmlTable& table, const Sweep& sweep) {
  table.header = {"b_dev [N s/m]"};
  for (const std::string& scheme : knownSchemes())
    if (sweep.points.front().find(scheme) != nullptr)
      for (const char* what : {": contact changes", ": contact is"})
        table.header.push_back(schemeLabel(scheme) + what);
  for (const SchemeGroup& point : sweep.points) {
    std::vector<std::string> row = {fmt::format("{:g}", point.first().setting("/device/damping"))};
    for (const std::string& scheme : knownSchemes()) {
      if (sweep.points.front().find(scheme) == nullptr) continue;
      const Run* run = point.find(scheme);
      const double changes = run == nullptr ? kMissing : run->site[0].contact_transitions;
      row.push_back(fixedText(changes, 0));
      row.push_back(contactVerdict(changes));
    }
    table.rows.push_back(row);
  }
}

}  // namespace

std::string schemeCell(const std::string& scheme) {
  return fmt::format("<span class=\"scheme\" style=\"background:{}\"></span>{} ",
                     schemeColour(scheme), schemeLabel(scheme));
}

HtmlTable runTable(const std::vector<Run>& runs, RunKind kind) {
  HtmlTable table;
  std::vector<const Run*> members;
  for (const Run& run : runs)
    if (run.kind == kind) members.push_back(&run);
  if (members.empty()) return table;

  const AskedSettings asked = splitAsked(members);
  const std::vector<RunColumn> reached = reachedColumns(kind);
  table.groups = {{"asked", 2 + asked.columns.size()}, {"reached", reached.size()}};
  if (!asked.shared.empty())
    table.note =
        fmt::format("{}: {}.", members.size() > 1 ? "Asked of all" : "Asked", asked.shared);
  table.header = {"run", "scheme"};
  for (const AskedColumn& column : asked.columns)
    table.header.push_back(fmt::format("{} [{}]", column.header, column.unit));
  for (const RunColumn& column : reached) table.header.push_back(column.header);
  for (const Run* run : members) {
    std::vector<std::string> cells = {escapeHtml(run->name), schemeCell(run->scheme)};
    for (const AskedColumn& column : asked.columns) cells.push_back(column.text(*run));
    for (const RunColumn& column : reached) cells.push_back(reachedCell(*run, column));
    table.rows.push_back(cells);
  }
  return table;
}

HtmlTable contactTable(const std::vector<SchemeGroup>& cases) {
  HtmlTable table;
  table.header = {"case",
                  "scheme",
                  "contact changes",
                  "contact is",
                  "largest force [N]",
                  "user 1 at the end [m]"};
  for (const SchemeGroup& group : cases)
    for (const Run* run : group.runs)
      table.rows.push_back({fmt::format("{:g} N/m, {:g} ms", run->setting("/contact/stiffness"),
                                        run->setting("/network/delay") * 1e3),
                            schemeCell(run->scheme), reachedCell(*run, contactChanges(0)),
                            contactVerdict(run->site[0].contact_transitions),
                            reachedCell(*run, largestForce()), reachedCell(*run, deviceEnd(0))});
  return table;
}

HtmlTable sweepTable(const Sweep& sweep) {
  HtmlTable table;
  if (sweep.kind() == RunKind::kUserContact)
    addContactRows(table, sweep);
  else
    addCooperationRows(table, sweep);
  return table;
}

}  // namespace tandem::demos::plot
