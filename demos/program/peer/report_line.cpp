#include "peer/report_line.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace tandem::demos {
namespace {

constexpr double kRelaySilence = 3.0;  ///< a relay answers once a second [s]

/// In a run, the arrival of states says more than the state of the connection.
std::string nameState(const PeerReport& report, const OtherSite& other) {
  const bool is_running = report.time > 0.0 && other.peer.phase == PeerPhase::kLive;
  return is_running ? std::string(nameOf(other.link)) : name(other.peer.phase);
}

bool isLive(const PeerReport& report, const OtherSite& other) {
  return other.peer.phase == PeerPhase::kLive &&
         (report.time <= 0.0 || other.link == LinkState::kLive);
}

std::string describeMembers(const PeerReport& report) {
  return report.members == 0 ? std::string() : fmt::format(" | N = {}", report.members);
}

std::string describeOthers(const PeerReport& report) {
  const auto& others = report.others;
  if (others.size() == 1) return fmt::format("{:9}", nameState(report, others[0]));
  const auto is_live = [&](const OtherSite& other) { return isLive(report, other); };
  std::string text =
      fmt::format("{} of {} live", std::ranges::count_if(others, is_live), others.size());
  const auto first = std::ranges::find_if_not(others, is_live);
  if (first != others.end())
    text += fmt::format(", site {} {}", static_cast<std::uint32_t>(first->peer.peer),
                        nameState(report, *first));
  return text;
}

double findLargest(const PeerReport& report, double PeerStatus::*value) {
  double largest = 0.0;
  for (const OtherSite& other : report.others) largest = std::max(largest, other.peer.*value);
  return largest;
}

/// The way to the peers, or the reason why the relay lets nobody in.
std::string describeWay(const PeerReport& report) {
  if (!report.relay) return {};
  if (!report.relay->is_in && !report.relay->refused.empty())
    return " | relay: " + report.relay->refused;
  const auto relayed =
      std::ranges::count_if(report.others, [](const auto& other) { return other.peer.is_relayed; });
  std::string way = " | direct";
  if (relayed > 0) way = " | by the relay";
  if (relayed > 0 && relayed < std::ssize(report.others))
    way = fmt::format(" | {} by the relay", relayed);
  if (report.relay->silence > kRelaySilence)
    way += fmt::format(", relay silent for {:.0f} s", report.relay->silence);
  return way;
}

}  // namespace

std::string describeReport(const PeerReport& report) {
  const std::string time = report.has_start ? fmt::format("{:8.1f} s", report.time) : "   waiting";
  return fmt::format(
      "{} | {}{} | round trip {:6.1f} ms | wait {:5.1f} ms | jitter {:5.1f} ms | loss {:4.1f} % | "
      "force {:6.3f} N | coherency {:7.3f} mm{}",
      time, describeOthers(report), describeMembers(report),
      1e3 * findLargest(report, &PeerStatus::round_trip),
      1e3 * findLargest(report, &PeerStatus::wait), 1e3 * findLargest(report, &PeerStatus::jitter),
      1e2 * findLargest(report, &PeerStatus::loss), report.force, 1e3 * report.coherency,
      describeWay(report));
}

}  // namespace tandem::demos
