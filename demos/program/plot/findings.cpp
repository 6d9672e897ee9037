#include "plot/findings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plot/labels.h"

namespace tandem::demos::plot {
namespace {

// The paper's Figure 5, worst first.
constexpr std::string_view kPaperOrder[] = {"virtual_coupling", "remote_dynamic_proxy",
                                            "kinematic_proxy"};

std::string dampingText(const SchemeGroup& point) {
  return fmt::format("{:g}", point.first().setting("/device/damping"));
}

// "at 0, 0.5 and 1 N s/m", "at none of 0 and 0.5 N s/m", "at all of ...".
std::string whereHolds(const Sweep& sweep, const std::function<bool(const SchemeGroup&)>& holds) {
  std::vector<std::string> all;
  std::vector<std::string> where;
  for (const SchemeGroup& point : sweep.points) {
    all.push_back(dampingText(point));
    if (holds(point)) where.push_back(dampingText(point));
  }
  if (where.empty()) return fmt::format("at none of b_dev = {} N s/m", joinWords(all));
  if (where.size() == all.size()) return fmt::format("at all of b_dev = {} N s/m", joinWords(all));
  return fmt::format("only at b_dev = {} N s/m", joinWords(where));
}

std::vector<std::string> cooperationFindings(const Sweep& sweep) {
  std::vector<std::string> findings;
  for (const CoherencyMeasure& measure : coherencyMeasures()) {
    const auto order = [&](const SchemeGroup& point) { return orderSchemes(point, measure); };
    if (!std::all_of(sweep.points.begin(), sweep.points.end(),
                     [&](const SchemeGroup& point) { return order(point).is_complete; }))
      continue;
    findings.push_back(fmt::format(
        "The paper’s order (virtual coupling worst, kinematic proxy best) against device damping, "
        "{}: holds {}.",
        measure.name,
        whereHolds(sweep, [&](const SchemeGroup& point) { return order(point).is_the_papers; })));
  }
  return findings;
}

std::vector<std::string> contactFindings(const Sweep& sweep) {
  const auto hasScheme = [&](std::string_view scheme) {
    return std::all_of(sweep.points.begin(), sweep.points.end(),
                       [&](const SchemeGroup& point) { return point.find(scheme) != nullptr; });
  };
  const auto changes = [](const SchemeGroup& point, std::string_view scheme) {
    return point.find(scheme)->site[0].contact_transitions;
  };
  std::vector<std::string> findings;
  if (hasScheme("kinematic_proxy"))
    findings.push_back(
        fmt::format("Kinematic proxy: contact is intermittent ({} changes or more) {}.",
                    kIntermittentChanges, whereHolds(sweep, [&](const SchemeGroup& point) {
                      return changes(point, "kinematic_proxy") >= kIntermittentChanges;
                    })));
  if (hasScheme("remote_dynamic_proxy"))
    findings.push_back(
        fmt::format("Remote dynamic proxy: the first touch is kept (exactly one change) {}.",
                    whereHolds(sweep, [&](const SchemeGroup& point) {
                      return changes(point, "remote_dynamic_proxy") == 1.0;
                    })));
  return findings;
}

}  // namespace

const std::vector<CoherencyMeasure>& coherencyMeasures() {
  static const std::vector<CoherencyMeasure> measures = {
      {"at equal time", [](const Run& run) { return run.mean_coherency; }},
      {"as received at site 1", [](const Run& run) { return run.site[0].received_mean; }},
      {"as received at site 2", [](const Run& run) { return run.site[1].received_mean; }}};
  return measures;
}

SchemeOrder orderSchemes(const SchemeGroup& group, const CoherencyMeasure& measure) {
  SchemeOrder order;
  for (const Run* run : group.runs)
    if (std::isfinite(measure.value(*run))) order.worst_first.push_back(run);
  std::sort(order.worst_first.begin(), order.worst_first.end(),
            [&](const Run* a, const Run* b) { return measure.value(*a) > measure.value(*b); });
  for (const Run* run : order.worst_first)
    order.text += fmt::format("{}{} ({} mm)", order.text.empty() ? "" : " > ",
                              schemeLabel(run->scheme), numberText(measure.value(*run) * 1e3));
  order.is_complete = order.worst_first.size() == std::size(kPaperOrder);
  order.is_the_papers =
      order.is_complete &&
      std::equal(order.worst_first.begin(), order.worst_first.end(), std::begin(kPaperOrder),
                 [](const Run* run, std::string_view scheme) { return run->scheme == scheme; });
  return order;
}

std::string contactVerdict(double transitions) {
  if (transitions == 0.0) return "no contact";
  if (transitions == 1.0) return "kept after the first touch";
  if (transitions >= kIntermittentChanges) return "intermittent";
  return std::isfinite(transitions) ? "bounces" : "–";
}

std::string changesText(double transitions) {
  return fmt::format("{:g} {}", transitions, transitions == 1.0 ? "change" : "changes");
}

std::vector<std::string> sweepFindings(const Sweep& sweep) {
  return sweep.kind() == RunKind::kUserContact ? contactFindings(sweep)
                                               : cooperationFindings(sweep);
}

}  // namespace tandem::demos::plot
