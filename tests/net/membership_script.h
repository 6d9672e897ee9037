#pragma once

#include <string>

#include "coordination/src/wire/wire.h"

namespace tandem::test {

/// Plays a script of events (membership_sites.h), one byte for each and those that it needs behind
/// it, and then lets the network be perfect: all must be together within ten seconds. Any bytes are
/// a script. Gives what did not hold first; empty: all did.
[[nodiscard]] std::string playMembershipScript(ByteView script);

}  // namespace tandem::test
