#include "beside_virtual.h"

#include <algorithm>
#include <cmath>

#include "demos/program/run/virtual_run.h"

namespace tandem::bench {
namespace {

/// The coherency excludes ticks that one site skipped.
RunFigures describe(const Recording& one, const Recording& two, double duration, double rate) {
  RunFigures figures;
  std::size_t ticks = 0, pairs = 0, other = 0;
  const auto number = [&](const TickRecord& tick) { return std::llround(tick.time * rate); };
  for (; ticks < one.ticks().size() && one.ticks()[ticks].time < duration - 0.5 / rate; ++ticks) {
    const TickRecord& tick = one.ticks()[ticks];
    const double force = tick.f_W.norm();
    figures.force_mean += force;
    figures.force_max = std::max(figures.force_max, force);
    while (other < two.ticks().size() && number(two.ticks()[other]) < number(tick)) ++other;
    if (one.objectCount() == 0 || other == two.ticks().size() ||
        number(two.ticks()[other]) != number(tick))
      continue;
    const double apart = (one.object(ticks, 0).island.p_W - two.object(other, 0).island.p_W).norm();
    figures.coherency_mean += apart;
    figures.coherency_max = std::max(figures.coherency_max, apart);
    ++pairs;
  }
  figures.force_mean /= static_cast<double>(std::max<std::size_t>(ticks, 1));
  figures.coherency_mean /= static_cast<double>(std::max<std::size_t>(pairs, 1));
  return figures;
}

}  // namespace

BesideVirtual runBesideVirtual(const demos::Scenario& scenario, LivePairSettings settings) {
  BesideVirtual both;
  const auto tell = [&](const Recording& one, const Recording& two) {
    return describe(one, two, scenario.duration, scenario.site.haptic_rate);
  };
  demos::VirtualRun virtual_run(scenario);
  virtual_run.run();
  both.virtual_time = tell(virtual_run.recording(0), virtual_run.recording(1));
  settings.records = true;
  both.report = runLivePair(scenario, settings);
  both.live = tell(*both.report.recordings[0], *both.report.recordings[1]);
  return both;
}

}  // namespace tandem::bench
