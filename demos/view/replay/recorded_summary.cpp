#include "replay/recorded_summary.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "replay/run_file.h"

namespace tandem::view {
namespace {

nlohmann::json parseFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file) || !stream) refuseRunFile(file, "cannot be read");
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto read = static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = 1 + std::count(text.begin(), text.begin() + read, '\n');
    refuseRunFile(fmt::format("{}:{}", file.string(), line), "not JSON");
  }
}

RecordedBody readBody(const std::filesystem::path& file, const nlohmann::json& body,
                      std::size_t place, std::size_t sites) {
  const auto site = body.is_object() ? body.value("site", nlohmann::json()) : nlohmann::json();
  const auto name = body.is_object() ? body.value("name", nlohmann::json()) : nlohmann::json();
  const bool has_site = site.is_number_unsigned() && site > 0 && site <= sites;
  if (!has_site || !name.is_string())
    refuseRunFile(file, fmt::format("scene.bodies, body {}: must have a site, 1 {} {}, and a name",
                                    place, sites == 2 ? "or" : "to", sites));
  return {site.get<int>() - 1, name.get<std::string>()};
}

}  // namespace

RecordedSummary readRecordedSummary(const std::filesystem::path& file) {
  const nlohmann::json all = parseFile(file);
  const auto part = [&](const char* key) {
    const nlohmann::json::json_pointer pointer(key);
    return all.contains(pointer) ? all.at(pointer) : nlohmann::json();
  };
  RecordedSummary summary;
  summary.scenario = demos::readScenario(part("/scenario"), file.string());
  const nlohmann::json bodies = part("/scene/bodies");
  if (!bodies.is_array() || bodies.empty()) refuseRunFile(file, "scene.bodies: there are none");
  for (const nlohmann::json& body : bodies)
    summary.bodies.push_back(
        readBody(file, body, summary.bodies.size(), summary.scenario.sites.size()));
  return summary;
}

}  // namespace tandem::view
