#pragma once

#include <string>

namespace tandem::demos {

/// The domain of "dds:DOMAIN", 0 for "dds". `option` names the option that `word` is for. Throws
/// UsageError for other words, and if the program was built without Cyclone DDS.
[[nodiscard]] int readDdsDomain(const std::string& option, const std::string& word);

}  // namespace tandem::demos
