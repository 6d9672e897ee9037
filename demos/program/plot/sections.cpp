#include "plot/sections.h"

#include <algorithm>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "plot/animation.h"
#include "plot/coherency_figures.h"
#include "plot/contact_figures.h"
#include "plot/findings.h"
#include "plot/labels.h"
#include "plot/live_section.h"
#include "plot/motion_figures.h"
#include "plot/reference.h"
#include "plot/run_tables.h"
#include "plot/sweep_figures.h"
#include "plot/top_view.h"

namespace tandem::demos::plot {
namespace {

// File names of figures: "cooperation-…", or "cooperation2-…" for the second of several groups.
std::string prefixOf(const std::string& kind, std::size_t index, std::size_t count) {
  return count == 1 ? kind : fmt::format("{}{}", kind, index + 1);
}

std::string headingOf(const std::string& text, const std::string& difference) {
  return difference.empty() ? text : fmt::format("{}: {}", text, difference);
}

// The run that shows a group's scene: the proxies of the last scheme are bodies of their own.
const Run& representativeOf(const SchemeGroup& group) { return *group.runs.back(); }

std::vector<std::string> coherencyFindings(const SchemeGroup& group) {
  std::vector<std::string> findings;
  for (const CoherencyMeasure& measure : coherencyMeasures()) {
    const SchemeOrder order = orderSchemes(group, measure);
    if (order.worst_first.size() < 2) continue;
    std::string verdict;
    if (order.is_complete)
      verdict = order.is_the_papers ? " <b>The paper’s order holds.</b>"
                                    : " <b>Not the paper’s order.</b>";
    findings.push_back(
        fmt::format("Mean distance {}: {}.{}", measure.name, escapeHtml(order.text), verdict));
  }
  return findings;
}

// One sentence per scheme over all cases: "kept after the first touch in 3 of 3 cases (1 change)".
std::vector<std::string> contactFindings(const std::vector<SchemeGroup>& cases) {
  std::vector<std::string> findings;
  for (const std::string& scheme : knownSchemes()) {
    std::map<std::string, int> verdicts;
    Range changes = Range::nothing();
    int count = 0;
    for (const SchemeGroup& group : cases)
      if (const Run* run = group.find(scheme)) {
        ++verdicts[contactVerdict(run->site[0].contact_transitions)];
        changes.include({run->site[0].contact_transitions});
        ++count;
      }
    std::vector<std::string> parts;
    for (const auto& [verdict, cases_with_it] : verdicts)
      parts.push_back(count == 1
                          ? verdict
                          : fmt::format("{} in {} of {} cases", verdict, cases_with_it, count));
    if (count > 0)
      findings.push_back(
          fmt::format("User-to-user contact, {}: {} ({}).", schemeLabel(scheme), joinWords(parts),
                      changes.low == changes.high
                          ? changesText(changes.low)
                          : fmt::format("{:g} to {:g} changes", changes.low, changes.high)));
  }
  return findings;
}

void addScene(Report& report, const Run& run, const std::string& prefix) {
  if (run.bodies.empty()) return;
  const SceneMotion motion = loadScene(run);
  if (isSpatial(run, motion)) report.addFigure(animateScene(run, motion, prefix + "-animation"));
  report.addFigure(topView(run, motion, prefix + "-top-view"));
}

void addCooperation(Report& report, const std::vector<SchemeGroup>& groups) {
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const SchemeGroup& group = groups[i];
    const std::string prefix = prefixOf("cooperation", i, groups.size());
    report.addHeading(2, headingOf("Cooperation: two users move one object", group.difference));
    if (groups.size() > 1) report.addList(coherencyFindings(group));
    if (group.runs.size() > 1) report.addFigure(coherencyBars(group, prefix + "-coherency"));
    report.addFigure(coherencyOverTime(group, prefix + "-coherency-over-time"));
    report.addFigure(cooperationMotion(group, prefix + "-motion"));
    addScene(report, representativeOf(group), prefix);
  }
}

void addContact(Report& report, const std::vector<SchemeGroup>& groups) {
  if (groups.empty()) return;
  report.addHeading(2, "User-to-user contact");
  report.addParagraph(
      "User 1 pushes user 2 with no object between them. A good scheme touches once and stays in "
      "contact; the number of changes counts how often contact goes on or off.");
  report.addTable(contactTable(groups));
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::string prefix = prefixOf("contact", i, groups.size());
    if (!groups[i].difference.empty())
      report.addHeading(3, headingOf("Case", groups[i].difference));
    report.addFigure(contactMotion(groups[i], prefix + "-motion"));
    if (i == 0) addScene(report, representativeOf(groups[i]), prefix);
  }
}

