#include "relay/relay_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos {
namespace {

constexpr std::size_t kNamedRooms = 4;  ///< the line has no place for more

std::uint64_t countRefused(const RelayStatus& status) {
  std::uint64_t sum = 0;
  for (const RefusedDatagrams& one : status.refused) sum += one.count;
  return sum;
}

/// "lab 3, class 12", the fullest rooms first.
std::string nameRooms(std::vector<RelayRoom> rooms) {
  std::stable_sort(rooms.begin(), rooms.end(),
                   [](const RelayRoom& a, const RelayRoom& b) { return a.members > b.members; });
  std::string text;
  for (std::size_t i = 0; i < std::min(rooms.size(), kNamedRooms); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", rooms[i].name, rooms[i].members);
  if (rooms.size() > kNamedRooms) text += ", ...";
  return text;
}

}  // namespace

nlohmann::json makeRelayReport(const RelayStatus& status, double time) {
  nlohmann::json refused = nlohmann::json::object();
  for (const RefusedDatagrams& one : status.refused) refused[one.reason] = one.count;
  nlohmann::json rooms = nlohmann::json::array();
  for (const RelayRoom& room : status.rooms)
    rooms.push_back({{"name", room.name},
                     {"members", room.members},
                     {"watchers", room.watchers},
                     {"forwarded", room.forwarded},
                     {"forwarded_bytes", room.forwarded_bytes},
                     {"too_many", room.too_many}});
  return {{"time", time},
          {"received", status.received},
          {"forwarded", status.forwarded},
          {"forwarded_bytes", status.forwarded_bytes},
          {"unsent", status.unsent},
          {"members", status.members},
          {"refused", std::move(refused)},
          {"rooms", std::move(rooms)}};
}

std::string formatRelayLine(const RelayStatus& status, const RelayStatus& before, double period) {
  const auto rate = [&](std::uint64_t now, std::uint64_t then) {
    return static_cast<double>(now - then) / period;
  };
  std::string line = fmt::format(
      "{} {} in {} {} | {:7.0f} datagrams/s | {:8.1f} kB/s | refused {:.0f}/s", status.members,
      status.members == 1 ? "member" : "members", status.rooms.size(),
      status.rooms.size() == 1 ? "room" : "rooms", rate(status.forwarded, before.forwarded),
      1e-3 * rate(status.forwarded_bytes, before.forwarded_bytes),
      rate(countRefused(status), countRefused(before)));
  if (!status.rooms.empty()) line += " | " + nameRooms(status.rooms);
  return line;
}

std::string formatRelaySum(const RelayStatus& status) {
  std::string line = fmt::format("received {}, forwarded {}, not taken by the system {}",
                                 status.received, status.forwarded, status.unsent);
  for (const RefusedDatagrams& one : status.refused)
    line += fmt::format(", {} {}", one.reason, one.count);
  return line;
}

}  // namespace tandem::demos
