#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tandem::demos {

/// A value of an option for one other site, as written: "3=host:7003", or without a number.
struct SiteValue {
  std::optional<int> site;  ///< empty: without a number
  std::string value;
};

[[nodiscard]] SiteValue parseSiteValue(const std::string& word);

/// The value of a site, or else that without a number; empty if there is neither.
[[nodiscard]] std::optional<std::string> findValue(const std::vector<std::string>& words, int site);

/// Checks the values of `option` at the site `own` of `count`. Throws UsageError for the number of
/// a site that cannot be meant, and for two values of one site.
void checkSiteValues(const std::string& option, const std::vector<std::string>& words, int own,
                     int count);

}  // namespace tandem::demos
