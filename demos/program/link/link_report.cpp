#include "link/link_report.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos {
namespace {

nlohmann::json describe(const LinkFigures& figures) {
  return {{"loss", figures.loss},       {"duplicate", figures.duplicate},
          {"reorder", figures.reorder}, {"corrupt", figures.corrupt},
          {"delay", figures.delay},     {"jitter", figures.jitter}};
}

nlohmann::json describe(const LinkProxy::Lane& lane) {
  const DatagramChannelCounts& counts = lane.channel.counts();
  const std::uint64_t gone = counts.cut_off + counts.too_long + counts.lost + counts.overflowed;
  nlohmann::json achieved = describe(lane.tally.achieved(counts));
  achieved["delay_median"] = lane.tally.delays().percentile(0.5);
  achieved["delay_p99"] = lane.tally.delays().percentile(0.99);
  return {{"datagrams", counts.sent},
          {"asked", describe(lane.tally.asked())},
          {"achieved", achieved},
          {"self_latency",
           {{"median", lane.tally.latencies().percentile(0.5)},
            {"p99", lane.tally.latencies().percentile(0.99)}}},
          {"counts",
           {{"delivered", counts.delivered},
            {"lost", counts.lost},
            {"duplicated", counts.duplicated},
            {"reordered", counts.reordered},
            {"overtaken", counts.overtaken},
            {"corrupted", counts.corrupted},
            {"cut_off", counts.cut_off},
            {"overflowed", counts.overflowed},
            {"too_long", counts.too_long},
            {"not_passed_on", lane.not_passed_on},
            {"under_way", counts.sent + counts.duplicated - gone - counts.delivered}}}};
}

std::string show(const nlohmann::json& value, double scale, const char* unit) {
  const double number = value.is_number() ? value.get<double>() : NAN;
  return std::isfinite(number) ? fmt::format("{:.3f} {}", scale * number, unit) : "-";
}

/// Cells of one row: asked and achieved, forward and back.
std::string row(const std::string& name, const std::array<std::string, 4>& cells) {
  const std::string line =
      fmt::format("{:<24}{:>12}{:>12}{:>16}{:>12}", name, cells[0], cells[1], cells[2], cells[3]);
  return line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
}

}  // namespace

nlohmann::json makeLinkReport(const LinkProxy& proxy) {
  return {{"seconds", proxy.elapsed()},
          {"strangers", proxy.strangers()},
          {"forward", describe(proxy.lane(Direction::kForward))},
          {"back", describe(proxy.lane(Direction::kBack))}};
}

std::string formatLinkReport(const nlohmann::json& report) {
  const nlohmann::json &forward = report["forward"], &back = report["back"];
  std::string table = row("", {"forward:", "", "back:", ""});
  table += row("", {"asked", "came out", "asked", "came out"});
  const auto add_count = [&](const std::string& name, const auto& pick) {
    table += row(name, {"", fmt::format("{}", pick(forward).template get<std::uint64_t>()), "",
                        fmt::format("{}", pick(back).template get<std::uint64_t>())});
  };
  const auto add_figure = [&](const char* name, const char* key, double scale, const char* unit) {
    table +=
        row(name,
            {show(forward["asked"][key], scale, unit), show(forward["achieved"][key], scale, unit),
             show(back["asked"][key], scale, unit), show(back["achieved"][key], scale, unit)});
  };
  const auto add_result = [&](const char* name, const char* group, const char* key) {
    table += row(name,
                 {"", show(forward[group][key], 1e3, "ms"), "", show(back[group][key], 1e3, "ms")});
  };
  add_count("datagrams", [](const auto& lane) { return lane["datagrams"]; });
  add_figure("lost", "loss", 1e2, "%");
  add_figure("duplicated", "duplicate", 1e2, "%");
  add_figure("reordered", "reorder", 1e2, "%");
  add_figure("corrupted", "corrupt", 1e2, "%");
  add_figure("delay, mean", "delay", 1e3, "ms");
  add_result("delay, median", "achieved", "delay_median");
  add_result("delay, 99 %", "achieved", "delay_p99");
  add_figure("jitter, +-", "jitter", 1e3, "ms");
  add_result("self-latency, median", "self_latency", "median");
  add_result("self-latency, 99 %", "self_latency", "p99");
  for (const auto& [name, key] : {std::pair{"delivered", "delivered"},
                                  {"came after a later one", "overtaken"},
                                  {"cut off", "cut_off"},
                                  {"overflowed", "overflowed"},
                                  {"too long", "too_long"},
                                  {"not taken by the system", "not_passed_on"},
                                  {"under way at the end", "under_way"}})
    add_count(name, [&, k = key](const auto& lane) { return lane["counts"][k]; });
  return table + fmt::format("{:.1f} s; {} datagrams from strangers\n",
                             report["seconds"].get<double>(),
                             report["strangers"].get<std::uint64_t>());
}

}  // namespace tandem::demos
