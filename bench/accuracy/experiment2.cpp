#include "bench/accuracy/experiment2.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tandem/coordination/scheme.h"

#include "bench/reference/paper_reference.h"
#include "demos/program/run/virtual_run.h"

namespace tandem::demos::bench {
namespace {

/// A way to run the scenario, as a change of it.
struct Way {
  std::string method;
  Injection injection;
  bool needs_haptic_rate;  ///< the host must step at the haptic rate
};

const Way kWays[] = {{"plugin handoff", Injection::kHandoff, false},
                     {"plugin impulse", Injection::kImpulse, true}};

Scenario makeScenario(const reference::PaperParameters& p, const Way& way, int host_rate) {
  Scenario s;
  s.kind = "user_contact";
  s.duration = p.sampling.duration;
  s.site.contact = {p.contact.stiffness, p.contact.damping};
  s.site.coordination = {p.coordination.stiffness, p.coordination.damping};
  s.site.proxy.mass = s.device.mass = p.proxy_mass;
  s.device.damping = p.device_damping;
  s.sites[0].hand.force = Vec3(p.hand_force_1, 0, 0);
  s.sites[1].hand.force = Vec3(p.hand_force_2, 0, 0);
  s.network.delay = p.sampling.delay;
  s.site.packet_rate = p.sampling.packet_rate;
  s.site.haptic_rate = p.sampling.haptic_rate;
  s.site.injection = way.injection;
  s.host_rate = host_rate;
  return s;
}

void include(RunErrors& errors, double x, double x_true) {
  errors.tool = std::max(errors.tool, std::abs(x - x_true));
}

RunErrors compareRows(const reference::PaperRow& a, const reference::PaperRow& b) {
  RunErrors errors;
  include(errors, a.x1, b.x1);
  include(errors, a.x2, b.x2);
  include(errors, a.x12, b.x12);
  include(errors, a.x21, b.x21);
  errors.force = std::max(std::abs(a.force_1 - b.force_1), std::abs(a.force_2 - b.force_2));
  return errors;
}

/// State of a run at a tick, in the reference's terms. The axis is x.
reference::PaperRow rowOf(const VirtualRun& run, std::size_t tick) {
  const auto device = [&](int site) {
    const auto& ticks = run.recording(site).ticks();
    return ticks[tick].device.hip.p_W.x() - ticks[0].device.hip.p_W.x();
  };
  const auto proxy = [&](int site) {
    const Recording& r = run.recording(site);
    return r.proxy(tick, 0).island.p_W.x() - r.proxy(0, 0).island.p_W.x();
  };
  reference::PaperRow row;
  row.x1 = device(0);
  row.x2 = device(1);
  row.x21 = proxy(0);
  row.x12 = proxy(1);
  row.force_1 = run.recording(0).ticks()[tick].f_W.x();
  row.force_2 = run.recording(1).ticks()[tick].f_W.x();
  return row;
}

AccuracyRun runWay(const reference::PaperParameters& parameters, const Way& way, int host_rate,
                   int repeats, const reference::PaperResult& truth) {
  AccuracyRun result;
  result.method = way.method;
  result.host_rate = host_rate;
  if (way.needs_haptic_rate && host_rate != static_cast<int>(parameters.sampling.haptic_rate)) {
    result.reason = "impulse injection needs the host at the haptic rate of 1000 Hz";
    return result;
  }
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    VirtualRun run(makeScenario(parameters, way, host_rate));
    run.run();
    times.push_back(1e6 / run.summary().real_time_factor);
    if (i > 0) continue;
    for (std::size_t tick = 0; tick < truth.rows.size(); ++tick)
      result.errors.include(compareRows(rowOf(run, tick), truth.rows[tick]));
  }
  std::sort(times.begin(), times.end());
  result.us_per_second = times[times.size() / 2];
  return result;
}

}  // namespace

SceneAccuracy measureExperiment2(const std::vector<int>& host_rates, bool quick) {
  reference::PaperParameters parameters =
      reference::makeUserContact(reference::Scheme::kRemoteDynamicProxy);
  SceneAccuracy result;
  result.scene = kExperiment2;
  result.title = "Experiment II, 0.1 s delay";

  parameters.step = quick ? 4e-6 : 1e-6;
  const reference::PaperResult coarse = reference::runPaperModel(parameters);
  parameters.step *= 0.5;
  const reference::PaperResult fine = reference::runPaperModel(parameters);
  for (std::size_t i = 0; i < fine.rows.size(); ++i)
    result.reference_errors.include(compareRows(coarse.rows[i], fine.rows[i]));
  result.reference = fmt::format("Runge-Kutta 4 at {} us", 1e6 * parameters.step);

  for (const Way& way : kWays)
    for (const int host_rate : host_rates)
      result.runs.push_back(runWay(parameters, way, host_rate, quick ? 3 : 5, fine));
  return result;
}

}  // namespace tandem::demos::bench
