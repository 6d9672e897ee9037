#include "peer/dds/dds_domain.h"

#include <charconv>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "peer/dds/dds_bus.h"
#include "plugin/doors/dds/dds_carrier.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// -1 for other words.
int parseDomain(std::string_view word) {
  constexpr std::string_view kName = "dds";
  if (word == kName) return 0;
  if (!word.starts_with("dds:")) return -1;
  word.remove_prefix(kName.size() + 1);
  int domain = -1;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), domain);
  return error == std::errc() && end == word.data() + word.size() ? domain : -1;
}

}  // namespace

int readDdsDomain(const std::string& option, const std::string& word) {
  const int domain = parseDomain(word);
  if (domain < 0 || domain > kHighestDdsDomain)
    throw UsageError(fmt::format("{} {}: must be dds or dds:DOMAIN, with a domain of 0 to {}",
                                 option, word, kHighestDdsDomain));
  checkDds(option);
  return domain;
}

}  // namespace tandem::demos
