// Measures the live loop: how punctual a site's haptic thread is while its host steps a world of
// 1000 active boxes. scripts/live_bench.sh compares it with a bare periodic thread.
//
//   tandem_live_bench              Experiment I for a minute
//   tandem_live_bench --load       only the host with its boxes, as a load for other measurements
//   tandem_live_bench --compare    one second of it, compared with the same in virtual time
//
// The hand pushes with 5 N all the time, as in the paper. Its load reaches 5 m/s and moves for 300
// m: contact, couplers and packets work in every tick, and the guide has no end. A hand moving to
// and fro would lose contact, and ticks would be cheaper.

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tandem/falcon/monotonic_clock.h"

#include "beside_virtual.h"
#include "crowd.h"
#include "live_pair.h"
#include "support/checkout.h"

using namespace tandem;
using namespace tandem::bench;

namespace {

struct Options {
  std::string scenario = test::inCheckout("demos/scenarios/experiment1.toml");
  std::string scheme = "remote_dynamic_proxy";
  std::vector<std::string> overrides;
  double seconds = 60.0, host_rate = 60.0;
  LivePairSettings pair;
  bool load = false, compare = false, json = false;
};

demos::Scenario load(const Options& options) {
  std::vector<std::string> overrides = {"experiment.scheme=\"" + options.scheme + "\"",
                                        "rates.host=" + std::to_string(options.host_rate)};
  if (!options.compare)
    overrides.push_back("experiment.duration=" + std::to_string(options.seconds));
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  return demos::loadScenario(options.scenario, overrides);
}

nlohmann::json describe(const HostReport& host) {
  return {{"steps", host.steps}, {"step", {{"p50", host.step_median}, {"max", host.step_longest}}}};
}

nlohmann::json describe(const LivePairReport& run) {
  const LoopReport& loop = run.loop;
  const double due = static_cast<double>(loop.ticks + loop.skipped);
  return {{"ticks", loop.ticks},
          {"skipped", loop.skipped},
          {"skipped_rate", static_cast<double>(loop.skipped) / due},
          {"wake", {{"p50", loop.late_p50}, {"p99", loop.late_p99}, {"max", loop.late_max}}},
          {"tick", {{"p50", loop.tick_p50}, {"p99", loop.tick_p99}, {"max", loop.tick_max}}},
          {"longest_gap", loop.longest_gap},
          {"host", describe(run.host)},
          {"packets", {{"taken", run.packets_taken}, {"lost_in_queues", run.lost}}},
          {"status", run.status},
          {"notes", run.notes}};
}

nlohmann::json describe(const RunFigures& run) {
  return {{"force", {{"mean", run.force_mean}, {"max", run.force_max}}},
          {"coherency", {{"mean", run.coherency_mean}, {"max", run.coherency_max}}}};
}

/// Relative difference; 0 if both are 0.
double differ(double live, double expected) {
  return expected == 0.0 ? std::abs(live) : std::abs(live - expected) / std::abs(expected);
}

nlohmann::json describe(const BesideVirtual& both) {
  const RunFigures &live = both.live, &expected = both.virtual_time;
  return {{"virtual", describe(expected)},
          {"live", describe(live)},
          {"difference",
           {{"force_mean", differ(live.force_mean, expected.force_mean)},
            {"force_max", differ(live.force_max, expected.force_max)},
            {"coherency_mean", differ(live.coherency_mean, expected.coherency_mean)},
            {"coherency_max", differ(live.coherency_max, expected.coherency_max)}}},
          {"loop", describe(both.report)}};
}

nlohmann::json runLoad(const Options& options) {
  BareHost host(options.pair.boxes);
  const double step = 1.0 / options.host_rate;
  return {{"host", describe(runHost(readMonotonicClock(), options.seconds, options.host_rate, [&] {
             host.world().stepSimulation(static_cast<btScalar>(step), 0);
           }))}};
}

void print(const LivePairReport& run) {
  const LoopReport& loop = run.loop;
  const auto us = [](double seconds) { return 1e6 * seconds; };
  std::printf("ticks %llu, skipped %llu; longest gap %.2f ms\n",
              static_cast<unsigned long long>(loop.ticks),
              static_cast<unsigned long long>(loop.skipped), 1e3 * loop.longest_gap);
  std::printf("wake-up  p50 %7.1f  p99 %7.1f  max %7.1f us\n", us(loop.late_p50), us(loop.late_p99),
              us(loop.late_max));
  std::printf("tick     p50 %7.1f  p99 %7.1f  max %7.1f us\n", us(loop.tick_p50), us(loop.tick_p99),
              us(loop.tick_max));
  std::printf("host     %llu steps, p50 %.2f, max %.2f ms\n",
              static_cast<unsigned long long>(run.host.steps), 1e3 * run.host.step_median,
              1e3 * run.host.step_longest);
  for (const std::string& note : run.notes) std::printf("note: %s\n", note.c_str());
}

void print(const BesideVirtual& both) {
  const auto row = [](const char* name, double expected, double live, const char* unit) {
    std::printf("%-16s virtual %8.4f  live %8.4f %s  (%.2f %% apart)\n", name, expected, live, unit,
                100.0 * differ(live, expected));
  };
  const RunFigures &live = both.live, &expected = both.virtual_time;
  row("force, mean", expected.force_mean, live.force_mean, "N");
  row("force, max", expected.force_max, live.force_max, "N");
  row("coherency, mean", 1e3 * expected.coherency_mean, 1e3 * live.coherency_mean, "mm");
  row("coherency, max", 1e3 * expected.coherency_max, 1e3 * live.coherency_max, "mm");
  print(both.report);
}

template <typename Result>
void show(const Result& result, bool is_json) {
  if (is_json)
    std::printf("%s\n", describe(result).dump(2).c_str());
  else
    print(result);
}

void run(const Options& options) {
  if (options.load)
    std::printf("%s\n", runLoad(options).dump(2).c_str());
  else if (options.compare)
    show(runBesideVirtual(load(options), options.pair), options.json);
  else
    show(runLivePair(load(options), options.pair), options.json);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"The live loop of two sites, measured while site 1's host steps active boxes."};
  app.add_option("--scenario", options.scenario, "scenario file")->check(CLI::ExistingFile);
  app.add_option("--scheme", options.scheme, "what stands for a remote user");
  app.add_option("--set", options.overrides, "KEY=VALUE of the scenario");
  app.add_option("--seconds", options.seconds, "length of the run, not with --compare [s]")
      ->check(CLI::Range(0.1, 3600.0));
  app.add_option("--priority", options.pair.priority, "SCHED_FIFO; 0: none")
      ->check(CLI::Range(0, 99));
  app.add_option("--boxes", options.pair.boxes, "active boxes of site 1's host")
      ->check(CLI::Range(0, 100000));
  app.add_option("--host-rate", options.host_rate, "of both hosts [Hz]")
      ->check(CLI::Range(1.0, 1000.0));
  app.add_flag("--json", options.json, "SI units");
  CLI::Option* load = app.add_flag("--load", options.load, "the host and its boxes, no haptics");
  app.add_flag("--compare", options.compare, "the scenario as it is, and in virtual time")
      ->excludes(load);
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tandem_live_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
