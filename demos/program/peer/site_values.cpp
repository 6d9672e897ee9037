#include "peer/site_values.h"

#include <charconv>
#include <set>

#include <fmt/format.h>

#include "terminal/usage_error.h"

namespace tandem::demos {

SiteValue parseSiteValue(const std::string& word) {
  const std::size_t sign = word.find('=');
  if (sign == std::string::npos || sign == 0) return {std::nullopt, word};
  const char* const end = word.data() + sign;
  int site = 0;
  const auto [rest, error] = std::from_chars(word.data(), end, site);
  if (error != std::errc() || rest != end) return {std::nullopt, word};
  return {site, word.substr(sign + 1)};
}

std::optional<std::string> findValue(const std::vector<std::string>& words, int site) {
  std::optional<std::string> usual;
  for (const std::string& word : words) {
    SiteValue value = parseSiteValue(word);
    if (value.site == site) return std::move(value.value);
    if (!value.site) usual = std::move(value.value);
  }
  return usual;
}

void checkSiteValues(const std::string& option, const std::vector<std::string>& words, int own,
                     int count) {
  std::set<std::optional<int>> seen;
  for (const std::string& word : words) {
    const std::optional<int> site = parseSiteValue(word).site;
    if (site && (*site < 1 || *site > count || *site == own))
      throw UsageError(fmt::format("{} {}: must name another site, 1 to {} but not {}", option,
                                   word, count, own));
    if (!seen.insert(site).second)
      throw UsageError(
          fmt::format("{} {}: is the second for that site; give one each", option, word));
  }
}

}  // namespace tandem::demos
