#pragma once

#include <string>

#include "coordination/src/wire/wire.h"

namespace tandem::test {

/// Plays a script of events (membership_sites.h), one byte for each plus its parameters. Then the
/// network is perfect: all must be together within ten seconds. Any bytes are a valid script.
/// Returns the first property that failed, or an empty string.
[[nodiscard]] std::string playMembershipScript(ByteView script);

}  // namespace tandem::test
