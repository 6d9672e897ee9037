#pragma once

#include <functional>
#include <vector>

namespace tandem::demos {

/// Parts of a computation that do not depend on each other.
using Jobs = std::vector<std::function<void()>>;

/// Does all jobs on all cores, in any order, and returns when all are done. `show` is told the
/// finished share, 0 to 1, ten times a second in the caller's thread. Throws what a job threw
/// first.
void runOnAllCores(const Jobs& jobs, const std::function<void(double)>& show);

}  // namespace tandem::demos