void addSweeps(Report& report, const std::vector<Sweep>& sweeps) {
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const bool is_contact = sweeps[i].kind() == RunKind::kUserContact;
    report.addHeading(2, headingOf(is_contact ? "Device damping and user-to-user contact"
                                              : "Device damping and cooperation",
                                   sweeps[i].difference));
    report.addFigure(sweepFigure(sweeps[i], prefixOf("sweep", i, sweeps.size())));
    report.addTable(sweepTable(sweeps[i]));
  }
}

void addPlaygrounds(Report& report, const std::vector<Run>& runs) {
  const auto count = static_cast<std::size_t>(std::count_if(
      runs.begin(), runs.end(), [](const Run& run) { return run.kind == RunKind::kPlayground; }));
  std::size_t index = 0;
  for (const Run& run : runs) {
    if (run.kind != RunKind::kPlayground) continue;
    const std::string prefix = prefixOf("playground", index++, count);
    report.addHeading(2, run.title);
    addScene(report, run, prefix);
    report.addFigure(spatialMotion(run, prefix + "-motion"));
    if (!run.hasObject()) continue;
    const SchemeGroup alone{{&run}, ""};
    report.addFigure(coherencyOverTime(alone, prefix + "-coherency-over-time"));
  }
}

void addGlance(Report& report, const Grouping& grouping) {
  std::vector<std::string> findings;
  const auto append = [&](const std::vector<std::string>& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  if (grouping.cooperation.size() == 1) append(coherencyFindings(grouping.cooperation.front()));
  append(contactFindings(grouping.contact));
  for (const Sweep& sweep : grouping.sweeps) append(sweepFindings(sweep));
  if (findings.empty()) return;
  report.addHeading(2, "What was found");
  report.addList(findings);
}

void addNumbers(Report& report, const std::vector<Run>& runs) {
  if (runs.empty()) return;
  report.addHeading(2, "All runs: asked and reached");
  if (std::any_of(runs.begin(), runs.end(), [](const Run& run) { return referenceOf(run); }))
    report.addParagraph(
        "Small grey numbers are the outcomes of Li and Constantinescu’s equations (2009), shown "
        "where a run has the settings of their experiments. Intermittent contact is chaotic: there "
        "only the size of count and force means something.");
  const std::pair<RunKind, const char*> kKinds[] = {{RunKind::kCooperation, "Cooperation"},
                                                    {RunKind::kUserContact, "User-to-user contact"},
                                                    {RunKind::kPlayground, "Playground"}};
  for (const auto& [kind, heading] : kKinds) {
    const HtmlTable table = runTable(runs, kind);
    if (table.rows.empty()) continue;
    report.addHeading(3, heading);
    report.addTable(table);
  }
  report.addParagraph(
      "Hands: constant force of the hands of users 1 and 2 along x. K_vc, B_vc: stiffness and "
      "damping of contact; K_t, B_t: of the coordination over the network. b_dev: the device’s own "
      "damping. Received: a site’s own copy against the other as it arrives there.");
}

}  // namespace

Report composeReport(const std::vector<Run>& runs, const Grouping& grouping) {
  Report report(runs.size() == 1 ? fmt::format("Tandem: {}", runs.front().title)
                                 : fmt::format("Tandem: {} runs compared", runs.size()));
  report.addParagraph(
      "Two people who are far apart push the same object, or each other, with haptic devices. Each "
      "site simulates its own copy of the scene; states travel over a network with delay. The "
      "figures show how well the copies agree and how contact feels under each scheme.");
  addGlance(report, grouping);
  addCooperation(report, grouping.cooperation);
  addContact(report, grouping.contact);
  addSweeps(report, grouping.sweeps);
  std::vector<Run> in_virtual_time;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(in_virtual_time),
               [](const Run& run) { return !run.live; });
  addPlaygrounds(report, in_virtual_time);
  addLive(report, runs);
  addNumbers(report, in_virtual_time);
  return report;
}

}  // namespace tandem::demos::plot
